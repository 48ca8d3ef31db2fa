"""What a number changes by with density, slowness and the wetted radii of each fluid: a few slopes, which all variables share."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.adjoint.structure import summed
from coaxshell.solver.cascade import FluidOperator, fluid_operator
from coaxshell.solver.scaling import FluidRegion, Problem

_STEP = 3e-5
"""Relative step of slowness and radii; gaps resonate beside the contour of the transform."""


class FluidSlopes:
    """What a number changes by with the fluids between walls with faces.

    Parameters
    ----------
    problem : Problem
        Of the run.
    bars : list of ndarray, shape (4, orders, nodes)
        What it changes by per unit of aa, ab, ba and bb of each fluid.
    modes : Modes
    s : ndarray, shape (nodes,)
    """

    def __init__(self, problem: Problem, bars: Sequence[ComplexArray], modes: Modes, s: ComplexArray) -> None:
        self._problem, self._bars, self._modes, self._s = problem, bars, modes, s
        self._known: dict[tuple[int, int], float] = {}

    def change(self, old: Problem, new: Problem) -> float:
        """Return what the number changes by to first order from one problem near that of the run to another."""
        total = 0.0
        for region, fluid in enumerate(self._problem.fluids):
            if fluid is not None:
                ends = zip(_numbers(old, region), _numbers(new, region), strict=True)
                total += sum((y - x) * self._slope(region, which) for which, (x, y) in enumerate(ends) if x != y)
        return total

    def _slope(self, region: int, which: int) -> float:
        """Return the derivative by one of the numbers of a fluid: its operator is linear in its density."""
        if (region, which) not in self._known:
            numbers = _numbers(self._problem, region)
            if which == 0:
                found = self._at(region, numbers) / numbers[0]
            else:
                step = _STEP * numbers[which]
                coarse, fine = (self._difference(region, which, part * step) for part in (1.0, 0.5))
                found = (4.0 * fine - coarse) / 3.0
            self._known[region, which] = found
        return self._known[region, which]

    def _difference(self, region: int, which: int, step: float) -> float:
        numbers = _numbers(self._problem, region)
        ends = [(*numbers[:which], numbers[which] + sign * step, *numbers[which + 1 :]) for sign in (1.0, -1.0)]
        return (self._at(region, ends[0]) - self._at(region, ends[1])) / (2.0 * step)

    def _at(self, region: int, numbers: tuple[float, ...]) -> float:
        """Return the sum of the fluid's operator times what a unit of it changes, at some numbers."""
        fluid = self._problem.fluids[region]
        assert fluid is not None
        density, slowness, *radii = numbers
        wetted = [wall.wetted for wall in self._problem.shells]
        for i, radius in zip(_beside(self._problem, region), radii, strict=True):
            wetted[i] = (wetted[i][0], radius) if i < region else (radius, wetted[i][1])
        operator: FluidOperator = fluid_operator(
            replace(fluid, density=density, slowness=slowness), region, wetted, RadialBasis(self._modes, self._s), self._s
        )
        return sum(summed(bar, entry) for bar, entry in zip(self._bars[region], operator, strict=True))


def _beside(problem: Problem, region: int) -> list[int]:
    """Return the numbers of the walls beside a fluid."""
    return [i for i in (region - 1, region) if 0 <= i < len(problem.shells)]


def _numbers(problem: Problem, region: int) -> tuple[float, ...]:
    """Return density, slowness and the radii of the faces that a fluid wets."""
    fluid = problem.fluids[region]
    assert isinstance(fluid, FluidRegion)
    radii = (problem.shells[i].wetted[int(i < region)] for i in _beside(problem, region))
    return (fluid.density, fluid.slowness, *radii)
