"""Slips of the shells' section, their sensors and their actuators (Eqs. 19, A.3, A.11)."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace

from scipy.integrate import quad

from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import Problem
from coaxshell.structure.section import PiezoelectricLayer, Section
from coaxshell.structure.shell_model import WallStiffness
from coaxshell.structure.thin import bending_strain, membrane_strain, open_circuit_stiffness
from coaxshell.structure.thin_wall import ThinWall


def control_sign(problem: Problem) -> Problem:
    """Return the problem with +e32 in front of the control term, as Eq. 19 prints it; Eqs. 4 and 13 have -e32."""
    return _with_layers(problem, lambda _, layer: replace(layer, actuator_coupling=-layer.actuator_coupling))


def doubled_curvature(problem: Problem) -> Problem:
    """Return the problem with 1/(R + z)^2 within the integral for zeta22 (Eq. A.11) and 1/R^2 once more where it is used (Eqs. 5, 14, 20).

    The integral is mu22 times that of cos^2(pi (z - z_c)/t)/(R + z)^2 over the layer; numbers in metres, since the two dimensions differ.
    """
    metres = problem.scales.length

    def printed(section: Section, layer: PiezoelectricLayer) -> PiezoelectricLayer:
        radius, centre, half = metres * section.radius, metres * layer.centre, 0.5 * metres * layer.thickness

        def integrand(z: float) -> float:
            return (math.cos(0.5 * math.pi * (z - centre) / half) / (radius + z)) ** 2

        return replace(layer, zeta22=layer.zeta22 / half * quad(integrand, centre - half, centre + half)[0])

    return _with_layers(problem, printed)


@dataclass(frozen=True, kw_only=True)
class PrintedStrain(ThinWall):
    """A thin wall with the strain of Eq. A.3, ((1 - z/R) dv/dtheta - w)/R: no curvature from w, k = (-m, 0)/R^2.

    Only section stiffness is changed; the open-circuit stiffening of piezoelectric layers keeps Eq. 20, which has both terms.
    """

    def stiffness(self, modes: Modes) -> WallStiffness:
        """Return K with that strain."""
        section, orders = self.section, modes.orders
        ev, ew = membrane_strain(orders, section.radius)
        kv, kw = bending_strain(orders, section.radius)
        a, b, d = section.membrane, section.cross, section.bending
        electric = sum(open_circuit_stiffness(layer, orders, section.radius) for layer in section.piezoelectric)
        return WallStiffness(
            vv=a * ev * ev + 2 * b * ev * kv + (d + electric) * kv * kv,
            vw=a * ev * ew + b * ew * kv + electric * kv * kw,
            ww=a * ew * ew + electric * kw * kw,
        )


def printed_strain(problem: Problem) -> Problem:
    """Return the problem with walls of the printed strain."""
    return _changed(problem, lambda wall: PrintedStrain(**{field.name: getattr(wall, field.name) for field in fields(wall)}))


def _with_layers(problem: Problem, change: Callable[[Section, PiezoelectricLayer], PiezoelectricLayer]) -> Problem:
    """Return the problem with its piezoelectric layers changed."""

    def changed(wall: ThinWall) -> ThinWall:
        layers = tuple(change(wall.section, layer) for layer in wall.section.piezoelectric)
        return replace(wall, section=replace(wall.section, piezoelectric=layers))

    return _changed(problem, changed)


def _changed(problem: Problem, change: Callable[[ThinWall], ThinWall]) -> Problem:
    """Return the problem with its thin walls changed."""
    return replace(problem, shells=tuple(change(wall) if isinstance(wall, ThinWall) else wall for wall in problem.shells))
