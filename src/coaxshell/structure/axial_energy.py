"""Energies of a wall that changes along its axis, of one wavenumber."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.axial import layer_stiffness, open_circuit_stiffness, strain
from coaxshell.structure.section import Section
from coaxshell.structure.shell_model import WallEnergy, WallMotion, square


def axial_energy(section: Section, motion: WallMotion) -> WallEnergy:
    """Return the energies of a motion at one wavenumber, sums over the orders with weights (R/2) beta pi.

    Kinetic I (dU/dt^2 + dV/dt^2 + dW/dt^2), strain (U, V, W) K (U, V, W) with the layers' own stiffness, piezoelectric the same with
    the open-circuit stiffening. Along the axis they go with cos^2 kz and sin^2 kz, whose integrals over a period L are both L/2: a
    field (2/L) (F_0 + 2 sum_j F_j cos k_j z) holds (4/L) (E_0 + 2 sum_j E_j).
    """
    assert motion.u_rate is not None
    weight, modes = _weight(section, motion), Modes(motion.orders, motion.wavenumber)
    at = strain(modes, section.radius)
    kinetic = sum(square(weight, rate, rate) for rate in (motion.u_rate, motion.v_rate, motion.w_rate))
    return WallEnergy(
        kinetic=np.asarray(section.mass * kinetic),
        strain=axial_strain_energy(section, motion),
        piezoelectric=energy_of_stiffness(weight, open_circuit_stiffness(section, modes, at), motion),
    )


def axial_strain_energy(section: Section, motion: WallMotion) -> FloatArray:
    """Return what the layers hold by their own stiffness, shape (T,)."""
    at = strain(Modes(motion.orders, motion.wavenumber), section.radius)
    return energy_of_stiffness(_weight(section, motion), layer_stiffness(section, at), motion)


def _weight(section: Section, motion: WallMotion) -> FloatArray:
    return 0.5 * section.radius * motion.circle


def energy_of_stiffness(weight: FloatArray, stiffness: FloatArray, motion: WallMotion) -> FloatArray:
    """Return the sum over the orders of (U, V, W) K (U, V, W) with some weights, K of shape (3, 3, orders): (T,)."""
    assert motion.u is not None
    displacements = motion.u, motion.v, motion.w
    diagonal = sum(square(weight * stiffness[a, a], x, x) for a, x in enumerate(displacements))
    mixed = sum(square(weight * stiffness[a, b], displacements[a], displacements[b]) for a, b in ((0, 1), (0, 2), (1, 2)))
    return np.asarray(diagonal + 2.0 * mixed)
