"""Slips of the response functions and the pressures made of them (Eqs. B.8, B.10, B.13), as factors on the motion that a fluid feels.

The paper's two shells are 0 (inner, radius r1 = R1/R2) and 1 (outer, radius 1); its fluids 0 (interior), 1 (gap) and 2 (exterior).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.acoustics.operators import annulus, annulus_amplitudes
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.scaling import FluidRegion, Problem

Factor = ComplexArray | float


@dataclass(frozen=True)
class SlippedFluid(FluidRegion):
    """A fluid that feels the motion of its walls by a factor more than another one, given wall and Bessel ratios."""

    other: FluidRegion
    factor: Callable[[int, RadialBasis], Factor]

    def wall_motion_factor(self, wall: int, radial: RadialBasis) -> Factor:
        """Return that factor on the other one's."""
        return self.factor(wall, radial) * self.other.wall_motion_factor(wall, radial)


def radius_factor(problem: Problem) -> Problem:
    """Return the problem with r1^2 on all that the inner shell radiates: Xi^(1) into the gap (B.8), Xi^(i) inside (B.10).

    What the outer shell radiates into the gap, Xi^(2) (B.9), has no such factor. On the inner shell it is the same as a shell r1^-2
    times as heavy and stiff that moves r1^2 times as much: with massless shells in one fluid its motion comes out 1/r1^2 times too large.
    """
    square = problem.shells[0].radius ** 2
    for region in (0, 1):
        problem = _with_factor(problem, region, lambda wall, radial: square if wall == 0 else 1.0)
    return problem


def interior_derivative(problem: Problem) -> Problem:
    """Return the problem with I_m'(s) for I_m'(r1 s) in Xi^(i) (B.10): a factor I_m'(r1 s)/I_m'(s), of the order of e^{-(1 - r1)s}."""
    slowness, radius = _interior(problem)
    return _with_factor(problem, 0, lambda wall, radial: annulus_amplitudes(radial(slowness, radius), radial(slowness, 1.0)).epsilon_i)


def interior_function(problem: Problem) -> Problem:
    """Return the problem with the gap's xi^(1) for xi^(i) in P^(r,i) (B.13): an annulus of the interior's fluid instead of a disc.

    Only the pressure on the shell is the printed one. Within the disc the printed function grows without bound towards the axis, and
    the disc's own field, driven so that it agrees at the wall, stands in for it.
    """
    slowness, radius = _interior(problem)

    def factor(wall: int, radial: RadialBasis) -> Factor:
        inner = radial(slowness, radius)
        return -annulus(inner, radial(slowness, 1.0)).aa / inner.disc

    return _with_factor(problem, 0, factor)


def radiation_sign(problem: Problem) -> Problem:
    """Return the problem with the printed signs of P^(r,e) (B.13) and Xi_e (B.7) together: the radiated pressure changes its own."""
    return _with_factor(problem, 2, lambda wall, radial: -1.0)


def _interior(problem: Problem) -> tuple[float, float]:
    fluid = problem.fluids[0]
    assert fluid is not None
    return fluid.slowness, problem.shells[0].radius


def _with_factor(problem: Problem, region: int, factor: Callable[[int, RadialBasis], Factor]) -> Problem:
    """Return the problem with a factor on the motion that one fluid feels."""
    fluids = list(problem.fluids)
    fluid = fluids[region]
    assert fluid is not None
    fluids[region] = SlippedFluid(fluid.density, fluid.slowness, fluid, factor)
    return replace(problem, fluids=tuple(fluids))
