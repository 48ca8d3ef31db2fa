"""What point absorbers would do otherwise, were the waves there that a three-dimensional run leaves out.

As in two dimensions (:mod:`coaxshell.solver.orders_left_out`) absorbers feel walls that are softer than those of the run, by the receptance
dG of the waves left out, and that move by dw more: with f = -Y w and w = w_linear + G f in the run,

    (1 + (G + dG) Y) dw_all = dw + dG f,      df = -Y dw_all,

and df moves the waves kept. A point feels its own absorber's waves left out alone, on both walls; between absorbers they cancel. dw is
known by its mean square, and its phase is drawn. Cubic springs count with their mean tangent.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.axial.families import WaveSet, wave_sets
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.linked import PointSolution, PointStructure
from coaxshell.solver.axial.point_forces import PointForces
from coaxshell.solver.axial.points import PointLayout
from coaxshell.solver.axial.samples import Sample, samples_of, spherical_samples, untied
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.sums import amplitudes_of, mean_squares
from coaxshell.solver.axial.surfaces import SurfaceWave
from coaxshell.solver.interface.absorbers import AbsorberSet, point_law
from coaxshell.solver.orders_left_out import mean_tangent
from coaxshell.solver.sampled_orders import NODES
from coaxshell.solver.scaling import Problem


class Softened(NamedTuple):
    """What absorbers do at the sampled nodes with the waves left out.

    Attributes
    ----------
    forces : WallForces
        With what all of these change.
    changed : ndarray, shape (2, shells, 2, M + 1)
        Mean squares along the axis of W and of the strains, parities and nodes added up, of what orders left out [0] and axial wavenumbers
        left out [1] change in the waves kept.
    """

    forces: WallForces
    changed: FloatArray


def softened(problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, linked: PointSolution) -> Softened:
    """Return what the point absorbers of a run do once the walls are as soft as the waves left out make them."""
    structure, layout = linked.structure, linked.structure.layout
    links = _tangent(structure, linked)
    soft, moved = softness(problem, grid, sampling, layout), _moved_by_sources(problem, grid, sampling, layout)
    each = [_forces_changed(structure, links, linked.carried[:, NODES], soft[c], moved[c]) for c in (0, 1)]
    forces = [PointForces(layout.points, layout.of_every(change), layout.parities) for change in each]
    known = linked.forces.at(NODES)
    whole = PointForces(known.points, known.force + forces[0].force + forces[1].force, known.parities)
    return Softened(whole, np.stack([in_the_waves_kept(problem, grid, sampling, one) for one in forces]))


def softness(problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, layout: PointLayout) -> ComplexArray:
    """Return dG, w of side a of an absorber per force at its side b, by the orders left out [0] and the axial wavenumbers [1].

    Shape (2, N, 2, 2, sampled nodes), of the absorbers carried.
    """
    s, points, count = grid.nodes[NODES], layout.carried, layout.absorbers.count
    found = np.zeros((2, count, 2, 2, s.size), np.complex128)
    for sample in spherical_samples(sampling):
        system, felt = SurfaceWave(untied(problem), s, sample.modes), _felt(problem, layout, sample)
        for surface in np.unique(points.surface):
            answers = system.under_pressure(int(surface))
            share = sample.waves / (np.pi * problem.surfaces[surface].radius * np.where(sample.modes.orders == 0, 2.0, 1.0))
            share *= 2.0 / sampling.period
            for pressed in np.flatnonzero(points.surface == surface):
                b, n = divmod(int(pressed), count)
                for a in (0, 1):
                    here = a * count + n
                    weight = felt[here] * felt[pressed] * share
                    for cause, mask in enumerate((sample.higher_order, ~sample.higher_order)):
                        found[cause, n, a, b] += (weight * mask) @ answers[points.surface[here]]
    return found


def _moved_by_sources(problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, layout: PointLayout) -> FloatArray:
    """Return |dw|^2 of every point carried under the sources, by orders left out [0] and axial wavenumbers [1]: (2, points, nodes)."""
    s, points = grid.nodes[NODES], layout.carried
    found = np.zeros((2, points.count, s.size))
    for waves in wave_sets(problem, sampling, np.zeros(1), s):
        for sample in samples_of(problem, sampling, waves):
            system, felt = SurfaceWave(untied(problem), s, sample.modes), _felt(problem, layout, sample)
            for family in waves.families:
                normal = np.asarray(system.under(family, grid, NODES))
                squares = (np.abs(normal) ** 2).sum(axis=0)[points.surface] * (felt**2 * sample.weight * float(family.mean[-1]))[..., None]
                for cause, mask in enumerate((sample.higher_order, ~sample.higher_order)):
                    found[cause] += squares[:, mask].sum(axis=1)
    return found


def _felt(problem: Problem, layout: PointLayout, sample: Sample) -> FloatArray:
    """Return h_m h_k of every point carried, shape (points, orders)."""
    points, k = layout.carried, float(np.max(np.abs(sample.modes.wavenumber)))
    return points.means(problem, sample.modes) * points.along(k)[:, None]


def _tangent(structure: PointStructure, linked: PointSolution) -> AbsorberSet:
    """Return the absorbers carried, cubic springs by their mean tangent."""
    links = structure.layout.absorbers
    if linked.laws is not None:
        fitted: AbsorberSet = linked.laws.linear
        return fitted
    if links.is_linear:
        return links
    moved = structure.motion + np.einsum("abk,bk->ak", structure.receptance, linked.carried)
    first = np.array([members[0] for members in structure.layout.images])
    walls = structure.grid.invert(moved).reshape(2, links.count, -1)
    return mean_tangent(links, linked.displacement[first] - walls)


def _forces_changed(
    structure: PointStructure, links: AbsorberSet, force: ComplexArray, soft: ComplexArray, squares: FloatArray
) -> ComplexArray:
    """Return df at the sampled nodes, shape (2N, nodes), from the run's own forces, dG (N, 2, 2, nodes) and |dw|^2 (2N, nodes)."""
    count, index = links.count, np.arange(links.count)
    receptance = np.ascontiguousarray(np.moveaxis(structure.receptance[..., NODES], -1, 0))
    phase = np.exp(2j * np.pi * np.random.default_rng(0).random(squares.shape))
    moved = phase * np.sqrt(squares)
    for a in (0, 1):
        for b in (0, 1):
            receptance[:, a * count + index, b * count + index] += soft[:, a, b].T
            moved[a * count : (a + 1) * count] += soft[:, a, b] * force[b * count : (b + 1) * count]
    law = point_law(links, structure.grid.nodes[NODES])
    walls = np.linalg.solve(np.eye(2 * count) + receptance @ law, moved.T[:, :, None])
    return np.asarray(-(law @ walls)[:, :, 0].T)


def in_the_waves_kept(problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, forces: WallForces) -> FloatArray:
    """Return the mean squares along the axis of W and of the strains of what forces at the sampled nodes move, (shells, 2, M + 1)."""
    found = np.zeros((len(problem.shells), 2, sampling.max_order + 1))
    kept = wave_sets(problem, sampling, np.zeros(1), grid.nodes[NODES], forces)[-1]
    waves = WaveSet(kept.modes, [family for family in kept.families if family.forces is not None])
    for j, modes in enumerate(waves.modes):
        for family, moved in zip(waves.families, amplitudes_of(problem, waves, j, grid, NODES), strict=True):
            squares = mean_squares(family.mean[j : j + 1], waves.wavenumber[j : j + 1], *moved[:3, None])
            found[:, :, : modes.count] += squares
    return found
