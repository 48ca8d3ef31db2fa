"""Pressure on a square and stress on the shells at chosen instants: what sheets of fields and films are drawn from."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model import RigidShell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.progress import Progress

if TYPE_CHECKING:
    from coaxshell.response import Response

Report = Progress

WALL_ANGLES: FloatArray = np.arange(360.0)
"""Where the stress of a shell is taken: every degree."""

_STAGE = "fields"
BLOCK_BYTES = 0.45e9
"""Bytes that the pressure of one block of frames may take unless told otherwise."""


@dataclass(frozen=True)
class FieldView:
    """A square window around the axis, the source to the right.

    Attributes
    ----------
    half_width : float
        Half of its side, in units of a, the outermost radius.
    pixels : int
        Pixels along a side.
    """

    half_width: float = 3.0
    pixels: int = 450

    def __post_init__(self) -> None:
        if not (np.isfinite(self.half_width) and self.half_width > 0):
            raise InputError("width", f"{2 * self.half_width!r} is not allowed", "give a positive number, in outermost radii")
        if not 16 <= self.pixels <= 4000:
            raise InputError("pixels", f"{self.pixels} is not allowed", "give a whole number from 16 to 4000")

    @property
    def pixel(self) -> float:
        """Side of a pixel, in a."""
        return 2.0 * self.half_width / self.pixels

    @property
    def centres(self) -> FloatArray:
        """Centres of the pixels along either axis, in a, shape (pixels,)."""
        return np.asarray((np.arange(self.pixels) + 0.5 - 0.5 * self.pixels) * self.pixel, dtype=np.float64)


@dataclass(frozen=True)
class Frames:
    """Fields at consecutive instants.

    Attributes
    ----------
    time, milliseconds : ndarray, shape (K,)
        Instants in transits and in ms.
    pressure : ndarray of float32, shape (K, rows, pixels)
        Pa; columns from the lowest x, the source's side last. Rows run upward from the lowest y, or, where the field is its own mirror
        image, from the middle: ``rows`` is then half of ``pixels``, rounded up. :meth:`field` gives whole squares.
    stress : tuple of (ndarray, shape (K, 360), or None)
        Hoop stress of each shell at WALL_ANGLES, Pa; None for a rigid one. In the plane along the axis of head and tail of each in turn,
        at the rows that stations cover.
    """

    time: FloatArray
    milliseconds: FloatArray
    pressure: npt.NDArray[np.float32]
    stress: tuple[FloatArray | None, ...]

    def __len__(self) -> int:
        return len(self.time)

    def one(self, index: int) -> Frames:
        """Return one frame alone."""
        at = slice(index, index + 1)
        stress = tuple(None if around is None else around[at] for around in self.stress)
        return Frames(self.time[at], self.milliseconds[at], self.pressure[at], stress)

    def field(self, index: int) -> npt.NDArray[np.float32]:
        """Return the pressure of one frame on the whole square, rows from the lowest y upward."""
        part = self.pressure[index]
        rows, pixels = part.shape
        # Row i is the mirror image of row pixels - 1 - i; the middle row of an odd number is its own.
        return part if rows == pixels else np.concatenate([part[: 0 if pixels % 2 else None : -1], part])


def instants(response: Response, times: Sequence[float] | FloatArray) -> npt.NDArray[np.intp]:
    """Return the indices of the run's instants nearest to the times (transits); InputError for a time outside the run."""
    try:
        wanted = np.atleast_1d(np.asarray(times, dtype=np.float64))
    except (TypeError, ValueError):
        raise InputError("times", f"{times!r} are not numbers", "give times in transits") from None
    end, step = float(response.time[-1]), float(response.time[1] - response.time[0])
    outside = wanted[~((wanted >= -0.5 * step) & (wanted <= end + 0.5 * step))]
    if wanted.ndim != 1 or not wanted.size or outside.size:
        problem = f"{outside[0]:g} is outside the run" if outside.size else "there are none"
        raise InputError("times", problem, f"give times from 0 to {end:g} transits")
    return np.clip(np.rint(wanted / step), 0, len(response.time) - 1).astype(np.intp)


def field_frames(
    response: Response,
    times: Sequence[float] | FloatArray,
    view: FieldView | None = None,
    *,
    progress: Report | None = None,
    memory: float = BLOCK_BYTES,
) -> Iterator[Frames]:
    """Yield the fields at the run's instants nearest to *times*, in blocks of frames that stay within the memory.

    Parameters
    ----------
    response : Response
    times : sequence of float
        In transits.
    view : FieldView, optional
        The paper's 6 x 6 square of 450 x 450 pixels when left out.
    progress : callable, optional
        Called with the fraction done and the name of the stage.
    memory : float
        Bytes that the pressure of one block may take.

    Raises
    ------
    InputError
        A time is outside the run.
    """
    view = view or FieldView()
    index = instants(response, times)
    stress = [_wall_stress(response, shell) for shell in range(len(response.system.shells))]
    rows = len(_rows(response, view))
    per_block = max(1, int(memory // (8 * rows * view.pixels)))
    for start in range(0, len(index), per_block):
        chosen = index[start : start + per_block]
        done, share = start / len(index), len(chosen) / len(index)
        pressure = _pressure(response, np.asarray(response.time)[chosen], view, _part(progress, done, share))
        if progress is not None:
            progress(done + share, _STAGE)
        yield Frames(
            time=np.asarray(response.time, dtype=np.float64)[chosen],
            milliseconds=1e3 * np.asarray(response.time_seconds, dtype=np.float64)[chosen],
            pressure=pressure,
            stress=tuple(None if around is None else around[chosen] for around in stress),
        )


def gathered(blocks: Iterator[Frames]) -> Frames:
    """Return all blocks as one."""
    parts = list(blocks)
    if len(parts) == 1:
        return parts[0]
    stress = zip(*(part.stress for part in parts), strict=True)
    return Frames(
        time=np.concatenate([part.time for part in parts]),
        milliseconds=np.concatenate([part.milliseconds for part in parts]),
        pressure=np.concatenate([part.pressure for part in parts]),
        stress=tuple(None if parts[0] is None else np.concatenate(parts) for parts in stress),
    )


def _wall_stress(response: Response, shell: int) -> FloatArray | None:
    if isinstance(response.system.shells[shell], RigidShell):
        return None
    return np.asarray(response.stress(shell, angle=WALL_ANGLES), dtype=np.float64)


def _pressure(response: Response, times: FloatArray, view: FieldView, progress: Report | None) -> npt.NDArray[np.float32]:
    arguments: dict[str, Any] = {} if progress is None else {"progress": progress}
    field = response.pressure(x=view.centres, y=_rows(response, view), time=times, front="matched", **arguments)
    return np.asarray(field, dtype=np.float32)


def _rows(response: Response, view: FieldView) -> FloatArray:
    """Return the y of the rows that are computed: the upper half where the field has no sines, so that the lower mirrors it."""
    y = view.centres
    return y[view.pixels // 2 :] if response.solution.normal.shape[1] == 1 else y


def _part(progress: Report | None, done: float, share: float) -> Report | None:
    if progress is None:
        return None

    def report(fraction: float, stage: str) -> None:
        progress(done + share * fraction, _STAGE)

    return report
