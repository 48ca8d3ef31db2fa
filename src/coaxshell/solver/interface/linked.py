"""The prepared structure with its absorbers: exact in the Laplace domain where they are linear, marched where they are not."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.model.gains import limits_currents, limits_voltages
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.progress import Progress
from coaxshell.solver.faced_forces import surface_motion
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.interface.linear import solve_linear
from coaxshell.solver.interface.linear_ring import is_ring, solve_ring
from coaxshell.solver.interface.march import MarchResult
from coaxshell.solver.interface.seen import as_seen
from coaxshell.solver.limited_absorbers import solve_limited_beside
from coaxshell.solver.limited_currents import solve_limited_currents
from coaxshell.solver.limited_voltages import solve_limited
from coaxshell.solver.links.any_law import march_interface
from coaxshell.solver.links.histories import middles_transform
from coaxshell.solver.orders_left_out import Interface
from coaxshell.solver.point_forces import point_force_shares
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.structure_spectra import Moved, StructureSpectra
from coaxshell.solver.tied import solve_tied


def solve_linked(
    structure: StructureSpectra,
    absorbers: AbsorberSet,
    progress: Progress | None = None,
    *,
    saturate: bool = False,
    exact: bool | None = None,
) -> SolvedSpectra:
    """Return the response with absorbers, and with saturating actuators if asked for.

    ``exact`` None chooses: linear absorbers in the Laplace domain, anything nonlinear by the march. False marches linear ones
    too, for comparison. Actuators that nowhere reach their limit leave the linear law, and so the answer without saturation.
    """
    grid = structure.grid
    if limits_voltages(structure.problem.system):
        alone = solve_limited_currents if limits_currents(structure.problem.system) else solve_limited
        limited = (solve_limited_beside if absorbers.count else alone)(structure, absorbers, progress)
        if limited is not None:
            return limited
        saturate = False
    if structure.problem.tied:
        return solve_tied(structure, absorbers, progress, exact=exact)
    if saturate:
        result = march_interface(structure, absorbers, saturate=True, progress=progress)
        if not result.saturated:
            return solve_linked(structure, absorbers, progress, exact=exact)
        return _marched(structure, absorbers, result, structure)
    if absorbers.count == 0:
        force, displacement = np.zeros((0, 2, grid.time.size)), np.zeros((0, grid.time.size))
        moved = Moved(structure.normal, structure.tangential, structure.solid)
        return SolvedSpectra(structure, absorbers, *moved, force, displacement)
    structure.solve(units=True)  # in one pass with the sources, where nothing has been asked of it yet
    if absorbers.is_linear if exact is None else exact:
        if is_ring(absorbers) and structure.problem.point_force_shares is point_force_shares:
            found = solve_ring(structure, absorbers)
        else:
            found = solve_linear(structure, absorbers, InterfacePoints(structure.problem, absorbers, structure.modes), progress)
        moved = structure.forced_spectra(found.modal_pressure)
        force, displacement = absorbers.of_every(grid.invert(found.force), grid.invert(found.mass_displacement))
        transforms = found.force, found.mass_displacement
        return SolvedSpectra(structure, absorbers, *moved, force, displacement, exact=transforms)
    seen = as_seen(structure, absorbers)
    return _marched(structure, absorbers, march_interface(seen, absorbers, progress=progress), seen)


def _marched(structure: StructureSpectra, absorbers: AbsorberSet, result: MarchResult, seen: StructureSpectra) -> SolvedSpectra:
    """Return the answer of a structure to the forces of a march, without its feedback where actuators saturated.

    ``seen`` is what marched: the structure, or what its absorbers see of it.
    """
    grid = structure.grid
    if result.actuation is not None:
        moved = structure.open_loop.forced_spectra(grid.transform_linear(result.modal_pressure))
    else:
        points = InterfacePoints(structure.problem, absorbers, structure.modes)
        forces = grid.transform_linear(result.force) if result.laws is None else middles_transform(grid, result.laws.force)
        moved = structure.forced_spectra(points.project(forces))
    force, displacement = absorbers.of_every(result.force, result.mass_displacement)
    done = result.actuation, result.iterations
    return SolvedSpectra(structure, absorbers, *moved, force, displacement, *done, laws=result.laws, seen=seen)


def interface_of(solved: SolvedSpectra, normal: FloatArray, kept: slice, asked: FloatArray | None) -> Interface | None:
    """Return what absorbers and actuators did, for the error estimates; None without any.

    Parameters
    ----------
    solved : SolvedSpectra
    normal : ndarray, shape (shells, parities, M + 1, instants)
        W at the instants kept of the grid.
    kept : slice
    asked : ndarray, same shape, or None
        Modal pressures that the control law asked for, where actuators may saturate.
    """
    absorbers = solved.absorbers
    if not absorbers.count and asked is None:
        return None
    first = _representatives(absorbers)
    force = solved.force[first].swapaxes(0, 1)
    stretch = np.zeros((2, 0, 0))
    if not absorbers.is_linear and solved.laws is None:
        surfaces = (
            normal
            if solved.solid is None
            else solved.grid.invert(surface_motion(solved.problem, solved.normal, solved.solid.faces))[..., kept]
        )
        walls = InterfacePoints(solved.problem, absorbers, solved.modes).evaluate(surfaces)
        stretch = solved.displacement[first][:, kept] - walls.reshape(2, absorbers.count, -1)
    force = force.reshape(2 * absorbers.count, solved.grid.time.size)
    saturating = None if solved.actuation is None else solved.structure
    linear = None if solved.laws is None else solved.laws.linear
    marched = solved.marched and solved.exact is None
    return Interface(absorbers, force, stretch, solved.actuation, marched, saturating, asked, linear, solved.seen)


def _representatives(absorbers: AbsorberSet) -> npt.NDArray[np.int64]:
    """Return the number in the description of the first absorber that each one carried stands for."""
    return np.array([int(np.flatnonzero(absorbers.member == i)[0]) for i in range(absorbers.count)], dtype=np.int64)


def modal_pressure_of(structure: StructureSpectra, absorbers: AbsorberSet, force: FloatArray) -> FloatArray:
    """Return the modal pressures (surfaces, parities, M + 1, T) of stored absorber forces (N, 2, T)."""
    points = InterfacePoints(structure.problem, absorbers, structure.modes)
    return points.project(force[_representatives(absorbers)].swapaxes(0, 1).reshape(2 * absorbers.count, -1))
