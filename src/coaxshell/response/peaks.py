"""Largest magnitude and root mean square of a quantity over a shell and over time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.circle import around, peak_on_circle
from coaxshell.response.synthesis import angle_basis, at_angles, mean_square, time_blocks

Amplitudes = Callable[[slice], FloatArray]
"""Gives the modal amplitudes (parities, M + 1, T) of a quantity at a slice of time indices."""


@dataclass(frozen=True)
class Peak:
    """The largest magnitude of a quantity.

    Attributes
    ----------
    value : float
        Its magnitude, SI.
    time : float
        When, in transits.
    angle : float
        Where, degrees from the source direction, above -180 up to 180.
    growing : bool
        Whether it still grows at the end of the window: the run is too short to tell how large it becomes.
    lower_half : float or None
        What the orders up to M/2 give alone, for quantities that converge slowly with M; None where it is not asked for.
    """

    value: float
    time: float
    angle: float
    growing: bool = False
    lower_half: float | None = None


def made_once(amplitudes: Amplitudes, span: slice) -> Amplitudes:
    """Return the amplitudes of windows within a span of time that have been made for all of it: for several looks at them."""
    modal = amplitudes(span)
    return lambda window: modal[..., window.start - span.start : window.stop - span.start]


def folded(angle: float) -> float:
    """Return an angle in degrees as one above -180 up to 180."""
    return 180.0 - (180.0 - angle) % 360.0


def peak_at(amplitudes: Amplitudes, time: FloatArray, window: slice, angles: list[float]) -> list[Peak]:
    """Return the largest magnitude over a window of time at each of some angles (degrees)."""
    modal = amplitudes(window)
    values = np.abs(at_angles(modal, angle_basis(angles, modal.shape[1], modal.shape[0])))
    when = values.argmax(axis=0)
    return [Peak(float(values[k, i]), float(time[window][k]), folded(angles[i]), _at_the_end(k, values[:, i])) for i, k in enumerate(when)]


def _at_the_end(instant: int, values: FloatArray) -> bool:
    """Return whether the largest of some magnitudes is the last one, and more than the one before."""
    return bool(instant == len(values) - 1 > 0 and values[-1] > values[-2])


def peak_anywhere(amplitudes: Amplitudes, time: FloatArray, window: slice, width: int) -> Peak:
    """Return the largest magnitude over a window of time and the whole circle.

    The circle is searched in steps of 1 degree or finer at every instant (blocks of time keep the memory small), then in steps
    40 times finer around the largest value found, at its instant and the two beside it.

    Parameters
    ----------
    amplitudes : callable
    time : ndarray, shape (T,)
        Transits.
    window : slice
    width : int
        Angles of the search, ``len(circle_angles(...))``: sets the size of a block.
    """
    highest, instant, place = -1.0, window.start, 0
    for block in time_blocks(window, width):
        found = peak_on_circle(amplitudes(block), above=highest)
        if found is not None:
            highest, instant, place = found.value, block.start + found.instant, found.place
    return _refined(amplitudes, time, window, instant, place)


def _refined(amplitudes: Amplitudes, time: FloatArray, window: slice, instant: int, place: int) -> Peak:
    near = slice(max(window.start, instant - 1), min(window.stop, instant + 2))
    modal = amplitudes(near)
    angles, sums = around(modal, place)
    values = np.abs(sums)
    k, i = np.unravel_index(int(values.argmax()), values.shape)
    angle = folded(float(angles[i]))
    last = near.stop == window.stop and _at_the_end(int(k), values[:, i])
    return Peak(float(values[k, i]), float(time[near.start + k]), abs(angle) if modal.shape[0] == 1 else angle, last)


def root_mean_square(amplitudes: Amplitudes, time: FloatArray, window: slice, width: int) -> float:
    """Return the RMS over the circle and the window, exact in angle (Parseval) and by the trapezoidal rule in time.

    sqrt((1/(t_2 - t_1)) int (1/(2 pi)) oint q^2 dtheta dt); for a window of one instant, the RMS over the circle.
    """
    squares = np.concatenate([mean_square(amplitudes(block)) for block in time_blocks(window, width)])
    span = time[window]
    if len(span) == 1:
        return float(np.sqrt(squares[0]))
    return float(np.sqrt(np.trapezoid(squares, span) / (span[-1] - span[0])))
