"""A sample of the waves that a three-dimensional run leaves out: beyond (m/M)^2 + (k/k_max)^2 = 1, out to four times M and k_max.

What lies nearer to the axis of orders, m/M >= k/k_max, counts as orders left out, the rest as axial wavenumbers left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.families import WaveSet
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.sampled_orders import orders_above, standing_for
from coaxshell.solver.scaling import Problem

_FARTHEST = 4.0
_WAVENUMBERS, _ORDERS = 12, 12
"""Sampled beyond k_max, and above the kept orders of each wavenumber."""


def untied(problem: Problem) -> Problem:
    """Return a problem as it answers in samples: without feedback that ties orders to each other, of which a sample has not all."""
    return problem.open_loop if problem.tied else problem


@dataclass(frozen=True)
class Sample:
    """Orders at one wavenumber beyond those kept.

    Attributes
    ----------
    modes : Modes
    waves : ndarray, shape (orders,)
        How many waves each stands for.
    higher_order : ndarray of bool, shape (orders,)
        Which count as orders left out.
    """

    modes: Modes
    waves: FloatArray
    higher_order: np.ndarray[tuple[int], np.dtype[np.bool_]]

    @property
    def weight(self) -> FloatArray:
        """How many waves each stands for, times the mean square of its cosine on the circle, shape (orders,)."""
        return np.asarray(self.waves * np.where(self.modes.orders == 0, 1.0, 0.5))


def _sample(orders: FloatArray, wavenumber: float | ComplexArray, stands_for: float, higher_order: FloatArray | bool) -> Sample:
    return Sample(Modes(orders, wavenumber), standing_for(orders) * stands_for, np.broadcast_to(higher_order, orders.shape))


def samples_of(problem: Problem, sampling: AxialSampling, waves: WaveSet) -> list[Sample]:
    """Return samples of what lies beyond the waves kept of a set: of all wavenumbers, or of the one of uniform or inclined sources."""
    if waves.modes is sampling.modes and len(waves.modes) > 1:
        return spherical_samples(sampling)
    return [_sample(orders_above(problem, sampling.max_order + 1), waves.modes[0].wavenumber, 1.0, True)]


def sample_beside(problem: Problem, sampling: AxialSampling, wave: int) -> Sample:
    """Return a sample of the orders left out at a wavenumber of the run, by its number."""
    modes = sampling.modes[wave]
    if len(sampling.modes) == 1:
        return _sample(orders_above(problem, sampling.max_order + 1), modes.wavenumber, 1.0, True)
    orders = _orders_beyond(sampling, modes.max_order + 1.0)
    return _sample(orders, modes.wavenumber, 1.0, orders / sampling.max_order >= sampling.wavenumbers[wave] / sampling.highest)


def _orders_beyond(sampling: AxialSampling, first: float) -> FloatArray:
    """Return some orders from the first one left out to four times M."""
    return np.unique((np.geomspace(first + 1.0, _FARTHEST * sampling.max_order + 1.0, _ORDERS) - 1.0).round())


def spherical_samples(sampling: AxialSampling) -> list[Sample]:
    """Return samples of what lies beyond the kept waves of spherical sources and of forces at points."""
    top, highest = float(sampling.max_order), sampling.highest
    inside = np.linspace(0.0, 1.0, 5)[:-1] * highest
    k = np.concatenate([inside, np.geomspace(highest, _FARTHEST * highest, _WAVENUMBERS)])
    gaps = np.diff(k)
    waves = 0.5 * (np.append(gaps, 0.0) + np.insert(gaps, 0, 0.0)) / sampling.spacing
    samples = []
    for each, stands_for in zip(k, waves, strict=True):
        share = (each / highest) ** 2
        first = float(np.floor(top * np.sqrt(1.0 - share))) + 1.0 if share < 1.0 else 0.0
        orders = _orders_beyond(sampling, first)
        samples.append(_sample(orders, float(each), float(stands_for), orders / top >= each / highest))
    return samples
