"""Fewer instants of a run: what can be kept when a file is to be small."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model.control import PDControl
from coaxshell.model.parts import laws_of
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.differences import time_derivative
from coaxshell.numerics.scalars import plain
from coaxshell.response import arguments
from coaxshell.response.dataset import ARRAYS
from coaxshell.solver.solution import ModalSolution

if TYPE_CHECKING:
    from coaxshell.solver.axial.solution import SpatialSolution


def thinned(solution: ModalSolution, every: int, window: Sequence[float] | None) -> ModalSolution:
    """Return a solution with every so many instants of a window; rates that feedback needs are taken from the whole history first.

    Parameters
    ----------
    solution : ModalSolution
    every : int
        1 keeps all of the window's instants.
    window : (start, end), optional
        Transits; the whole run unless given.

    Raises
    ------
    InputError
        If *every* or the window is not allowed, or fewer than two instants would be left.
    """
    kept = _kept(solution.time, every, window)
    arrays: dict[str, Any] = {"normal": solution.normal, "tangential": solution.tangential, **_rates(solution)}
    for name, (dims, _, _) in ARRAYS.items():
        values = arrays.get(name, getattr(solution, name, None))
        if values is not None and dims[-1] == "time":
            arrays[name] = values[..., kept].copy()
    fewer = replace(solution, time=solution.time[kept].copy(), **arrays)
    return replace(fewer, warnings=with_missing(fewer))


def thinned_stations(solution: SpatialSolution, every: int, window: Sequence[float] | None) -> SpatialSolution:
    """Return a solution of three dimensions with every so many instants of a window; see :func:`thinned`."""
    fewer = some_instants(solution, _kept(solution.time, every, window))
    return replace(fewer, warnings=with_missing(fewer))


def some_instants(solution: SpatialSolution, kept: slice | npt.NDArray[np.intp]) -> SpatialSolution:
    """Return a solution of three dimensions with some of its instants."""
    from coaxshell.solver.axial.solution import LINES

    fields = {name: values[..., kept].copy() for name, values in solution.fields.items()}
    absorbers = {name: getattr(solution, name) for name in ("absorber_displacement", "absorber_force", *LINES)}
    absorbers = {name: None if values is None else values[..., kept].copy() for name, values in absorbers.items()}
    return replace(solution, time=solution.time[kept].copy(), fields=fields, spectra=None, **absorbers)


def _kept(time: FloatArray, every: int, window: Sequence[float] | None) -> slice:
    """Return which instants are kept."""
    every = plain(every)
    if isinstance(every, bool) or not isinstance(every, int) or every < 1:
        raise InputError("every", f"{every!r} is not allowed", "give a whole number of time steps, 1 or more")
    span = arguments.time_window(time, window)
    kept = slice(span.start, span.stop, every)
    if time[kept].size < 2:
        raise InputError("every", f"{every} leaves fewer than two instants", f"give at most {max(1, time[span].size - 1)}")
    return kept


def _rates(solution: ModalSolution) -> dict[str, Any]:
    """Return the rates of change that derivative control reads, where the engine kept none."""
    laws = [law for law in laws_of(solution.problem.system) if isinstance(law, PDControl) and law.derivative]
    if not laws or solution.normal_rate is not None or not solution.whole:
        return {}
    step = solution.settings.time_step
    return {"normal_rate": time_derivative(solution.normal, step), "tangential_rate": time_derivative(solution.tangential, step)}


def with_missing(solution: ModalSolution | SpatialSolution) -> tuple[str, ...]:
    """Return the warnings of a solution with one more where instants are missing."""
    known = tuple(text for text in solution.warnings if not text.endswith(_MISSING))
    return known if solution.whole else (*known, f"{solution.time.size} of the run's {solution.settings.steps + 1} instants {_MISSING}")


_MISSING = "are held: a peak between them is missed, and fields and energy need all of them"
