"""A film of the field: one system, or several side by side."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.memory import available
from coaxshell.numerics.scalars import plain
from coaxshell.plotting.cut_frames import Shown, Solved, shown_runs
from coaxshell.plotting.field_scales import FieldScales, check_units, field_scales
from coaxshell.plotting.film_canvas import Canvas
from coaxshell.plotting.film_files import film_writer, write_film
from coaxshell.plotting.frames import FieldView, Frames, Report
from coaxshell.plotting.snapshots import headings, share_of

if TYPE_CHECKING:
    from coaxshell.response import Response

Bytes = npt.NDArray[np.uint8]

_STAGE = "film"
BLOCK_MEMORY = 0.9e9
"""Bytes that the pressure of one block of frames may take unless told otherwise."""
_WORKING = 0.4e9
"""Bytes with which the field of a block of frames is computed, beside the block itself."""


def save_film(
    *responses: Response,
    path: str | Path,
    frames: int = 250,
    fps: float = 25.0,
    until: float | None = None,
    view: FieldView | None = None,
    pressure_limit: float | None = None,
    stress_limit: float | None = None,
    names: Sequence[str] = (),
    units: str = "auto",
    progress: Report | None = None,
    memory: float = BLOCK_MEMORY,
    station: Any = None,
) -> Path:
    """Write a film of the pressure field and of the stress on the shells; several responses are shown side by side.

    Of a run in three dimensions the cross-section at a station and the plane y = 0 along the axis stand side by side, in which shells
    show their stress at head and tail as far as the stations go; both are solved for all frames at once.

    Parameters
    ----------
    *responses : Response
    path : str or Path
        An .mp4 (needs the extra ``coaxshell[video]``) or a .webp.
    frames : int
        Number of frames, from the impact to *until*.
    fps : float
        Frames per second.
    until : float, optional
        Last instant in transits; the end of the shortest run when left out.
    view : FieldView, optional
        What each panel shows and its side in pixels; the paper's 6 x 6 square of 450 x 450 when left out.
    pressure_limit, stress_limit : float, optional
        Ends of the two colour scales, Pa, the same for all frames; chosen from the whole film when left out.
    names : sequence of str
        Headings; the names of the systems when left out.
    units : str
        Of the pressure; one of PRESSURE_UNITS.
    progress : callable, optional
        Called with the fraction done and the name of the stage.
    memory : float
        Bytes that the pressure of one block of frames may take, all systems together; less where less is free.
    station : float or str, optional
        Of the cross-sections of runs in three dimensions, m or text; the first of each when left out.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        An argument is not allowed, the film does not fit into memory, or cannot be written.
    """
    target = Path(path)
    check_film(target, frames, fps)
    view = view or FieldView()
    times = film_times(responses, frames, until)
    runs = shown_runs(responses, headings(responses, names), station)
    panels = sum(len(run.panels) for run in runs)
    parities = max(response.solution.normal.shape[1] for response in responses)
    kept = sum(4.0 * response.solution.normal.nbytes for response in responses)
    require_room(film_cost(panels, frames, view, parities=parities, kept=kept, memory=memory), frames, view)
    check_units(units)
    solved = [run.solved(times, view, share_of(progress, number, len(runs))) for number, run in enumerate(runs)]
    canvas = Canvas(runs, view, _film_scales(solved, pressure_limit, stress_limit), units)
    pictures = _pictures(canvas, solved, len(times), _for_blocks(memory) / len(responses), progress)
    write_film(target, (canvas.width, canvas.height), len(times), fps, pictures)
    return target


def check_film(path: Path, frames: int, fps: float) -> None:
    """Raise InputError if a film of this kind, length and rate cannot be made here."""
    frames = plain(frames)
    if isinstance(frames, bool) or not isinstance(frames, int) or not 2 <= frames <= 100_000:
        raise InputError("frames", f"{frames!r} is not allowed", "give a whole number from 2 to 100000")
    if not (math.isfinite(fps) and 0.1 <= fps <= 240):
        raise InputError("fps", f"{fps!r} is not allowed", "give a number from 0.1 to 240")
    film_writer(path)


def film_cost(systems: int, frames: int, view: FieldView, *, parities: int = 1, kept: float = 0.0, memory: float = BLOCK_MEMORY) -> Cost:
    """Return what a film costs beside its runs; the seconds were measured, and hold within a factor of 3.

    Parameters
    ----------
    systems : int
        Side by side.
    frames : int
    view : FieldView
    parities : int
        1 where the fields are their own mirror images, and half of each is computed; else 2.
    kept : float
        Bytes of the transforms of the walls' motion, all systems together.
    memory : float
        As of :func:`save_film`.
    """
    rows = -(-view.pixels // 2) if parities == 1 else view.pixels
    frame = 8.0 * rows * view.pixels
    block = max(1.0, min(frames, _for_blocks(memory) / systems // frame))
    held = frame * (1.5 * block + 0.5 * min(block, frames - block))  # in double and in single precision, and the block before
    return Cost(systems * held + _WORKING + kept, systems * (8.0 + frames * (0.033 + 7e-8 * view.pixels**2)))


def require_room(cost: Cost, frames: int, view: FieldView) -> None:
    """Raise InputError if a film does not fit into memory."""
    if not cost.fits:
        what = f"a film of {frames:,} frames of {view.pixels:,} x {view.pixels:,} pixels"
        cost.require(what, "use fewer pixels")


def _for_blocks(memory: float) -> float:
    """Return the bytes that blocks of frames may take: less than was said where less is free."""
    free = available()
    return memory if free is None else min(memory, 0.3 * free)


def films_cost(runs: Sequence[Shown], frames: int, view: FieldView) -> Cost:
    """Return what a film of runs at hand costs, the fields of three dimensions with it."""
    cost = film_cost(sum(len(run.panels) for run in runs), frames, view)
    solved = [run.cost(frames, view) for run in runs]
    return Cost(cost.memory + sum(one.memory for one in solved), cost.seconds + sum(one.seconds for one in solved))


def film_times(responses: Sequence[Response], frames: int, until: float | None) -> FloatArray:
    """Return the instants of a film's frames, transits; InputError if there are no runs, or they are shorter."""
    if not responses:
        raise InputError("responses", "there are none", "give at least one response")
    end = min(float(response.time[-1]) for response in responses)
    if until is not None and not 0 < until <= end * (1 + 1e-9):
        raise InputError("until", f"{until!r} is not within the run", f"give a time up to {end:g} transits")
    return np.linspace(0.0, end if until is None else until, frames)


def _film_scales(solved: Sequence[Solved], pressure: float | None, stress: float | None) -> FieldScales:
    """Return scales from instants spread over the film."""
    if pressure is not None and stress is not None:
        return FieldScales(pressure, stress)
    return field_scales([frames for one in solved for frames in one.sample()], pressure, stress)


def _pictures(canvas: Canvas, solved: Sequence[Solved], count: int, memory: float, progress: Report | None) -> Iterator[Bytes]:
    streams = [_each_frame(one.frames(share_of(progress, number, len(solved)), memory)) for number, one in enumerate(solved)]
    for done, parts in enumerate(zip(*streams, strict=True), start=1):
        if progress is not None:
            progress(done / count, _STAGE)
        yield canvas.frame([frames for panels in parts for frames in panels], 0)


def _each_frame(blocks: Iterator[tuple[Frames, ...]]) -> Iterator[tuple[Frames, ...]]:
    """Yield single frames: blocks of runs may be of different lengths."""
    for block in blocks:
        for index in range(len(block[0])):
            yield tuple(frames.one(index) for frames in block)
