"""What runs in a worker process: systems solved, with structures and answers kept; all else is made from the answers."""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from threadpoolctl import ThreadpoolController

from coaxshell.apps.studio import limits, memory
from coaxshell.errors import InputError
from coaxshell.model import System
from coaxshell.numerics.cache import ByteBoundedCache, held_bytes
from coaxshell.response import PreparedSystem, Response, prepare
from coaxshell.solver.settings import Settings
from coaxshell.solver.shared_parts import SharedParts, shared_parts
from coaxshell.studies.executors import begin_worker

STRUCTURE_BYTES, ANSWER_BYTES, FLUID_BYTES = 500_000_000, 100_000_000, 150_000_000
STOP, FRACTION, HELD, FIRST = range(4)
"""Places on the shared board: the task to be stopped, how far the present one is, bytes of memory after the last one, and before all."""


class Stopped(BaseException):
    """The task is no longer wanted; no except clause for mistakes may catch it."""


class Outcome(NamedTuple):
    """How a task ended: "done" with a value, "input" with (where, problem, remedy), or "stopped"."""

    state: str
    value: Any


class _Here:
    """The state of this process."""

    number = 0
    part: tuple[float, float, str] | None = None
    board: Any = None
    stage: Any = None
    structures: ByteBoundedCache[PreparedSystem] = ByteBoundedCache(STRUCTURE_BYTES, held_bytes)
    answers: ByteBoundedCache[Response] = ByteBoundedCache(ANSWER_BYTES, held_bytes)
    fluids: SharedParts = shared_parts(FLUID_BYTES)
    last: tuple[str, Response] | None = None


def begin(board: Any, stage: Any, niceness: int) -> None:
    """Set up a worker process: Ctrl-C and a closed terminal are the server's to handle, and a worker whose server is gone goes too."""
    memory.keep_freed()  # before there are threads, each with a heap of its own
    begin_worker("SIGHUP")
    _Here.board, _Here.stage = board, stage
    os.nice(niceness)
    ThreadpoolController().limit(limits=1, user_api="blas")  # the workers share the cores


def ready() -> int:
    """Import what every task needs, and return the process's number."""
    import coaxshell.plotting.frames  # noqa: F401 - so that the first request need not wait for it

    _Here.board[HELD] = memory.held()
    _Here.board[FIRST] = _Here.board[FIRST] or _Here.board[HELD]
    return os.getpid()


def perform(number: int, task: Callable[..., Any], arguments: tuple[Any, ...]) -> Outcome:
    """Carry out one task; what is wrong with its input comes back as a value."""
    _Here.number, _Here.part = number, None
    _Here.board[FRACTION] = 0.0
    _Here.stage.value = b""
    try:
        return _outcome(task, arguments)
    finally:
        _Here.board[HELD] = memory.held()


def _outcome(task: Callable[..., Any], arguments: tuple[Any, ...]) -> Outcome:
    try:
        return Outcome("done", task(*arguments))
    except Stopped:
        return Outcome("stopped", None)
    except InputError as error:
        return Outcome("input", (error.where, error.problem, error.remedy))
    except (ArithmeticError, ValueError, MemoryError) as error:  # what numbers far out of the usual do to linear algebra
        remedy = "look for a value far from usual, in the system or its resolution"
        return Outcome("input", ("system", f"cannot be solved ({type(error).__name__}: {str(error)[:100]})", remedy))


def report(fraction: float, stage: str) -> None:
    """Tell the server how far the task is; Stopped when it is no longer wanted."""
    if _Here.board is None:
        return
    if _Here.board[STOP] == _Here.number:
        raise Stopped
    if _Here.part is not None:
        begun, share, stage = _Here.part
        fraction = begun + share * fraction
    _Here.board[FRACTION] = fraction
    _Here.stage.value = stage.encode()[:60]


@contextmanager
def part(number: int, count: int, stage: str, width: int = 1) -> Iterator[None]:
    """Make the reports inside a ``with`` block those of one, or of so many, of several equal parts of the task."""
    _Here.part = number / count, width / count, stage
    try:
        report(0.0, stage)
        yield
    finally:
        _Here.part = None


def structure_key(system: System, settings: Settings) -> str:
    """Return what names all that does not depend on the absorbers."""
    return answer_key(system.replace(absorbers=()), settings)


