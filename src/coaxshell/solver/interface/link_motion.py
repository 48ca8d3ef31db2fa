"""How fast the absorbers of a finished run moved: the masses' velocities and the rates dD/dt of their links' stretches D = q - w.

A damper turns c (dD/dt)^2 into heat. Where it is stiff, dD/dt is a small difference of two large velocities: what is taken from the
motion of the two ends in different ways is the error of both, times c. It is therefore what the link's own law makes of its force,

    exact:     dD/dt = s F/(c s + k_l) at every Laplace node,
    marched:   f_n = c r_n + k_l D_n + k_nl D_n^3,   D_n = D_{n-1} + (r_{n-1} + r_n) dt/2,   the march's own trapezoidal rule.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface.absorbers import AbsorberSet, link_impedance
from coaxshell.solver.links.described import assembled
from coaxshell.solver.links.histories import LawHistories


@dataclass(frozen=True)
class LinkMotion:
    """Histories of every absorber of a description, dimensionless, at the times of a grid.

    Attributes
    ----------
    force : ndarray, shape (N, 2, T)
        Line forces on the inner [.., 0] and outer [.., 1] shell.
    displacement, velocity : ndarray, shape (N, T)
        q and dq/dt.
    stretch_rate : ndarray, shape (N, 2, T)
        dD/dt of the links that have a damper.
    laws : LawEnergy or None
        What all absorbers hold and lose, where the march or the laws of the links tell.
    """

    force: FloatArray
    displacement: FloatArray
    velocity: FloatArray
    stretch_rate: FloatArray
    laws: LawEnergy | None = None


class LawEnergy(NamedTuple):
    """Energy of all links of a description together, each of shape (T,): held by springs, turned into heat by dampers and by laws.

    ``held``, shape (N, 2), tells which links hold a wall.
    """

    stored: FloatArray
    damped: FloatArray
    lost: FloatArray
    held: FloatArray


def motion_of_laws(absorbers: AbsorberSet, laws: LawHistories, force: FloatArray, displacement: FloatArray) -> LinkMotion:
    """Return the motion that a march of links of any law found; ``force`` (N, 2, T) and q (N, T) of every absorber."""
    rates = np.zeros_like(force)
    return LinkMotion(force, displacement, laws.velocity[absorbers.member], rates, _of_all(absorbers, laws.stored, laws.damped, laws.lost))


def _of_all(absorbers: AbsorberSet, *histories: FloatArray) -> LawEnergy:
    """Return the sums over all links of the description of histories of those carried, (2N, T)."""
    many = np.tile(np.bincount(absorbers.member, minlength=absorbers.count), 2).astype(np.float64)
    stored, damped, lost = (many @ one for one in histories)
    return LawEnergy(stored, damped, lost, absorbers.held.T[absorbers.member])


def _energy_by_replay(absorbers: AbsorberSet, grid: LaplaceGrid, force: ComplexArray) -> LawEnergy:
    """Return the energy of linear links that differ, from the transforms of their forces (2N, nodes): D = F/z, followed step by step."""
    assert absorbers.elements is not None
    z = link_impedance(absorbers, grid.nodes).T
    stretch = grid.invert(np.divide(force, z, out=np.zeros_like(force), where=z != 0.0)).T
    step, present = grid.time_step, absorbers.elements.present
    laws = assembled(absorbers.elements.elements, step)
    state, stored, work = laws.at_rest(), np.zeros_like(stretch), np.zeros_like(stretch)
    for n in range(1, len(stretch)):
        work[n] = laws.force(stretch[n], state).value * (stretch[n] - stretch[n - 1])
        state = laws.advance(stretch[n], state)
        stored[n] = laws.stored(state)
    lost = np.cumsum(work, axis=0) - stored
    damping, stiffness = (np.tile(x, 2) * present for x in (absorbers.damping, absorbers.linear))
    damped = np.cumsum(damping * np.diff(stretch, axis=0, prepend=0.0) ** 2 / step, axis=0)
    return _of_all(absorbers, (stored + 0.5 * stiffness * stretch**2).T, damped.T, lost.T)


def exact_motion(absorbers: AbsorberSet, grid: LaplaceGrid, force: ComplexArray, displacement: ComplexArray) -> LinkMotion:
    """Return the motion from the transforms of the forces (2N, nodes) and of q (N, nodes) of the N absorbers carried."""
    law = link_impedance(absorbers, grid.nodes).T.reshape(2, absorbers.count, -1)
    sides = force.reshape(2, absorbers.count, -1)
    rate = np.divide(sides * grid.nodes, law, out=np.zeros_like(sides), where=law != 0.0)
    histories = (grid.invert(x)[..., absorbers.member, :] for x in (sides, displacement, displacement * grid.nodes, rate))
    f, q, velocity, stretch_rate = histories
    energy = None if absorbers.elements is None else _energy_by_replay(absorbers, grid, force)
    return LinkMotion(f.swapaxes(0, 1), q, velocity, stretch_rate.swapaxes(0, 1), energy)


def marched_motion(absorbers: AbsorberSet, time_step: float, force: FloatArray, displacement: FloatArray) -> LinkMotion:
    """Return the motion from the histories of the forces (N, 2, T) and of q (N, T) of every absorber of the description."""
    law = [x[absorbers.member, None] for x in (absorbers.damping, absorbers.linear, absorbers.cubic)]
    return motion_by_law((law[0], law[1], law[2]), time_step, force, displacement)


def motion_by_law(
    law: tuple[FloatArray, FloatArray, FloatArray], time_step: float, force: FloatArray, displacement: FloatArray
) -> LinkMotion:
    """Return the motion from histories as :func:`marched_motion`, by c, k_l and k_nl of each absorber, (N, 1)."""
    velocity, half = np.zeros_like(displacement), 0.5 * time_step
    slope = np.diff(displacement, axis=-1) / half
    for n in range(1, displacement.shape[-1]):
        velocity[:, n] = slope[:, n - 1] - velocity[:, n - 1]
    c, linear, cubic = law
    rates = np.zeros((force.shape[-1], *force.shape[:2]))
    if c.any():
        stretch = np.zeros(force.shape[:2])
        for n in range(1, len(rates)):
            predicted = stretch + half * rates[n - 1]
            rates[n] = _rate(force[..., n], predicted, (np.where(c > 0.0, c, 1.0), linear, cubic), half)
            stretch = predicted + half * rates[n]
        rates *= c > 0.0
    return LinkMotion(force, displacement, velocity, np.moveaxis(rates, 0, -1))


def _rate(force: FloatArray, predicted: FloatArray, law: tuple[FloatArray, FloatArray, FloatArray], half: float) -> FloatArray:
    """Return r of f = c r + k_l D + k_nl D^3, D = ahead + r dt/2.

    The cubic in D is monotone, its root the hyperbolic one; r follows by the secant of the springs, which does not cancel.
    """
    damping, linear, cubic = law
    tangent = linear + damping / half
    bend = np.sqrt(3.0 * cubic / tangent)
    target = (force + damping / half * predicted) / tangent
    curved = 2.0 * np.sinh(np.arcsinh(1.5 * bend * target) / 3.0)
    stretch = np.divide(curved, bend, out=target.copy(), where=np.broadcast_to(bend > 0.0, target.shape))
    secant = linear + cubic * (stretch**2 + stretch * predicted + predicted**2)
    rate: FloatArray = (force - (linear + cubic * predicted**2) * predicted) / (damping + half * secant)
    return rate
