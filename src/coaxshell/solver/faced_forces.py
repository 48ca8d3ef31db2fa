"""What forces do on the surfaces of walls some of which have two faces: their compliance, all that they move, and the kernels of the march.

A face answers a front by the impedance rho c_L of its layer, not by the mass of its wall, and echoes through the thickness come 2 h/c_L
later, within a step or two. Neither a mass nor anything else that stays smooth could be taken out of such kernels in closed form; and what
a face yields where it is held, w = C p, has no velocity between two steps. The trapezoidal rule (:mod:`coaxshell.solver.quadrature`) has
both: its weight at lag 0 is s C(s) at s = 2/dt, which tends to 1/(rho c_L + rho_f c_f) as the step goes and to dt/2 over the mass as the
wall does; and it keeps w = C p. It also moves frequencies, by (omega dt)^2/12: it is applied at a third of the step, whose weights are
summed to forces that are linear between the steps of the march (an odd part, for which w = C p stays true). All of this keeps the positive
real part of the kernels, so that the march cannot grow.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.convolution import summed_weights
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver.cascade import CascadeSystem, FaceMotion
from coaxshell.solver.compliance_sums import ComplianceSums, Pair
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import FacedSystem, SolidSpectra, WallAnswer, band, make_shapes, nothing_moves
from coaxshell.solver.spectral import map_node_blocks, node_blocks

PARTS = 3
"""Steps of the trapezoidal rule in one of the march; odd."""


def surface_motion(problem: Problem, normal: ComplexArray, faces: ComplexArray) -> ComplexArray:
    """Return the displacements of all surfaces, shape (surfaces, parities, M + 1, nodes).

    Parameters
    ----------
    problem : Problem
    normal : ndarray, shape (shells, parities, M + 1, nodes)
        W of all walls.
    faces : ndarray, shape (2, shells, parities, M + 1, nodes)
        Displacements of their faces.
    """
    return np.stack([normal[i] if side is None else faces[side, i] for i, side, _ in problem.surfaces])


def surfaces_of(problem: Problem, answers: list[WallAnswer]) -> ComplexArray:
    """Return the displacements of all surfaces, shape (surfaces, orders, nodes), from what the walls do."""
    return np.stack(moved_surfaces(problem, [answer.faces for answer in answers]))


def moved_surfaces(problem: Problem, faces: list[FaceMotion]) -> list[ComplexArray]:
    """Return the displacement of each surface, of shape (orders, nodes)."""
    return [faces[i].inner if side == 0 else faces[i].outer for i, side, _ in problem.surfaces]


def held_at_one_gap(problem: Problem) -> bool:
    """Return whether the surfaces are the two faces of the one gap of two walls."""
    return [(one.shell, one.side) for one in problem.surfaces] == [(0, 1), (1, 0)] and len(problem.shells) == 2


def surface_compliance(problem: Problem, s: ComplexArray, modes: Modes) -> ComplexArray:
    """Return the displacement of every surface per modal pressure on every other, shape (surfaces, surfaces, orders, nodes).

    Parameters
    ----------
    problem : Problem
        Its walls resolve the waves of the nodes.
    s : ndarray, shape (nodes,)
        A block of nodes.
    modes : Modes
    """
    cascade = CascadeSystem(problem, s, modes)  # what walls show beside their faces is not asked for
    if held_at_one_gap(problem):
        return np.array(cascade.gap_compliance())
    columns = [moved_surfaces(problem, cascade.solve(surface.shell, 1.0, surface.side)) for surface in problem.surfaces]
    return np.stack([np.stack([column[i] for column in columns]) for i in range(len(columns))])


def moved_by_forces(
    problem: Problem,
    grid: LaplaceGrid,
    modes: Modes,
    pressure: ComplexArray,
    nodes: slice = slice(None),
    progress: Progress | None = None,
) -> SolidSpectra:
    """Return all that modal pressures on the surfaces move.

    Parameters
    ----------
    problem : Problem
        Its walls resolve the waves of the grid.
    grid : LaplaceGrid
    modes : Modes
    pressure : ndarray, shape (surfaces, parities, orders, nodes)
        Transforms, positive inward.
    nodes : slice
        Of the grid, at which they are given.
    progress : callable, optional
    """
    s = grid.nodes[nodes]
    found = nothing_moves(problem, pressure.shape[1], modes.count, s.size)
    acting = [(j, surface) for j, surface in enumerate(problem.surfaces) if pressure[j].any()]
    if not acting:
        return found
    make_shapes(problem, modes, s)

    def work(block: slice) -> None:
        system = FacedSystem(problem, s[block], modes)
        for parity in range(pressure.shape[1]):
            found.put(parity, block, system.under_forces([(surface, pressure[j, parity, :, block]) for j, surface in acting]))

    with one_blas_thread():
        blocks = [slice(0, s.size)] if s.size < grid.nodes.size else node_blocks(grid, modes.count)
        map_node_blocks(blocks, work, progress, "motion by forces")
    return found


def march_weights(problem: Problem, grid: LaplaceGrid, modes: Modes, progress: Progress | None = None) -> FloatArray:
    """Return the step weights of modal pressures in the velocities of the surfaces, shape (surfaces, surfaces, orders, T).

    The velocity of surface i at t_n is sum_k weights[i, j, :, k] p_j(t_(n - k)); ``grid`` is that of the march.
    """
    count = len(problem.surfaces)
    pairs = [(i, j) for i in range(count) for j in range(count)]
    found = combined_march_weights(problem, grid, modes, {pair: np.eye(modes.count) for pair in pairs}, progress)
    return np.stack([found[pair] for pair in pairs]).reshape(count, count, modes.count, -1)


def combined_march_weights(
    problem: Problem, grid: LaplaceGrid, modes: Modes, shares: Mapping[Pair, FloatArray], progress: Progress | None = None
) -> dict[Pair, FloatArray]:
    """Return step weights of :func:`march_weights` of some pairs of surfaces, combined over the orders before they are inverted.

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
    modes : Modes
    shares : dict of (int, int) to ndarray, shape (rows, orders)
        Of each pair.
    progress : callable, optional

    Returns
    -------
    dict of (int, int) to ndarray, shape (rows, T)
    """
    fine, s = trapezoidal_nodes(grid)
    problem = problem.resolving(band(fine))
    sums = ComplianceSums(problem, modes, shares, surface_compliance)
    sums.prepare(s)
    found = {pair: np.empty((len(rows), s.size), np.complex128) for pair, rows in shares.items()}

    def work(block: slice) -> None:
        for pair, values in sums.at(s[block]).items():
            found[pair][:, block] = values

    with one_blas_thread():
        map_node_blocks(node_blocks(fine, modes.count), work, progress, "frequencies")
    return {pair: step_weights(spectrum, fine, s, grid) for pair, spectrum in found.items()}


def trapezoidal_nodes(grid: LaplaceGrid) -> tuple[LaplaceGrid, ComplexArray]:
    """Return the grid at a third of the step of a march, and the s at which the trapezoidal rule has its nodes, shape (nodes,)."""
    fine = LaplaceGrid(grid.time_step / PARTS, grid.steps * PARTS)
    return fine, np.asarray((2.0 / fine.time_step) * np.tanh(0.5 * fine.time_step * fine.nodes), dtype=np.complex128)


def step_weights(compliance: ComplexArray, fine: LaplaceGrid, s: ComplexArray, grid: LaplaceGrid) -> FloatArray:
    """Return the step weights in velocities, shape (..., T), of displacements per force at the nodes of :func:`trapezoidal_nodes`."""
    return summed_weights(fine.invert(compliance * s, np.ones(s.size)) * fine.time_step, PARTS, grid.time.size)
