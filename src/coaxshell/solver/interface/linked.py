"""The prepared structure with its absorbers: exact in the Laplace domain where they are linear, marched where they are not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.progress import Progress
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.interface.linear import solve_linear
from coaxshell.solver.interface.linear_ring import is_ring, solve_ring
from coaxshell.solver.interface.march import MarchResult, march
from coaxshell.solver.orders_left_out import Interface
from coaxshell.solver.point_forces import point_force_shares
from coaxshell.solver.structure_spectra import StructureSpectra


@dataclass(frozen=True)
class AbsorberSolution:
    """The answer with absorbers and saturation.

    Attributes
    ----------
    normal, tangential : ndarray, shape (shells, parities, M + 1, nodes)
        Transforms of W and V.
    force : ndarray, shape (N, 2, T)
        Line forces on the inner [.., 0] and outer [.., 1] shell, for every absorber of the description.
    displacement : ndarray, shape (N, T)
        q of every absorber of the description.
    actuation : ndarray, shape (shells, parities, M + 1, T), or None
        Modal pressure that saturating actuators gave, None where the linear law held throughout.
    iterations : int
        Of all steps, 0 if solved exactly.
    exact : tuple of ndarray, shapes (2 N, nodes) and (N, nodes), or None
        Transforms of force and displacement of the absorbers carried, where they were solved exactly.
    """

    normal: ComplexArray
    tangential: ComplexArray
    force: FloatArray
    displacement: FloatArray
    actuation: FloatArray | None
    iterations: int
    exact: tuple[ComplexArray, ComplexArray] | None = None


def solve_linked(
    structure: StructureSpectra,
    absorbers: AbsorberSet,
    progress: Progress | None = None,
    *,
    saturate: bool = False,
    exact: bool | None = None,
) -> AbsorberSolution:
    """Return the response with absorbers, and with saturating actuators if asked for.

    ``exact`` None chooses: linear absorbers in the Laplace domain, anything nonlinear by the march. False marches linear ones
    too, for comparison. Actuators that nowhere reach their limit leave the linear law, and so the answer without saturation.
    """
    grid = structure.grid
    if saturate:
        result = march(structure, absorbers, saturate=True, progress=progress)
        if not result.saturated:
            return solve_linked(structure, absorbers, progress, exact=exact)
        return _marched(structure.open_loop, absorbers, result)
    if absorbers.count == 0:
        return AbsorberSolution(
            structure.normal, structure.tangential, np.zeros((0, 2, grid.time.size)), np.zeros((0, grid.time.size)), None, 0
        )
    if absorbers.is_linear if exact is None else exact:
        if is_ring(absorbers) and structure.problem.point_force_shares is point_force_shares:
            found = solve_ring(structure, absorbers)
        else:
            found = solve_linear(structure, absorbers, InterfacePoints(structure.problem, absorbers, structure.modes), progress)
        normal, tangential = structure.forced_spectra(found.modal_pressure)
        force, displacement = _of_every(absorbers, grid.invert(found.force), grid.invert(found.mass_displacement))
        return AbsorberSolution(normal, tangential, force, displacement, None, 0, (found.force, found.mass_displacement))
    return _marched(structure, absorbers, march(structure, absorbers, progress=progress))


def _marched(structure: StructureSpectra, absorbers: AbsorberSet, result: MarchResult) -> AbsorberSolution:
    """Return the answer of a structure to the forces of a march."""
    normal, tangential = structure.forced_spectra(structure.grid.transform_linear(result.modal_pressure))
    force, displacement = _of_every(absorbers, result.force, result.mass_displacement)
    return AbsorberSolution(normal, tangential, force, displacement, result.actuation, result.iterations)


def _of_every(absorbers: AbsorberSet, force: FloatArray, displacement: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return forces (N, 2, T) and displacements (N, T) of every absorber of the description from those carried."""
    sides = force.reshape(2, absorbers.count, force.shape[-1]).swapaxes(0, 1)
    return sides[absorbers.member], displacement[absorbers.member]


def interface_of(
    structure: StructureSpectra, absorbers: AbsorberSet, linked: AbsorberSolution, normal: FloatArray, kept: slice
) -> Interface:
    """Return what absorbers and actuators did, for the error estimates; ``normal`` is W at the instants kept of the grid."""
    first = _representatives(absorbers)
    force = linked.force[first].swapaxes(0, 1)
    stretch = np.zeros((2, 0, 0))
    if absorbers.count and not absorbers.is_linear:
        walls = InterfacePoints(structure.problem, absorbers, structure.modes).evaluate(normal)
        stretch = linked.displacement[first][:, kept] - walls.reshape(2, absorbers.count, -1)
    force = force.reshape(2 * absorbers.count, structure.grid.time.size)
    saturating = None if linked.actuation is None else structure
    return Interface(absorbers, force, stretch, linked.actuation, linked.iterations > 0, saturating)


def _representatives(absorbers: AbsorberSet) -> npt.NDArray[np.int64]:
    """Return the number in the description of the first absorber that each one carried stands for."""
    return np.array([int(np.flatnonzero(absorbers.member == i)[0]) for i in range(absorbers.count)], dtype=np.int64)


def modal_pressure_of(structure: StructureSpectra, absorbers: AbsorberSet, force: FloatArray) -> FloatArray:
    """Return the modal pressures (shells, parities, M + 1, T) of stored absorber forces (N, 2, T)."""
    points = InterfacePoints(structure.problem, absorbers, structure.modes)
    return points.project(force[_representatives(absorbers)].swapaxes(0, 1).reshape(2 * absorbers.count, -1))
