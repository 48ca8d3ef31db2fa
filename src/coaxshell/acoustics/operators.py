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

    With D = kr I'(kr)/I(kr) and E = kr K'(kr)/K(kr) at both, X = I(k ra)/I(k rb) and Y = K(k rb)/K(k ra),

        aa = ra (D_b - X Y E_b)/N,    ab = rb X (E_a - D_a)/N,    ba = ra Y (D_b - E_b)/N,    bb = rb (E_a - X Y D_a)/N,

    N = D_b E_a - X Y D_a E_b: what the amplitudes above give, by one division. Reciprocity, r_a * ab = -r_b * ba, follows from the
    Wronskian and is kept to rounding.
    """
    d_a, d_b, e_a, e_b = inner.i_slope, outer.i_slope, inner.k_slope, outer.k_slope
    x, y = i_across(inner, outer), k_across(inner, outer)
    both = x * y
    aa, bb = both * e_b, both * d_a
    inverse = d_b * e_a
    inverse -= aa * d_a
    np.reciprocal(inverse, out=inverse)
    np.subtract(d_b, aa, out=aa)
    np.subtract(e_a, bb, out=bb)
    within, beyond = inverse * inner.radius, np.multiply(inverse, outer.radius, out=inverse)
    aa *= within
    bb *= beyond
    x *= np.subtract(e_a, d_a, out=both)
    x *= beyond
    y *= np.subtract(d_b, e_b, out=both)
    y *= within
    return AnnulusOperator(aa, x, y, bb)
