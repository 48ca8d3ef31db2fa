"""Slips of the response functions and the pressures made of them (Eqs. B.8, B.10, B.13), as factors on the motion that a fluid feels.

The paper's two shells are 0 (inner, radius r1 = R1/R2) and 1 (outer, radius 1); its fluids 0 (interior), 1 (gap) and 2 (exterior).
"""

from __future__ import annotations

from dataclasses import replace

from coaxshell.acoustics.operators import annulus, annulus_amplitudes
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.ingredients import Ingredients, Radial
from coaxshell.solver.scaling import Problem

Factor = ComplexArray | float


def radius_factor(ingredients: Ingredients) -> Ingredients:
    """Return the ingredients with r1^2 on all that the inner shell radiates: Xi^(1) into the gap (B.8), Xi^(i) inside (B.10).

    What the outer shell radiates into the gap, Xi^(2) (B.9), has no such factor. On the inner shell it is the same as a shell r1^-2
    times as heavy and stiff that moves r1^2 times as much: with massless shells in one fluid its motion comes out 1/r1^2 times too large.
    """

    def felt(problem: Problem, region: int, wall: int, radial: Radial) -> Factor:
        factor = problem.shells[0].radius ** 2 if wall == 0 else 1.0
        return factor * ingredients.wall_motion_factor(problem, region, wall, radial)

    return replace(ingredients, wall_motion_factor=felt)


def interior_derivative(ingredients: Ingredients) -> Ingredients:
    """Return the ingredients with I_m'(s) for I_m'(r1 s) in Xi^(i) (B.10): a factor I_m'(r1 s)/I_m'(s), of the order of e^{-(1 - r1)s}."""

    def felt(problem: Problem, region: int, wall: int, radial: Radial) -> Factor:
        factor: Factor = 1.0
        if region == 0:
            fluid = problem.fluids[0]
            assert fluid is not None
            factor = annulus_amplitudes(radial(fluid.slowness, problem.shells[0].radius), radial(fluid.slowness, 1.0)).epsilon_i
        return factor * ingredients.wall_motion_factor(problem, region, wall, radial)

    return replace(ingredients, wall_motion_factor=felt)


def interior_function(ingredients: Ingredients) -> Ingredients:
    """Return the ingredients with the gap's xi^(1) for xi^(i) in P^(r,i) (B.13): an annulus of the interior's fluid instead of a disc.

    Only the pressure on the shell is the printed one. Within the disc the printed function grows without bound towards the axis, and
    the disc's own field, driven so that it agrees at the wall, stands in for it.
    """

    def felt(problem: Problem, region: int, wall: int, radial: Radial) -> Factor:
        factor: Factor = 1.0
        if region == 0:
            fluid = problem.fluids[0]
            assert fluid is not None
            inner = radial(fluid.slowness, problem.shells[0].radius)
            factor = -annulus(inner, radial(fluid.slowness, 1.0)).aa / inner.disc
        return factor * ingredients.wall_motion_factor(problem, region, wall, radial)

    return replace(ingredients, wall_motion_factor=felt)


def radiation_sign(ingredients: Ingredients) -> Ingredients:
    """Return the ingredients with the printed signs of P^(r,e) (B.13) and Xi_e (B.7) together: the radiated pressure changes its own."""

    def felt(problem: Problem, region: int, wall: int, radial: Radial) -> Factor:
        return (-1.0 if region == 2 else 1.0) * ingredients.wall_motion_factor(problem, region, wall, radial)

    return replace(ingredients, wall_motion_factor=felt)
