"""What waves above the highest order and axial wavenumber would add, from a sample (:mod:`coaxshell.solver.axial.samples`).

Voltages of electrodes that are cut along the axis excite these waves too. Absorbers add two things: their forces excite them, and feel
walls that are softer by them (:mod:`coaxshell.solver.axial.softened`).

Norms along the contour weigh early times. How long a motion goes on is known at the stations, order by order; what is left out goes on
as the highest orders kept do (:mod:`coaxshell.solver.orders_left_out`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.belts import driven_sets
from coaxshell.solver.axial.families import Family, WaveSet, wave_sets
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.samples import samples_of, spherical_samples, untied
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.softened import Softened
from coaxshell.solver.axial.solution import StationSpectra
from coaxshell.solver.axial.sums import amplitudes_of
from coaxshell.solver.estimates import ORDERS_FACTOR, STEP_FACTOR
from coaxshell.solver.orders_left_out import of_the_truth, persistence, relative, surface_norms
from coaxshell.solver.sampled_orders import NODES
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import Estimates
from coaxshell.solver.step_error import band_limit


class LeftOut(NamedTuple):
    """Squares of what is left out, of displacement and strain of each shell, shape (shells, 2): by orders and by axial wavenumbers."""

    orders: FloatArray
    axial: FloatArray


def left_out(problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, forces: WallForces | None = None) -> LeftOut:
    """Return the squares of what is left out under sources and forces of absorbers at the sampled nodes, summed over these."""
    s, count = grid.nodes[NODES], len(problem.shells)
    found = LeftOut(np.zeros((count, 2)), np.zeros((count, 2)))
    for waves in wave_sets(problem, sampling, np.zeros(1), s, forces):
        for sample in samples_of(problem, sampling, waves):
            for family in waves.families:
                squares = squares_of(problem, grid, sample.modes, family) * (float(family.mean[-1]) * sample.weight)
                found.orders[...] += squares @ sample.higher_order
                found.axial[...] += squares @ ~sample.higher_order
    for waves in [] if problem.belts is None else driven_sets(problem, sampling, np.zeros(1), grid, NODES):
        assert waves.belts is not None
        for sample in spherical_samples(sampling):
            squares = waves.belts.squares_beyond(sample.modes) * (0.5 * sample.weight)
            found.orders[...] += squares @ sample.higher_order
            found.axial[...] += squares @ ~sample.higher_order
    return found


def squares_of(problem: Problem, grid: LaplaceGrid, modes: Modes, family: Family) -> FloatArray:
    """Return |W|^2 and the strains' squares at the sampled nodes added up, shape (shells, 2, orders)."""
    w, v, u = amplitudes_of(untied(problem), WaveSet([modes], [family]), 0, grid, NODES)[0][:3]
    m, k = modes.orders[:, None], np.asarray(modes.wavenumber)
    strain = np.abs(m * v - w) ** 2 + np.abs(k * u) ** 2
    return np.stack([(np.abs(w) ** 2).sum(axis=(1, 3)), strain.sum(axis=(1, 3))], axis=1)


def estimated_errors(
    problem: Problem,
    grid: LaplaceGrid,
    sampling: AxialSampling,
    squares: FloatArray,
    motion: StationSpectra,
    histories: tuple[FloatArray, FloatArray],
    soft: Softened | None = None,
    forces: WallForces | None = None,
    force_error: float = 0.0,
) -> Estimates:
    """Return the printed errors of a three-dimensional run.

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
    sampling : AxialSampling
    squares : ndarray, shape (2, shells, 2, M + 1)
        Mean squares along the axis of all that was added up, all nodes together, under sources and under forces.
    motion : StationSpectra
    histories : pair of ndarray, shape (stations, shells, parities, M + 1, T)
        W and V at the stations.
    soft : Softened, optional
        What point absorbers do with the waves left out.
    forces : WallForces, optional
        Of line absorbers, at all nodes.
    force_error : float
        The relative error of their forces by the steps of the march.
    """
    spectra = motion.normal, motion.tangential
    stations = range(histories[0].shape[0])
    each = [surface_norms(histories[0][i], histories[1][i]) for i in stations]
    whole = np.sum(each, axis=0)
    along = np.sum([surface_norms(spectra[0][i][..., NODES], spectra[1][i][..., NODES]) for i in stations], axis=0)
    lasting = persistence(grid, whole, along)
    high = slice(-max(1, whole.shape[-1] // 3), None)
    beyond = persistence(grid, whole[..., high].sum(axis=-1), along[..., high].sum(axis=-1))
    circle = np.where(np.arange(squares.shape[-1]) == 0, 1.0, 0.5)
    by_sources, by_forces = (squares * lasting * circle).sum(axis=-1) / NODES.step
    total = by_sources + by_forces
    acting = soft.forces if soft is not None else None if forces is None else forces.at(NODES)
    missing = left_out(problem, grid, sampling, acting)
    if soft is None:
        orders, axial = (ORDERS_FACTOR * relative(part * beyond, total + part * beyond) for part in missing)
    else:
        changed = (soft.changed * lasting * circle).sum(axis=-1)
        orders, axial = (ORDERS_FACTOR * of_the_truth(part * beyond, change, total) for part, change in zip(missing, changed, strict=True))
    steps = [band_limit(grid, spectra[0][i], spectra[1][i], each[i]) for i in stations]
    return Estimates(orders, STEP_FACTOR * np.max(steps, axis=0), force_error * relative(by_forces, total), axial)