def answer_key(system: System, settings: Settings) -> str:
    """Return what names a system at a resolution; short, since a description with a record has hundreds of kilobytes."""
    return hashlib.blake2b(f"{system.model_dump_json()}{settings}".encode(), digest_size=16).hexdigest()


def answer(system: System, settings: Settings) -> Response:
    """Return the response of a system: the kept one, or the one of its kept structure, or a new one; equal to ``simulate``.

    A preview is kept beyond the next one only once it is judged (:func:`judge`): while a slider moves none is, and nobody comes back. One
    in three dimensions took seconds, and is kept as it is.
    """
    key = answer_key(system, settings)
    if _Here.last is not None and _Here.last[0] == key:
        return _Here.last[1]  # the only one whose transforms are at hand
    found = _Here.answers.get(key)
    if found is not None:
        return found
    _Here.last = None
    response = _in_space(system, settings) if settings.dimensions == 3 else _on_structure(system, settings)
    if not _live(settings):
        _Here.answers.put(key, response.without_transforms())
    elif settings.dimensions == 3:
        _Here.answers.put(key, response)
    _Here.last = key, response
    return response


def _in_space(system: System, settings: Settings) -> Response:
    """Return the response of a system in three dimensions; previews of the same fluids and radii share what these add to the walls."""
    from coaxshell.response.spatial import SpatialResponse
    from coaxshell.solver.axial.solve import solve_spatial

    return SpatialResponse(solve_spatial(system, settings, report, fluids=_Here.fluids if _live(settings) else None))


def _on_structure(system: System, settings: Settings) -> Response:
    """Return the response of a system by its structure, which is kept."""
    key = structure_key(system, settings)
    prepared = _Here.structures.get(key) or _structure(system.replace(absorbers=()), settings)
    try:
        return prepared.simulate(system.absorbers, progress=report)
    finally:
        _Here.structures.put(key, prepared)  # weighed afterwards: it grows with the run


def judge(system: System, settings: Settings) -> dict[str, Any]:
    """Return estimated errors and warnings of a run; it is kept with them."""
    from coaxshell.apps.studio.curves import judgement

    response = answer(system, settings)
    told = judgement(response)
    _Here.answers.put(answer_key(system, settings), response.without_transforms())
    return told


def bars(system: System, settings: Settings) -> list[dict[str, Any]]:
    """Return the bars of a run, as they stand in the header of its curves."""
    from coaxshell.apps.studio.curves import bars_alone
    from coaxshell.apps.studio.station_curves import station_curves
    from coaxshell.response.spatial import SpatialResponse

    response = answer(system, settings)
    if isinstance(response, SpatialResponse):
        found: list[dict[str, Any]] = station_curves(response, 0.0).header["bars"]
        return found
    return bars_alone(response)


def structure(system: System, settings: Settings) -> PreparedSystem:
    """Return all of a system but its absorbers, prepared: kept, or made and kept."""
    key = structure_key(system, settings)
    prepared = _Here.structures.get(key) or _structure(system.replace(absorbers=()), settings)
    _Here.structures.put(key, prepared)
    return prepared


def _live(settings: Settings) -> bool:
    """Return whether a resolution is no finer than what is solved as sliders move."""
    return settings.steps * settings.refinement <= limits.PREVIEW_STEPS


def _structure(system: System, settings: Settings) -> PreparedSystem:
    """Return a structure prepared from what the one used last shares with it, or from nothing."""
    live = _live(settings)  # finer ones would share hundreds of megabytes
    kin = _Here.structures.latest(lambda kept: kept.settings == settings) if live else None
    if kin is not None:
        return kin.retuned(system)
    return prepare(system, settings=settings, retunable=live, progress=report)


def solve(system: System, settings: Settings, with_rates: bool = True, with_bars: bool = True) -> Any:
    """Return the curves of a run, with bars, and velocities and accelerations, if wanted."""
    from coaxshell.apps.studio.curves import curves
    from coaxshell.apps.studio.station_curves import station_curves
    from coaxshell.response.spatial import SpatialResponse

    start = time.perf_counter()
    response = answer(system, settings)
    seconds = time.perf_counter() - start
    if isinstance(response, SpatialResponse):
        return station_curves(response, seconds)
    return curves(response, seconds, with_rates=with_rates, with_bars=with_bars)
