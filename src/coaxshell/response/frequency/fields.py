"""Pressures at a frequency: at points of any fluid, far away, and mean squares over the fluids within (theory manual, "Steady motion")."""

from __future__ import annotations

from typing import NamedTuple, cast

import numpy as np

from coaxshell.acoustics.operators import annulus
from coaxshell.acoustics.radial_fields import annulus_field, disc_field, exterior_field
from coaxshell.acoustics.sources import SteadyGeometry
from coaxshell.numerics import bessel_ratios as br
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.frequency.steady import Steady, with_parities
from coaxshell.solver.scaling import Problem

CENTRE = 1e-9
"""Least radius at which a disc is evaluated, in a."""


class Slopes(NamedTuple):
    """Modal slopes dp/dr at the inner and the outer wall of a fluid, (parities, M + 1, nodes); None where it has no such wall."""

    inner: ComplexArray | None
    outer: ComplexArray | None


def slopes(steady: Steady, region: int) -> Slopes:
    """Return what drives a fluid: (rho/rho_e) s^2 w of its walls, outside less the slope of the incident wave."""
    problem, motion, radial = steady.problem, steady.motion, steady.system.radial
    fluid = problem.fluids[region]
    assert fluid is not None
    inner = outer = None
    if region > 0:
        inner = fluid.density * fluid.wall_motion_factor(region - 1, radial) * steady.s**2 * motion.outer[region - 1]
    if region < len(problem.shells):
        outer = fluid.density * fluid.wall_motion_factor(region, radial) * steady.s**2 * motion.inner[region]
    if region == len(problem.shells):
        inner = np.asarray(inner) - with_parities(motion.slope, motion.parities)
    return Slopes(inner, outer)


def modal_pressure(steady: Steady, region: int, radius: float, driven: Slopes) -> ComplexArray:
    """Return the modal pressure at a radius (in a) of a fluid, outside the scattered one, (parities, M + 1, nodes)."""
    fluid, walls, radial = steady.problem.fluids[region], steady.problem.shells, steady.system.radial
    assert fluid is not None
    here = radial.passing(fluid.slowness, max(radius, CENTRE))
    if driven.outer is None:
        assert driven.inner is not None
        return driven.inner * exterior_field(here, radial(fluid.slowness, walls[-1].wetted[1])).pressure
    outer = radial(fluid.slowness, walls[region].wetted[0])
    if driven.inner is None:
        return driven.outer * disc_field(here, outer).pressure
    from_inner, from_outer = annulus_field(here, radial(fluid.slowness, walls[region - 1].wetted[1]), outer)
    return driven.inner * from_inner.pressure + driven.outer * from_outer.pressure


def region_of(problem: Problem, radius: float) -> int | None:
    """Return the number of the fluid at a radius (in a); None within a wall or in a vacuum. On a face it is the fluid there."""
    walls, region = problem.shells, 0
    for wall in walls:
        inner, outer = wall.wetted
        if radius <= inner * (1.0 + 1e-12):
            break
        if radius < outer * (1.0 - 1e-12):
            return None
        region += 1
    return region if problem.fluids[region] is not None else None


def pressure_at(steady: Steady, radii: FloatArray, theta: FloatArray, part: str, incident: ComplexArray | None) -> ComplexArray:
    """Return the pressure at radii (in a) and angles, dimensionless, (nodes, radii, A); NaN where there is no fluid.

    Parameters
    ----------
    steady : Steady
    radii, theta : ndarray
    part : str
        "total"; outside also "incident" or "scattered".
    incident : ndarray, shape (radii, A, nodes), or None
        The incident wave in free field.
    """
    found = np.full((steady.s.size, radii.size, np.size(theta)), np.nan + 0j)
    for number, radius in enumerate(radii):
        region = region_of(steady.problem, float(radius))
        if region is None:
            continue
        outside = region == len(steady.problem.shells)
        values: ComplexArray | float = 0.0
        if part != "incident" or not outside:
            values = steady.around(modal_pressure(steady, region, float(radius), slopes(steady, region)), theta)
        if outside and incident is not None and part != "scattered":
            values = values + incident[number].T
        found[:, number] = values
    return found


def free_field(steady: Steady, geometry: SteadyGeometry, turned: float, radii: FloatArray, theta: FloatArray) -> ComplexArray:
    """Return the pressure of a unit pulse of a source at an angle *turned* (degrees) in free field, shape (radii, A, nodes)."""
    angle = np.radians(np.atleast_1d(theta) - turned)
    x, y = np.multiply.outer(radii, np.cos(angle)), np.multiply.outer(radii, np.sin(angle))
    return geometry.free_spectrum(steady.s, x.ravel(), y.ravel()).reshape(*x.shape, -1)


