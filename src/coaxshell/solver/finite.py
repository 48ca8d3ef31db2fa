"""The guard between the solver and everyone else: a solution is all numbers, or an error says at which stage it ceased to be."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.finite import Array, first_bad
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra

if TYPE_CHECKING:
    from coaxshell.solver.axial.solution import SpatialSolution

FINER = "use a smaller time_step or fewer modes"


class Stage(NamedTuple):
    """A stage of the solution and what it made.

    Attributes
    ----------
    where : str
        The part of the description that most likely caused a failure there.
    name : str
    values : ndarray
        Its last axis is of Laplace nodes or of instants.
    axes : tuple of str
        Names of the axes before the last.
    in_time : bool
        Whether the last axis is time.
    remedy : str
    """

    where: str
    name: str
    values: Array
    axes: tuple[str, ...]
    in_time: bool
    remedy: str


def require_finite_solution(solution: ModalSolution, where: str = "response", remedy: str = FINER) -> None:
    """Refuse a solution with NaN or infinity in any of its arrays: where solutions become responses, however they came about.

    Parameters
    ----------
    solution : ModalSolution
    where : str
        What the error names: the path of a file.
    remedy : str

    Raises
    ------
    InputError
        With the array, the shell or absorber, the order and the first instant.
    """
    shells = ("shell", "half", "order")
    for name, values, axes in (
        ("time", solution.time, ()),
        ("the normal displacement", solution.normal, shells),
        ("the tangential displacement", solution.tangential, shells),
        ("the hoop stress", solution.hoop if solution.here("hoop") else None, shells),
        ("the potentials", solution.potentials if solution.here("potentials") else None, ("layer", *shells)),
        ("the normal velocity", solution.normal_rate, shells),
        ("the tangential velocity", solution.tangential_rate, shells),
        ("the displacement of the absorbers", solution.absorber_displacement, ("absorber",)),
        ("the force of the absorbers", solution.absorber_force, ("absorber", "side")),
        ("what saturated actuators lack", solution.control_correction, shells),
        ("the voltage of the feedback", solution.control_voltage, shells),
        ("the voltage of the segments", solution.segment_voltage, ("shell", "segment")),
    ):
        index = None if values is None else first_bad(values)
        if values is not None and index is not None:
            raise _told(Stage(where, name, values, axes, True, remedy), index, solution.time)


def require_finite_stations(solution: SpatialSolution, where: str = "response", remedy: str = FINER) -> None:
    """Refuse a solution of three dimensions with NaN or infinity in any of its fields; see :func:`require_finite_solution`."""
    axes = ("station", "shell", "half", "order")
    found: list[Stage] = [Stage(where, "time", solution.time, (), True, remedy)]
    found += [Stage(where, f"the field {name}", values, axes, True, remedy) for name, values in solution.fields.items()]
    for name, of_absorbers, along in (
        ("displacement", solution.absorber_displacement, ("absorber",)),
        ("force", solution.absorber_force, ("absorber", "side")),
        ("displacement", solution.line_displacement, ("station", "absorber")),
        ("force", solution.line_force, ("station", "absorber", "side")),
    ):
        found += [] if of_absorbers is None else [Stage(where, f"the {name} of the absorbers", of_absorbers, along, True, remedy)]
    for stage in found:
        index = first_bad(stage.values)
        if index is not None:
            raise _told(stage, index, solution.time)


def require_finite_stages(solved: SolvedSpectra) -> None:
    """Refuse spectra of the spectral engine with NaN or infinity, naming the stage in which it began.

    What the earlier stages left is looked through only once their result has been found wanting.
    """
    results: list[Array] = [solved.normal, solved.tangential, solved.force, solved.displacement]
    results += [] if solved.actuation is None else [solved.actuation]
    if all(first_bad(array) is None for array in results):
        return
    for stage in _stages(solved):
        index = first_bad(stage.values)
        if index is not None:
            raise _told(stage, index, solved.grid.time if stage.in_time else solved.grid.nodes.imag)


def _stages(solved: SolvedSpectra) -> Iterator[Stage]:
    """Yield what the stages made, in their order."""
    structure = solved.structure
    pair, shells = ("answering shell", "loaded shell", "order"), ("shell", "half", "order")
    extreme = "look for a layer, fluid or gap of extreme size, density or stiffness"
    for parts in (structure.units, structure.units.open_loop):
        if parts is not None and parts.compliance is not None:
            yield Stage("shells", "the answer of shells and fluids to forces", parts.compliance, pair, False, extreme)
    source = "look for a source extremely near or far, an extreme pulse, or extreme layers and fluids"
    yield Stage("source", "the answer of shells and fluids to the source", structure.normal, shells, False, source)
    yield Stage("source", "the answer of shells and fluids to the source", structure.tangential, shells, False, source)
    if structure.units.kernels is not None:
        yield Stage("time_step", "the kernels of the interface march", structure.units.kernels.kernels, pair, True, FINER)
    if structure.units.kernels_with_voltage is not None:
        voltage = structure.units.kernels_with_voltage.kernels
        yield Stage("control", "the kernels of the voltages asked for", voltage, pair, True, f"{FINER}, or lower the gains")
    softer = f"{FINER}, or softer, less damped absorbers"
    yield Stage("absorbers", "the force of the absorbers", solved.force, ("absorber", "side"), True, softer)
    yield Stage("absorbers", "the displacement of the absorbers", solved.displacement, ("absorber",), True, softer)
    if solved.actuation is not None:
        yield Stage("control", "what saturating actuators give", solved.actuation, shells, True, f"{FINER}, or lower the gains")
    yield Stage("absorbers", "the motion with absorbers and limits", solved.normal, shells, False, softer)
    yield Stage("absorbers", "the motion with absorbers and limits", solved.tangential, shells, False, softer)


def _told(stage: Stage, index: tuple[int, ...], along: Array) -> InputError:
    places = [f"{name} {i}" for name, i in zip(stage.axes, index, strict=False)]
    last = float(along[index[-1]])
    places.append(f"t = {last:.4g} transits" if stage.in_time else f"frequency {last:.4g} per transit")
    value = stage.values[index]
    return InputError(stage.where, f"{stage.name} is {value:.3g} first at {', '.join(places)}: no result is given", stage.remedy)


@contextmanager
def numerical_failures(grid: LaplaceGrid) -> Iterator[None]:
    """Turn the failure of a linear solve inside a ``with`` block into an InputError; warnings of NumPy pass as they are."""
    try:
        yield
    except (np.linalg.LinAlgError, OverflowError, FloatingPointError, ZeroDivisionError) as error:
        step = f"with steps of {grid.time_step:.3g}, the numbers of this system leave the range of the computer ({error})"
        raise InputError("time_step", step, f"{FINER}; look for extreme layers, fluids, gaps or absorbers") from error
