"""Poles of a function of the Laplace variable near the imaginary axis: where what it describes rings.

Windows of frequency are fitted one by one, along a line to the right of the axis, by a rational function in barycentric form (the AAA
algorithm: Y. Nakatsukasa, O. Sete, L. N. Trefethen, SIAM J. Sci. Comput. 40 (2018) A1494), whose poles are then polished as zeros of 1/f.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator

import numpy as np

from coaxshell.numerics.arrays import ComplexArray

Function = Callable[[ComplexArray], ComplexArray]
"""From s, shape (nodes,), to values; meromorphic near the imaginary axis, with f(conj s) = conj f(s)."""

LOWEST = 0.01
"""Width of the lowest window, radians per unit of time; each next one reaches twice as far."""
WIDEST = 3.0
"""Width of the others at most."""
_SAMPLES = 128
"""Samples of a window and of three tenths of its width on either side."""
_BESIDE = 0.3
_LINE = 1.0 / 16.0
"""Distance of the line of samples from the axis, over the width of a window."""
_TOLERANCE, _MOST_TERMS = 1e-11, 50
_HALVINGS = 4
"""How often a window that so many terms cannot fit is halved."""
_STEPS = 60
_REAL = 1e-8
"""Im s/|s| below which a pole is real but for rounding: what it describes does not ring."""
_SAME = 1e-8
"""Relative distance below which two poles are one, found twice."""


def poles_near_axis(function: Function, highest: float, most_damped: float) -> ComplexArray:
    """Return the poles with 0 < Im s <= ``highest`` and -Re s <= ``most_damped`` |s|, ascending by frequency.

    Parameters
    ----------
    function : callable
    highest : float
        Radians per unit of time.
    most_damped : float
        Largest damping ratio; well below 1, as the fit sees little of poles far from the axis.

    Returns
    -------
    ndarray of complex, shape (poles,)
        A pole that no more than rounding takes off the axis lies on it.
    """
    found: list[complex] = []
    for low, high in _windows(highest):
        for candidate in _candidates(function, low, high, _HALVINGS):
            pole = _polished(function, candidate)
            if pole is None or not _REAL * abs(pole) < pole.imag <= highest or -pole.real > most_damped * abs(pole):
                continue
            if all(abs(pole - other) > _SAME * abs(pole) for other in found):
                found.append(complex(0.0, pole.imag) if abs(pole.real) < 1e-13 * abs(pole) else pole)
    return np.array(sorted(found, key=lambda pole: pole.imag), np.complex128)


def _windows(highest: float) -> Iterator[tuple[float, float]]:
    low, high = 0.0, min(LOWEST, highest)
    while low < highest:
        yield low, high
        low, high = high, min(highest, high + min(high, WIDEST))


def _candidates(function: Function, low: float, high: float, halvings: int) -> Iterator[complex]:
    """Yield poles of the fit in a window, and a little beside it."""
    from scipy.interpolate import AAA  # takes time to import

    width = high - low
    line = np.linspace(low - _BESIDE * width, high + _BESIDE * width, _SAMPLES)
    s = np.asarray(_LINE * width + 1j * line, np.complex128)
    values = function(s)
    if not np.any(values):
        return
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # that it has not come to the tolerance: we see for ourselves
        fit = AAA(s, values, rtol=_TOLERANCE, max_terms=_MOST_TERMS, clean_up=True)
    if np.abs(fit(s) - values).max() > 1e3 * _TOLERANCE * np.abs(values).max() and halvings:
        middle = 0.5 * (low + high)
        yield from _candidates(function, low, middle, halvings - 1)
        yield from _candidates(function, middle, high, halvings - 1)
        return
    slack = 0.05 * width
    yield from (complex(pole) for pole in fit.poles() if low - slack <= pole.imag <= high + slack and abs(pole.real) < max(width, high))


def _polished(function: Function, start: complex) -> complex | None:
    """Return the zero of 1/f next to a guess by the secant method; None if there is none."""
    with np.errstate(all="ignore"):  # at a pole itself f is infinite, or no number
        before, here = start + 1e-5 * abs(start), start
        f_before, f_here = (complex(1.0 / value) for value in function(np.array([before, here])))
        step = before - here
        for _ in range(_STEPS):
            if f_here == f_before or not np.isfinite(f_here) or abs(step) <= 1e-15 * abs(here):
                return here
            step = f_here * (here - before) / (f_here - f_before)
            before, f_before, here = here, f_here, here - step
            if not abs(here - start) < 0.3 * abs(start):
                return None
            f_here = complex(1.0 / function(np.array([here]))[0])
        return here if abs(step) < 1e-9 * abs(here) else None  # as far as rounding lets it come
