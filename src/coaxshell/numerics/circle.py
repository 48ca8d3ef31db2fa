"""Sums of circumferential orders over the whole circle by FFT, and the largest of them.

A modal array has the shape (parities, M + 1, T): parity 0 multiplies cos(m theta), parity 1 (absent when it vanishes) sin(m theta).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import scipy.fft

from coaxshell.numerics.arrays import FloatArray

_FIRST = 16
"""Instants summed before the others are judged by what they can reach."""
_ROUNDING = 1e-9
FINE = 40
"""Steps into which a step of the circle is cut around the largest value found on it."""


_VERTEX = 0.025
"""A parabola through three samples of cos(x), steps d apart, misses its crest by at most 0.025 d^4; d^2 is told by its bend."""


class CirclePeak(NamedTuple):
    """The largest magnitude on the circle: its value, the index of its nearest angle in :func:`circle_angles` and that of its instant.

    The value is that between the angles, from steps FINE times shorter.
    """

    value: float
    place: int
    instant: int


def circle_angles(orders: int, parities: int, *, finer: int = 1) -> FloatArray:
    """Return the angles in degrees of :func:`on_circle`: steps of 1 degree or a whole fraction of it, four to the shortest wave at least.

    0 to 180 for one parity (the rest is its mirror image), 0 to below 360 for two.

    Parameters
    ----------
    orders : int
        M + 1.
    parities : int
        1 or 2.
    finer : int
        Times as many to the shortest wave.
    """
    count = 360 * max(1, -(-4 * finer * orders // 360))
    return np.arange(count // 2 + 1 if parities == 1 else count, dtype=np.float64) * (360.0 / count)


def on_circle(modal: FloatArray, *, finer: int = 1) -> FloatArray:
    """Return the sum of all orders at the angles of :func:`circle_angles`, by FFT.

    Parameters
    ----------
    modal : ndarray, shape (parities, M + 1, T)
    finer : int
        As for the angles.

    Returns
    -------
    ndarray, shape (angles, T)
    """
    parities, orders, times = modal.shape
    points = len(circle_angles(orders, parities, finer=finer))
    if parities == 1:  # even: the cosine transform does half the work
        cosine = np.zeros((points, times))
        cosine[0] = modal[0, 0]
        cosine[1:orders] = 0.5 * modal[0, 1:]
        return np.asarray(scipy.fft.dct(cosine, type=1, axis=0, overwrite_x=True), dtype=np.float64)
    spectrum = np.zeros((points // 2 + 1, times), dtype=np.complex128)
    spectrum[0] = modal[0, 0]
    spectrum[1:orders] = 0.5 * (modal[0, 1:] - 1j * modal[1, 1:])
    return np.asarray(scipy.fft.irfft(spectrum, n=points, axis=0, overwrite_x=True, norm="forward"), dtype=np.float64)


def least_beside(orders: int, parities: int) -> float:
    """Return cos(M h/2), the least share of its largest magnitude that a sum of M + 1 orders has at the nearest angle of the circle.

    h is the step of :func:`circle_angles`. A norm of several sums has it too: that of the combination which it is at its largest.
    """
    return float(np.cos(0.5 * (orders - 1) * np.radians(circle_angles(orders, parities)[1])))


def reachable(modal: FloatArray) -> FloatArray:
    """Return what no sum of the orders at an instant can exceed, at any angle: the sum over m of sqrt(c_m^2 + s_m^2), shape (T,)."""
    return np.asarray((np.abs(modal[0]) if len(modal) == 1 else np.hypot(*modal)).sum(axis=0), dtype=np.float64)


def peak_on_circle(modal: FloatArray, *, above: float = -1.0) -> CirclePeak | None:
    """Return the largest magnitude of a sum of orders over the circle and all instants, the first if there are several.

    Few instants can reach the largest value: a few of the most promising ones are summed first, then those that can reach more. Of all
    crests on the circle's angles, those that may be the highest between them, by a parabola through three angles, are summed finely.

    Parameters
    ----------
    modal : ndarray, shape (parities, M + 1, T)
    above : float
        Values up to this one do not count.

    Returns
    -------
    CirclePeak or None
        None if no value exceeds ``above``.
    """
    bound = reachable(modal) * (1.0 + _ROUNDING)
    few = np.argsort(bound)[-_FIRST:]
    least = np.abs(on_circle(modal[..., few])).max()
    instants = np.flatnonzero((bound >= least) & (bound > above))
    if not instants.size:
        return None
    best = None
    for most, place, members in _crests(np.abs(on_circle(modal[..., instants])), modal, above):
        if best is not None and most < best.value:
            break
        values = np.abs(around(modal[..., instants[members]], place)[1]).max(axis=1)
        found = CirclePeak(float(values.max()), place, int(instants[members[values.argmax()]]))
        if found.value > above and (best is None or (found.value, -found.instant) > (best.value, -best.instant)):
            best = found
    return best


def _crests(field: FloatArray, modal: FloatArray, above: float) -> list[tuple[float, int, npt.NDArray[np.int64]]]:
    """Return where a magnitude (angles, instants) may be the largest between the angles: angles and their instants, ascending.

    With what it can reach at each of the angles, the most promising first.
    """
    parities, orders, _ = modal.shape
    step = (orders - 1) * np.radians(circle_angles(orders, parities)[1])
    place, instant = np.nonzero(field >= least_beside(orders, parities) * max(float(field.max()), above))
    last = len(field) - 1
    if parities == 1:  # its mirror image goes on at both ends
        left, right = np.abs(place - 1), last - np.abs(last - place - 1)
    else:
        left, right = place - 1, (place + 1) % len(field)
    here, before, after = field[place, instant], field[left, instant], field[right, instant]
    bend = 2.0 * here - before - after
    top = here + np.divide((after - before) ** 2, 8.0 * bend, out=np.zeros_like(here), where=bend > 0)
    crest = (here >= before) & (here >= after)
    curved = np.minimum(_VERTEX * step**4, 4.0 * _VERTEX * np.divide(bend, here, out=np.ones_like(here), where=here > 0) ** 2)
    sure = max(float((top * (1.0 - curved))[crest].max(initial=0.0)), above)
    most = top * (1.0 + curved + _ROUNDING)
    high = crest & (most >= sure)
    found = []
    for one in np.unique(place[high]):
        here_too = high & (place == one)
        found.append((float(most[here_too].max()), int(one), instant[here_too]))
    return sorted(found, key=lambda one: -one[0])


def around(modal: FloatArray, place: int) -> tuple[FloatArray, FloatArray]:
    """Return angles in degrees up to one step of :func:`circle_angles` around a place on it, FINE to a step, and the sum there.

    Parameters
    ----------
    modal : ndarray, shape (parities, M + 1, T)
    place : int

    Returns
    -------
    tuple of ndarray, shapes (A,) and (T, A)
    """
    parities, orders, _ = modal.shape
    grid = circle_angles(orders, parities)
    angles = grid[place] + (grid[1] - grid[0]) / FINE * np.arange(-FINE, FINE + 1)
    phase = np.radians(angles)[:, None] * np.arange(orders)
    basis = [np.cos(phase), np.sin(phase)][:parities]
    return angles, np.asarray(sum(part.T @ wave.T for part, wave in zip(modal, basis, strict=True)), dtype=np.float64)