def far_amplitudes(steady: Steady) -> ComplexArray:
    """Return f_m of the form function f = sum f_m cos m theta (sin), (parities, M + 1, nodes): p_s = p_i f sqrt(b/2r) e^{-i kappa r}.

    p_s = sum A_m K_m(kappa r)/K_m(kappa b), A_m = E dp_s/dr on the surface r = b, and K_m(z) -> sqrt(pi/2z) e^{-z}. The incident pressure
    p_i is that on the axis, e^{-kappa b}:

        f_m = sqrt(pi/(kappa b)) A_m e^{2 kappa b}/(e^{kappa b} K_m(kappa b)).
    """
    head = steady.problem.head
    surface = steady.system.radial(1.0, head)
    driven = slopes(steady, len(steady.problem.shells)).inner
    assert driven is not None
    inverse = surface.keep(br.running_product(1.0 / br.kve(0, surface.argument), 1.0 / surface.k_ratios))
    reach = np.sqrt(np.pi / surface.argument) * np.exp(2.0 * surface.argument)
    return np.asarray(driven * surface.exterior * inverse * reach)


def form_function(steady: Steady, theta: FloatArray) -> ComplexArray:
    """Return f at angles, (nodes, A)."""
    return steady.around(far_amplitudes(steady), theta)


def widths(steady: Steady, forward: float) -> tuple[FloatArray, FloatArray]:
    """Return scattering and extinction widths, m: the power that is scattered, and that the forward wave loses, per incident intensity.

    sigma_s = (b/2) * integral of |f|^2,      sigma_e = -2 sqrt(pi b/k) Re[f(forward) e^{-i pi/4}].
    """
    f = far_amplitudes(steady)
    scales, head = steady.problem.scales, steady.problem.head
    beta_pi = np.pi * np.where(steady.system.modes.orders == 0, 2.0, 1.0)
    scattered = 0.5 * head * np.einsum("m,hmn->n", beta_pi, np.abs(f) ** 2)
    ahead = steady.around(f, np.array([forward]))[:, 0]
    lost = -2.0 * np.sqrt(np.pi * head / steady.s.imag) * (ahead * np.exp(-0.25j * np.pi)).real
    return scales.length * scattered, scales.length * lost


def on_axis(steady: Steady) -> ComplexArray:
    """Return the pressure on the axis, dimensionless, shape (nodes,)."""
    return pressure_at(steady, np.zeros(1), np.zeros(1), "total", None)[:, 0, 0]


def mean_square(steady: Steady, region: int) -> FloatArray:
    """Return the mean of |p|^2 over the area of a fluid within the shells, dimensionless, shape (nodes,).

    Of two solutions u, v of Bessel's equation with k^2 = -kappa^2 (Lommel)

        2 k^2 * integral of u v r dr = [r^2 u' v' + (k^2 r^2 - m^2) u v].
    """
    walls, fluid, radial = steady.problem.shells, steady.problem.fluids[region], steady.system.radial
    assert fluid is not None
    driven, m = slopes(steady, region), steady.system.modes.column
    outer_radius = walls[region].wetted[0]
    outer = radial(fluid.slowness, outer_radius)
    k2 = -(outer.kappa**2).real
    edges: list[tuple[float, float, ComplexArray, ComplexArray]] = []
    assert driven.outer is not None
    if driven.inner is None:
        edges.append((1.0, outer_radius, driven.outer * outer.disc, driven.outer))
        inner_radius = 0.0
    else:
        inner_radius = walls[region - 1].wetted[1]
        gap = annulus(radial(fluid.slowness, inner_radius), outer)
        edges.append((1.0, outer_radius, driven.inner * gap.ba + driven.outer * gap.bb, driven.outer))
        edges.append((-1.0, inner_radius, driven.inner * gap.aa + driven.outer * gap.ab, driven.inner))
    integral: FloatArray | float = 0.0
    for sign, r, p, slope in edges:
        integral = integral + sign * (r**2 * np.abs(slope) ** 2 + (k2 * r**2 - m**2) * np.abs(p) ** 2)
    beta_pi = np.pi * np.where(m == 0, 2.0, 1.0)
    area = np.pi * (outer_radius**2 - inner_radius**2)
    return np.asarray((beta_pi * integral).sum(axis=(0, 1)) / (2.0 * k2 * area), dtype=np.float64)


def steady_geometry(geometry: object) -> SteadyGeometry:
    """Return a geometry as one whose wave is known at one frequency."""
    return cast(SteadyGeometry, geometry)
