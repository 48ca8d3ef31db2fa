"""What links of any law did in a march."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface.absorbers import AbsorberSet


@dataclass(frozen=True)
class LawHistories:
    """Histories of the links of the N absorbers carried, dimensionless; all (2N, T) unless told otherwise.

    Attributes
    ----------
    force : ndarray
        Over the step that ends at each instant: of its middle.
    stretch : ndarray
        D at the instants.
    velocity : ndarray, shape (N, T)
        Of the masses, at the instants.
    stored : ndarray
        What all springs of each link hold at the instants, inertance included.
    damped, lost : ndarray
        What dampers, and what laws (friction, stops, viscoelastic branches), turned into heat up to the instants.
    linear : AbsorberSet
        Springs and dampers that fit the laws best in this motion, for the estimates of errors.
    angle : float
        The largest angle by which anything swings on a law within a step (radians).
    """

    force: FloatArray
    stretch: FloatArray
    velocity: FloatArray
    stored: FloatArray
    damped: FloatArray
    lost: FloatArray
    linear: AbsorberSet
    angle: float


def middles_transform(grid: LaplaceGrid, histories: FloatArray) -> ComplexArray:
    """Return the transforms of functions linear between the middles of the steps; the value at n is that of the step before instant n."""
    return grid.transform_linear(histories) * np.exp(0.5 * grid.time_step * grid.nodes)


def at_instants(middles: FloatArray) -> FloatArray:
    """Return values at the instants, of second order, from those of the middles of the steps before them, the last axis."""
    later = np.concatenate([middles[..., 1:], 2.0 * middles[..., -1:] - middles[..., -2:-1]], axis=-1)
    found = np.asarray(0.5 * (middles + later))
    found[..., 0] = 0.0
    return found


def best_springs(absorbers: AbsorberSet, middle: FloatArray, rate: FloatArray, force: FloatArray) -> AbsorberSet:
    """Return absorbers with springs and dampers in place of laws: k = <f D>/<D^2> and c = <f r>/<r^2>, neither below 0.

    Parameters
    ----------
    absorbers : AbsorberSet
    middle, rate, force : ndarray, shape (2N, T)
        D and dD/dt of the links in the middles of the steps, and the force of all their laws.
    """
    assert absorbers.elements is not None

    def fitted(x: FloatArray) -> FloatArray:
        square = (x * x).sum(axis=-1)
        share = np.divide((force * x).sum(axis=-1), square, out=np.zeros_like(square), where=square > 0.0)
        return np.asarray(np.maximum(share, 0.0))

    elements = absorbers.elements.with_springs(fitted(middle), fitted(rate), np.tile(absorbers.cubic, 2) != 0.0)
    return replace(absorbers, cubic=np.zeros_like(absorbers.cubic), elements=elements)
