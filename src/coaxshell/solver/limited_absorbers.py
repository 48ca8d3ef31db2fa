"""Absorbers beside voltages or currents that stop at a limit: both nonlinearities together, each marched in turn until they agree.

Under the forces f of the links the electrodes are marched as without them (:mod:`coaxshell.solver.limited_voltages`): the sensors read of
the forces too, and what the limit cuts off moves the points that the links hold, w = w(f). The links then are solved with the receptance R
of the loops without limits (:mod:`coaxshell.solver.tied_points`) around what has been found,

    w = w(f_n) + R (f - f_n),

exactly where they are linear, else by their march. A limit takes back a part of R alone, and that comes to the points later, so that the
turns converge as those of a Volterra equation; the answer they end at does not depend on R.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.gains import limits_currents
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.progress import Progress
from coaxshell.solver.electrode_loops import times
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.interface.linear import forces_at
from coaxshell.solver.interface.march import MarchResult
from coaxshell.solver.limited_currents import CurrentLimits, charge_per_volt
from coaxshell.solver.limited_voltages import LimitedMarch, VoltageLimits, driven_alone, walls_held
from coaxshell.solver.links.any_law import march_interface
from coaxshell.solver.links.histories import middles_transform
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.structure_spectra import Moved, StructureSpectra
from coaxshell.solver.tied import TiedLoops
from coaxshell.solver.tied_points import StructureOfTies, surfaces_moved, whole_receptance
from coaxshell.solver.voltage_response import of_all, read_of

_AGREED = 1e-9
"""Of the largest force of a link."""
_TURNS = 60


@dataclass
class _Forces:
    """Forces of the links, transforms (points, nodes), and where they come from."""

    spectrum: ComplexArray
    masses: ComplexArray | None = None
    marched: MarchResult | None = None


@dataclass
class _Cut:
    """What amplifiers do under forces: voltages given and asked for, the lack, by how much the march is off, the motion."""

    given: ComplexArray
    asked: ComplexArray
    lack: FloatArray
    off: FloatArray
    moved: Moved
    iterations: int


def solve_limited_beside(structure: StructureSpectra, absorbers: AbsorberSet, progress: Progress | None = None) -> SolvedSpectra | None:
    """Return the answer of a structure with absorbers whose electrodes' voltages, or currents, stop at a limit; None where none does.

    Raises
    ------
    InputError
        If feedback is so strong within a step that its limit cannot be found, or links and limits do not come to agree.
    """
    loops, grid = TiedLoops.of(structure, absorbers.parities), structure.grid
    points = InterfacePoints(structure.open_loop.problem, absorbers, structure.modes)
    receptance = whole_receptance(structure, points, loops.patterns)
    alone = loops.answer()[0]
    seen = StructureOfTies(structure, absorbers, alone, loops.patterns)
    found = _linked(absorbers, seen, receptance, points.evaluate(surfaces_moved(structure.problem, alone)), progress)
    free = _free(structure, points, found)
    limits = _limits(loops)
    if not limits.reached(loops.loops.voltages(loops.patterns.readings(read_of(structure, free))), limits.held(free)):
        return None
    march = limits.march()
    for _ in range(_TURNS):
        cut = _cut(loops, limits, march, points, found, progress)
        at = points.evaluate(surfaces_moved(structure.problem, cut.moved)) - np.einsum("pqk,qk->pk", receptance, found.spectrum)
        before, found = found, _linked(absorbers, seen, receptance, at, progress)
        change, most = (np.abs(grid.invert(x)).max() for x in (found.spectrum - before.spectrum, found.spectrum))
        if change <= _AGREED * most:
            return _answer(loops, limits, absorbers, found, _cut(loops, limits, march, points, found, progress), seen)
    raise InputError(
        "time_step", "is too long for limits beside such absorbers: amplifiers and forces do not come to agree", "use a quarter of it"
    )


def _limits(loops: TiedLoops) -> VoltageLimits:
    """Return the limits of the amplifiers of a structure."""
    structure, patterns = loops.structure, loops.patterns
    if limits_currents(structure.problem.system):
        return CurrentLimits(structure, patterns, patterns.responses(charge_per_volt(structure)))
    return VoltageLimits(structure, patterns)


def _free(structure: StructureSpectra, points: InterfacePoints, forces: _Forces) -> Moved:
    """Return the motion under sources and forces without voltages."""
    return structure.open_loop.forced_spectra(points.project(forces.spectrum))


def _cut(
    loops: TiedLoops, limits: VoltageLimits, march: LimitedMarch, points: InterfacePoints, forces: _Forces, progress: Progress | None
) -> _Cut:
    """Return what limited amplifiers do under sources and forces."""
    structure, grid = loops.structure, loops.structure.grid
    pressure, free = points.project(forces.spectrum), _free(structure, points, forces)
    asked = loops.loops.asked(loops.patterns.readings(read_of(structure, free)))
    held = limits.held(free)
    lack, iterations = march.lack(limits.demanded(asked, held), progress)
    lacking = grid.transform_continued(lack)
    given = asked + times(loops.loops.inverse, lacking)
    voltage = of_all(structure.problem, loops.response, loops.patterns.in_orders(given))
    off = limits.off(given, given - lacking, lack, held)
    return _Cut(given, given - lacking, lack, off, loops.moved(free, voltage, pressure), iterations)


def _linked(
    absorbers: AbsorberSet, seen: StructureOfTies, receptance: ComplexArray, at: ComplexArray, progress: Progress | None
) -> _Forces:
    """Return the forces of links on points that move by themselves, (points, nodes), and by a receptance under the forces."""
    grid = seen.grid
    if absorbers.is_linear:
        return _Forces(*forces_at(absorbers, grid.nodes, np.moveaxis(receptance, -1, 0), at))
    seen.stand(at)
    result = march_interface(seen, absorbers, progress=progress)
    spectrum = grid.transform_linear(result.force) if result.laws is None else middles_transform(grid, result.laws.force)
    return _Forces(spectrum, marched=result)


def _answer(
    loops: TiedLoops, limits: VoltageLimits, absorbers: AbsorberSet, forces: _Forces, cut: _Cut, seen: StructureOfTies
) -> SolvedSpectra:
    """Return all of the answer."""
    structure, grid, patterns = loops.structure, loops.structure.grid, loops.patterns
    shown, volts = limits.shown(cut.given, cut.asked)
    marched = forces.marched
    if marched is None:
        assert forces.masses is not None
        of_every = absorbers.of_every(grid.invert(forces.spectrum), grid.invert(forces.masses))
    else:
        of_every = absorbers.of_every(marched.force, marched.mass_displacement)
    found = SolvedSpectra(
        structure,
        absorbers,
        *cut.moved,
        *of_every,
        iterations=cut.iterations + (0 if marched is None else marched.iterations),
        exact=None if forces.masses is None else (forces.spectrum, forces.masses),
        laws=None if marched is None else marched.laws,
        held=walls_held(structure.problem, cut.lack),
        voltage=of_all(structure.problem, loops.response, patterns.in_orders(cut.given)),
        asked=of_all(structure.problem, loops.response, patterns.in_orders(shown)),
        segments=of_all(structure.problem, loops.response, volts) if patterns.cut else None,
        defect=driven_alone(structure, loops.response, patterns, times(loops.loops.inverse, grid.transform_linear(cut.off))),
    )
    return found if marched is None else replace(found, seen=seen)
