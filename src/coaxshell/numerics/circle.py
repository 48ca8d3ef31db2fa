"""Sums of circumferential orders over the whole circle by FFT, and the largest of them.

A modal array has the shape (parities, M + 1, T): half 0 multiplies cos(m theta), half 1 (absent when it vanishes) sin(m theta).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.fft

from coaxshell.numerics.arrays import FloatArray

_FIRST = 16
"""Instants summed before the others are judged by what they can reach."""
_ROUNDING = 1e-9
FINE = 40
"""Steps into which a step of the circle is cut around the largest value found on it."""


class CirclePeak(NamedTuple):
    """The largest magnitude on the circle: its value, the index of its angle in :func:`circle_angles` and that of its instant."""

    value: float
    place: int
    instant: int


def circle_angles(orders: int, parities: int, *, finer: int = 1) -> FloatArray:
    """Return the angles in degrees of :func:`on_circle`: steps of 1 degree or a whole fraction of it, four to the shortest wave at least.

    0 to 180 for one half (the rest is its mirror image), 0 to below 360 for two.

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


def reachable(modal: FloatArray) -> FloatArray:
    """Return what no sum of the orders at an instant can exceed, at any angle: the sum over m of sqrt(c_m^2 + s_m^2), shape (T,)."""
    return np.asarray((np.abs(modal[0]) if len(modal) == 1 else np.hypot(*modal)).sum(axis=0), dtype=np.float64)


def peak_on_circle(modal: FloatArray, *, above: float = -1.0, finer: int = 1) -> CirclePeak | None:
    """Return the largest magnitude of a sum of orders over the circle and all instants, the first if there are several.

    Few instants can reach the largest value: a few of the most promising ones are summed first, then those that can reach more.

    Parameters
    ----------
    modal : ndarray, shape (parities, M + 1, T)
    above : float
        Values up to this one do not count.
    finer : int
        As for the angles.

    Returns
    -------
    Crest or None
        None if no value on the circle's angles exceeds ``above``.
    """
    bound = reachable(modal) * (1.0 + _ROUNDING)
    few = np.argsort(bound)[-_FIRST:]
    least = np.abs(on_circle(modal[..., few], finer=finer)).max()
    instants = np.flatnonzero((bound >= least) & (bound > above))
    if not instants.size:
        return None
    field = np.abs(on_circle(modal[..., instants], finer=finer))
    place, which = np.unravel_index(int(field.argmax()), field.shape)
    value = float(field[place, which])
    return CirclePeak(value, int(place), int(instants[which])) if value > above else None


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
