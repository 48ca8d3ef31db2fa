"""Fields inside the fluid regions: modal pressure and its radial slope at a radius, per unit slope at the region's walls.

A wall that moves with displacement w, positive inward, fixes the slope dp/dr = (rho/rho_e) s^2 w there, and the fluid's own
equation of motion gives its particle velocity everywhere (dimensionless, v in c_e, components along r and theta outward and
anticlockwise),

    (rho/rho_e) s v_r = -dp/dr,        (rho/rho_e) s v_theta = -(1/r) dp/dtheta.

For a pressure amplitude P_m of cos(m theta) the second one is v_theta = m P_m/(r (rho/rho_e) s) sin(m theta); for sin(m theta)
it is the negative of that times cos(m theta). Everything depends on the radial wavenumber kappa alone and is built from ratios
that stay bounded at every order and argument. The centre of a disc is reached with a tiny radius (1e-9 will do), not zero.
"""

from __future__ import annotations

from typing import NamedTuple

from coaxshell.acoustics.operators import AnnulusAmplitudes, annulus_amplitudes
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.radial_functions import RadialFunctions, i_across, k_across


class RadialField(NamedTuple):
    """Modal pressure and radial slope dp/dr at one radius per unit slope at one wall, each of shape (orders, nodes)."""

    pressure: ComplexArray
    slope: ComplexArray


def disc_field(here: RadialFunctions, wall: RadialFunctions) -> RadialField:
    """Return the field of a disc: p = I_m(kr)/(k I_m'(k r1)), dp/dr = I_m'(kr)/I_m'(k r1).

    Parameters
    ----------
    here : RadialFunctions
        At the radius of the field, 0 < r <= r1.
    wall : RadialFunctions
        At the disc's wall r1, with the same wavenumbers and orders.
    """
    pressure = i_across(here, wall) * wall.disc
    return RadialField(pressure, pressure / here.disc)


def exterior_field(here: RadialFunctions, wall: RadialFunctions) -> RadialField:
    """Return the outgoing field around a cylinder: p = K_m(kr)/(k K_m'(k r1)), dp/dr = K_m'(kr)/K_m'(k r1).

    Radiated and rigidly scattered waves both are of this form; the slope at the wall is that of the wall's motion for the first
    and minus that of the incident wave for the second. Its outgoing delay e^{-k(r - r1)} is part of it.

    Parameters
    ----------
    here : RadialFunctions
        At the radius of the field, r >= r1.
    wall : RadialFunctions
        At the cylinder's wall r1, with the same wavenumbers and orders.
    """
    pressure = outgoing(here, wall) * wall.exterior
    return RadialField(pressure, pressure / here.exterior)


def outgoing(here: RadialFunctions, wall: RadialFunctions) -> ComplexArray:
    """Return K_m(kr)/K_m(k r1), r >= r1: pressure of an outgoing wave at r per pressure at the wall, shape (orders, nodes)."""
    return k_across(wall, here)


def annulus_field(
    here: RadialFunctions, inner: RadialFunctions, outer: RadialFunctions, amplitudes: AnnulusAmplitudes | None = None
) -> tuple[RadialField, RadialField]:
    """Return the fields of an annulus per unit slope at its inner wall alone and at its outer wall alone.

    p = A I_m(kr)/(k I_m'(k rb)) + B K_m(kr)/(k K_m'(k ra)); a slope g_a = 1 at the inner wall gives A = -eps_K/D, B = 1/D, a
    slope g_b = 1 at the outer one A = 1/D, B = -eps_I/D, with D = 1 - eps_I eps_K.

    Parameters
    ----------
    here : RadialFunctions
        At the radius of the field, ra <= r <= rb.
    inner, outer : RadialFunctions
        At the two walls, with the same wavenumbers and orders.
    amplitudes : AnnulusAmplitudes, optional
        Those of the two walls, if known; they do not depend on r.
    """
    eps_i, eps_k, determinant = annulus_amplitudes(inner, outer) if amplitudes is None else amplitudes
    standing = i_across(here, outer) * outer.disc / determinant
    evanescent = outgoing(here, inner) * inner.exterior / determinant
    standing_slope, evanescent_slope = standing / here.disc, evanescent / here.exterior
    return (
        RadialField(evanescent - eps_k * standing, evanescent_slope - eps_k * standing_slope),
        RadialField(standing - eps_i * evanescent, standing_slope - eps_i * evanescent_slope),
    )
