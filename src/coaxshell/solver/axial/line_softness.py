"""What line absorbers would do otherwise, were the orders there that a three-dimensional run leaves out.

Wavenumbers along the axis do not feel each other where springs are linear, so that at each of them everything is as in two dimensions
(:mod:`coaxshell.solver.orders_left_out`): absorbers feel walls that are softer by the orders left out, and that move by what these do
under the sources. Cubic springs count with their mean tangent. What they would do above the highest wavenumber is not known here.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.families import WaveSet, wave_sets
from coaxshell.solver.axial.line_solve import LineSolution
from coaxshell.solver.axial.line_structure import families_at
from coaxshell.solver.axial.lines import LineLayout
from coaxshell.solver.axial.samples import sample_beside, untied
from coaxshell.solver.axial.softened import Softened, in_the_waves_kept
from coaxshell.solver.axial.surfaces import SurfaceWave
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.orders_left_out import COUPLED_POINTS, against
from coaxshell.solver.sampled_orders import NODES, each_alone, mobility_at
from coaxshell.solver.scaling import Problem


def softened_lines(problem: Problem, grid: LaplaceGrid, linked: LineSolution) -> Softened:
    """Return what the line absorbers of a run do once the walls are as soft as the orders left out make them.

    "Axial wavenumbers left out" are those of these orders that are nearer to that axis (:mod:`coaxshell.solver.axial.samples`).
    """
    layout, known = linked.forces.layout, linked.forces.at(NODES)
    sets = wave_sets(problem, layout.sampling, np.array([layout.origin]), grid.nodes[NODES])
    changed = np.stack([_changed(layout, linked.tangent, grid, sets, j, force) for j, force in enumerate(known.force)], axis=1)
    forces = [replace(known, force=change) for change in changed]
    whole = replace(known, force=known.force + changed.sum(axis=0))
    return Softened(whole, np.stack([in_the_waves_kept(problem, grid, layout.sampling, one) for one in forces]))


def _changed(layout: LineLayout, links: AbsorberSet, grid: LaplaceGrid, sets: list[WaveSet], j: int, force: ComplexArray) -> ComplexArray:
    """Return df at a wavenumber by the orders that count as orders left out [0] and as axial wavenumbers left out [1].

    Shape (2, 2N, axial parities, nodes); ``force`` are those of the run at the sampled nodes, (2N, axial parities, nodes).
    """
    problem, s, sample = layout.problem, grid.nodes[NODES], sample_beside(layout.problem, layout.sampling, j)
    kept = Modes(layout.sampling.modes[j].orders, layout.sampling.modes[j].wavenumber)  # which keep no shapes of solids
    compliance, beside = SurfaceWave(untied(problem), s, kept).compliance, SurfaceWave(untied(problem), s, sample.modes)
    softer = beside.compliance
    squares = np.zeros((len(problem.surfaces), layout.axial_parities, sample.modes.count, s.size))
    for family, share in families_at(layout, sets, j):
        normal = np.asarray(beside.under(family, grid, NODES))
        each = (layout.squares[j] * np.array(share[: layout.axial_parities])) ** 2
        squares += np.multiply.outer(each, (np.abs(normal) ** 2).sum(axis=0)).swapaxes(0, 1)
    means, sides = links.means(problem, sample.modes) * links.held[:, :, None], links.surfaces
    phase = np.exp(2j * np.pi * np.random.default_rng(j).random(force.shape)).reshape(2, links.count, *force.shape[1:])
    acting = force.reshape(phase.shape)
    found = np.empty((2, *phase.shape), np.complex128)
    for cause, mask in enumerate((sample.higher_order, ~sample.higher_order)):
        soft = mobility_at(problem, links, sample.modes, softer, mask * sample.waves * _half_of_0(sample.modes))
        moved = np.einsum("abnk,bnpk->anpk", soft, acting)
        moved += phase * np.sqrt(np.einsum("anpmk,anm->anpk", squares[sides], means**2 * (mask * sample.weight)))
        for along in range(layout.axial_parities):
            found[cause, :, :, along] = _against(layout, links, compliance, s, moved[:, :, along], soft)
    return found.reshape(2, *force.shape)


def _against(
    layout: LineLayout, links: AbsorberSet, compliance: ComplexArray, s: ComplexArray, moved: ComplexArray, soft: ComplexArray
) -> ComplexArray:
    """Return the change (2, N, nodes) of the forces on walls that move by so much more and are so much softer."""
    if 2 * links.count > COUPLED_POINTS:
        modes = Modes.up_to(compliance.shape[2] - 1)
        return each_alone(links, s, mobility_at(layout.problem, links, modes, compliance, _half_of_0(modes)) + soft, moved)
    return against(layout.points, links, layout.folded(compliance), s, moved, soft)


def _half_of_0(modes: Modes) -> FloatArray:
    return np.where(modes.orders == 0, 0.5, 1.0)
