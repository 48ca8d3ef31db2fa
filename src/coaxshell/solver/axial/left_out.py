"""What waves above the highest order and the highest axial wavenumber would add, from a sample of them.

Kept is what lies within (m/M)^2 + (k/k_max)^2 <= 1. Beyond, the sources are solved at a sample of m and k out to four times M and k_max.
What lies nearer to the axis of orders, m/M >= k/k_max, counts as orders left out, the rest as axial wavenumbers left out.

Norms along the contour weigh early times. How long a motion goes on is known at the stations, order by order; what is left out goes on
as the highest orders kept do (:mod:`coaxshell.solver.orders_left_out`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.families import Family, WaveSet, wave_sets
from coaxshell.solver.axial.point_forces import PointForces
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.solution import StationSpectra
from coaxshell.solver.axial.sums import amplitudes_of
from coaxshell.solver.estimates import ORDERS_FACTOR, STEP_FACTOR
from coaxshell.solver.orders_left_out import persistence, relative, surface_norms
from coaxshell.solver.sampled_orders import NODES, orders_above, standing_for
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import Estimates
from coaxshell.solver.step_error import band_limit

_FARTHEST = 4.0
_WAVENUMBERS, _ORDERS = 12, 12
"""Sampled beyond k_max, and above the kept orders of each wavenumber."""


class LeftOut(NamedTuple):
    """Squares of what is left out, of displacement and strain of each shell, shape (shells, 2): by orders and by axial wavenumbers."""

    orders: FloatArray
    axial: FloatArray


@dataclass(frozen=True)
class _Sample:
    """Orders at one wavenumber beyond those kept.

    Attributes
    ----------
    modes : Modes
    weight : ndarray, shape (orders,)
        How many waves each stands for, times the mean square of its cosine on the circle.
    higher_order : ndarray of bool, shape (orders,)
        Which count as orders left out.
    """

    modes: Modes
    weight: FloatArray
    higher_order: np.ndarray[tuple[int], np.dtype[np.bool_]]


def _sample(orders: FloatArray, wavenumber: float | ComplexArray, stands_for: float, higher_order: FloatArray | bool) -> _Sample:
    weight = standing_for(orders) * np.where(orders == 0, 1.0, 0.5) * stands_for
    return _Sample(Modes(orders, wavenumber), weight, np.broadcast_to(higher_order, orders.shape))


def _spherical_samples(sampling: AxialSampling) -> list[_Sample]:
    """Return samples of what lies beyond the kept waves of spherical sources."""
    top, highest = float(sampling.max_order), sampling.highest
    inside = np.linspace(0.0, 1.0, 5)[:-1] * highest
    k = np.concatenate([inside, np.geomspace(highest, _FARTHEST * highest, _WAVENUMBERS)])
    gaps = np.diff(k)
    waves = 0.5 * (np.append(gaps, 0.0) + np.insert(gaps, 0, 0.0)) / sampling.spacing
    samples = []
    for each, stands_for in zip(k, waves, strict=True):
        share = (each / highest) ** 2
        first = float(np.floor(top * np.sqrt(1.0 - share))) + 1.0 if share < 1.0 else 0.0
        orders = np.unique((np.geomspace(first + 1.0, _FARTHEST * top + 1.0, _ORDERS) - 1.0).round())
        samples.append(_sample(orders, float(each), float(stands_for), orders / top >= each / highest))
    return samples


def left_out(problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, forces: PointForces | None = None) -> LeftOut:
    """Return the squares of what is left out under sources and forces of point absorbers, summed over the sampled nodes."""
    s, count = grid.nodes[NODES], len(problem.shells)
    found = LeftOut(np.zeros((count, 2)), np.zeros((count, 2)))
    for waves in wave_sets(problem, sampling, np.zeros(1), s, None if forces is None else forces.at(NODES)):
        if waves.modes is sampling.modes:
            samples = _spherical_samples(sampling)
        else:
            samples = [_sample(orders_above(problem, sampling.max_order + 1), waves.modes[0].wavenumber, 1.0, True)]
        for sample in samples:
            for family in waves.families:
                squares = squares_of(problem, grid, sample.modes, family) * (float(family.mean[-1]) * sample.weight)
                found.orders[...] += squares @ sample.higher_order
                found.axial[...] += squares @ ~sample.higher_order
    return found


def squares_of(problem: Problem, grid: LaplaceGrid, modes: Modes, family: Family) -> FloatArray:
    """Return |W|^2 and the strains' squares at the sampled nodes added up, shape (shells, 2, orders)."""
    w, v, u = amplitudes_of(problem, WaveSet([modes], [family]), 0, grid, NODES)[0][:3]
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
    forces: PointForces | None = None,
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
    forces : PointForces, optional
        Of point absorbers.
    force_error : float
        Their relative error by the steps of the march.
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
    missing = left_out(problem, grid, sampling, forces)
    orders, axial = (ORDERS_FACTOR * relative(part * beyond, total + part * beyond) for part in missing)
    steps = [band_limit(grid, spectra[0][i], spectra[1][i], each[i]) for i in stations]
    return Estimates(orders, STEP_FACTOR * np.max(steps, axis=0), force_error * relative(by_forces, total), axial)
