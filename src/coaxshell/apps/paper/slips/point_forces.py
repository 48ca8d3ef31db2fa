"""Slips of the absorbers' forces on the modes (Eq. 19) and of the series they are expanded in (Fig. 8)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.point_forces import PlacedForces
from coaxshell.solver.scaling import Problem


def missing_projection(problem: Problem) -> Problem:
    """Return the problem without 1/(beta pi): every absorber pulls pi times (order 0: 2 pi times) as hard as its own mass feels."""

    def shares(absorbers: PlacedForces, modes: Modes) -> FloatArray:
        beta_pi = np.pi * np.where(modes.orders == 0, 2.0, 1.0)
        found: FloatArray = problem.point_force_shares(absorbers, modes) * beta_pi
        return found

    return replace(problem, point_force_shares=shares)


def outside_sum(problem: Problem, which: int) -> Problem:
    """Return the problem with cos(m theta_n) outside the sum over n, n being one absorber's number for all: 0 the first, -1 the last.

    Forces are still read where each absorber sits, but all of them act where that one does. In a layout that is symmetric about the
    axis, whose series has cosines only, this is half there and half at its mirror image.
    """

    def shares(absorbers: PlacedForces, modes: Modes) -> FloatArray:
        own = absorbers.shapes(modes)
        assert isinstance(absorbers, AbsorberSet)
        angle = float(absorbers.every_angle[which])
        there = np.stack([modes.projection(angle, parity)[:, 0] for parity in range(absorbers.parities)])
        beta_pi = np.pi * np.where(modes.orders == 0, 2.0, 1.0)
        found: FloatArray = np.broadcast_to(there[:, None, :], own.shape) * absorbers.multiplicity[:, None] / beta_pi
        return found

    return replace(problem, point_force_shares=shares)


def cosine_only(problem: Problem) -> Problem:
    """Return the problem with cosines only: an absorber off the axis acts as two of half its strength at +theta_n and -theta_n."""

    def shares(absorbers: PlacedForces, modes: Modes) -> FloatArray:
        found = problem.point_force_shares(absorbers, modes).copy()
        found[1:] = 0.0
        return found

    return replace(problem, point_force_shares=shares)
