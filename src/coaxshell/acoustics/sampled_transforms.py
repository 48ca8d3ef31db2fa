"""Laplace transforms of histories that are linear between samples: exact for ramps of any length, and fast for long records.

A record f is the sum of its changes, each spread evenly over its interval of length h around the middle m,

    s f^(s) = f_0 e^{-s t_0} - f_J e^{-s t_J} + sum_j Delta f_j e^{-s m_j} sinh(s h_j/2)/(s h_j/2),

which holds for h -> 0, where it is a step; slopes would not. Long records on the uniform nodes of a Laplace grid are gathered in cells
half a time step wide, by their moments about the cells' centres,

    e^{-s t} = e^{-s t_c} sum_k (-s)^k (t - t_c)^k/k!,

one FFT a moment: its cost does not depend on the number of samples, and |s| times half a cell is at most pi/4, so 14 moments are exact.
"""

from __future__ import annotations

import numpy as np
from scipy import fft

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.threads import WORKERS

_MOMENTS = 14
_FEW = 200_000
"""Products of samples and nodes up to which the sum is taken as it stands."""
_BLOCK = 1_000_000
_FORGOTTEN = 40.0
"""sigma t beyond which e^{-sigma t} is less than rounding."""


def piecewise_linear(s: ComplexArray, times: FloatArray, values: FloatArray) -> ComplexArray:
    """Return the transform of a history that is linear between samples, zero before the first and after the last.

    Parameters
    ----------
    s : ndarray, shape (nodes,)
        Re s > 0. Evenly spaced along a line of constant real part, from the real axis, the transform of a long record is fast.
    times, values : ndarray, shape (samples,)
        Ascending times from 0 on.
    """
    if is_long(s, times):
        return _by_moments(s, times, values)
    return _by_sum(s, times, values)


def is_long(s: ComplexArray, times: FloatArray) -> bool:
    """Return whether the transform of a record at some nodes is made from moments, which any nodes of the same contour share."""
    return times.size * s.size > _FEW and _is_uniform(s)


def _ends(s: ComplexArray, times: FloatArray, values: FloatArray) -> ComplexArray:
    return np.asarray(values[0] * np.exp(-s * times[0]) - values[-1] * np.exp(-s * times[-1]))


def _by_sum(s: ComplexArray, times: FloatArray, values: FloatArray) -> ComplexArray:
    """Return the transform by the sum over all changes."""
    change, width = np.diff(values), np.diff(times)
    result = np.empty_like(s)
    block = max(1, _BLOCK // times.size)
    for start in range(0, s.size, block):
        nodes = s[start : start + block]
        waves = np.exp(-np.outer(times, nodes))
        phase = np.outer(width, nodes)
        small = np.abs(phase) < 0.5
        divisor = np.where(small, 1.0, phase)
        far = (waves[:-1] - waves[1:]) / divisor
        near = waves[:-1] * _falling(np.where(small, phase, 0.0))
        result[start : start + block] = (_ends(nodes, times, values) + change @ np.where(small, near, far)) / nodes
    return result


def _falling(z: ComplexArray) -> ComplexArray:
    """Return (1 - e^{-z})/z for |z| < 1/2 by its series."""
    total = np.ones_like(z)
    for k in range(15, 1, -1):
        total = 1.0 - z * total / k
    return total


def _is_uniform(s: ComplexArray) -> bool:
    spacing = s[1].imag - s[0].imag
    even = spacing * np.arange(s.size)
    return bool(s[0].imag == 0.0 and spacing > 0.0 and np.ptp(s.real) == 0.0 and np.allclose(s.imag, even, rtol=1e-12, atol=0.0))


def _by_moments(s: ComplexArray, times: FloatArray, values: FloatArray) -> ComplexArray:
    """Return the transform at uniform nodes from the moments of the changes within cells."""
    shift, spacing = float(s[0].real), float(s[1].imag)
    cells = int(fft.next_fast_len(4 * s.size, real=True))
    cell = 2.0 * np.pi / spacing / cells
    last = min(float(times[-1]), times[0] + _FORGOTTEN / shift)
    edges = cell * np.arange(np.floor(times[0] / cell) + 1.0, np.ceil(last / cell))
    within = times <= last
    knots = np.sort(np.concatenate([times[within], [last], edges]), kind="stable")  # merges runs that are sorted
    levels = np.interp(knots, times, values)
    middle = 0.5 * (knots[1:] + knots[:-1])
    place = np.floor(middle / cell)
    begin, end = (2.0 * (x / cell - place) - 1.0 for x in (knots[:-1], knots[1:]))
    weight = np.diff(levels) * np.exp(-shift * cell * (place + 0.5))
    starts = np.flatnonzero(np.diff(place, prepend=-1.0))
    folded = (place[starts] % cells).astype(np.int64)
    half = -0.5 * cell * s
    total, factor = np.zeros_like(s), np.ones_like(s)
    mean, power = np.ones_like(begin), np.ones_like(begin)  # of x^k over an interval: (b^{k+1} - a^{k+1})/((k + 1)(b - a)), undivided
    for k in range(_MOMENTS):
        moments = np.bincount(folded, np.add.reduceat(weight * mean, starts) / (k + 1.0), cells)
        total += factor * fft.rfft(moments, workers=WORKERS)[: s.size]
        factor *= half / (k + 1.0)
        power *= begin
        mean *= end
        mean += power
    total *= np.exp(-0.5j * cell * s.imag)
    return np.asarray((total + _ends(s, knots, levels)) / s)
