"""Radial operators of the three kinds of fluid region: pressure per unit normal acceleration of its walls.

Every operator depends on the radial wavenumber kappa alone. For the plane problem kappa = alpha s, alpha = c_e/c; a field
with axial wavenumber k_z would use kappa^2 = alpha^2 s^2 + k_z^2 and nothing here would change.

Kinematics on a wall moving with displacement w, positive inward (theory manual, section "Fluids"):

    dp/dr = (rho/rho_e) s^2 w.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.radial_functions import RadialFunctions, i_across, k_across


def all_orders(max_order: int) -> FloatArray:
    """Return 0, 1, ..., max_order."""
    return np.arange(max_order + 1, dtype=np.float64)


class AnnulusOperator(NamedTuple):
    """Wall pressures of an annulus per unit acceleration of its inner (a) and outer (b) wall: p_a = aa w_a'' + ab w_b'', etc."""

    aa: ComplexArray
    ab: ComplexArray
    ba: ComplexArray
    bb: ComplexArray


class AnnulusAmplitudes(NamedTuple):
    """The bounded factors from which both the wall operator and the field inside the annulus are built."""

    epsilon_i: ComplexArray
    epsilon_k: ComplexArray
    determinant: ComplexArray


def annulus_amplitudes(inner: RadialFunctions, outer: RadialFunctions) -> AnnulusAmplitudes:
    """Return eps_I = I'(k ra)/I'(k rb), eps_K = K'(k rb)/K'(k ra) and 1 - eps_I eps_K.

    All three stay bounded at every order and argument. With the field written
    p = A I_m(kr)/(k I_m'(k rb)) + B K_m(kr)/(k K_m'(k ra)) the walls' accelerations g_a, g_b give
    A = (g_b - eps_K g_a)/(1 - eps_I eps_K), B = (g_a - eps_I g_b)/(1 - eps_I eps_K).
    """
    # I'(ka)/I'(kb) = [I(ka)/I(kb)] * [I'(ka)/I(ka)] / [I'(kb)/I(kb)], and disc = I/(k I').
    epsilon_i = i_across(inner, outer) * outer.disc / inner.disc
    epsilon_k = k_across(inner, outer) * inner.exterior / outer.exterior
    return AnnulusAmplitudes(epsilon_i, epsilon_k, 1.0 - epsilon_i * epsilon_k)


def annulus(inner: RadialFunctions, outer: RadialFunctions) -> AnnulusOperator:
    """Return the wall operator of the annulus between two radii.

    Reciprocity, r_a * ab = -r_b * ba, follows from the Wronskian and is kept to rounding.
    """
    eps_i, eps_k, determinant = annulus_amplitudes(inner, outer)
    both = eps_i * eps_k
    return AnnulusOperator(
        aa=(inner.exterior - both * inner.disc) / determinant,
        ab=eps_i * (inner.disc - inner.exterior) / determinant,
        ba=eps_k * (outer.exterior - outer.disc) / determinant,
        bb=(outer.disc - both * outer.exterior) / determinant,
    )
