"""From a system in SI to the dimensionless problem: lengths in a, times in a/c_e, pressures in rho_e c_e^2.

a is the mid-surface radius of the outermost shell and e the exterior fluid, so one time unit is one acoustic transit of
the outer radius.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coaxshell.model.fluids import Fluid
from coaxshell.model.shells import RigidShell
from coaxshell.model.system import System
from coaxshell.solver.ingredients import OWN, Ingredients
from coaxshell.structure.section import Section, section
from coaxshell.structure.thin import WallStiffness, potential_gain


@dataclass(frozen=True)
class Scales:
    """SI value of one dimensionless unit.

    Attributes
    ----------
    length : float
        a, m.
    time : float
        a/c_e, s.
    pressure : float
        rho_e c_e^2, Pa.
    """

    length: float
    time: float
    pressure: float

    @property
    def velocity(self) -> float:
        """c_e, m/s."""
        return self.length / self.time

    @property
    def line_force(self) -> float:
        """rho_e c_e^2 a, N/m."""
        return self.pressure * self.length

    @property
    def line_energy(self) -> float:
        """rho_e c_e^2 a^2, J/m."""
        return self.pressure * self.length**2


@dataclass(frozen=True)
class FluidRegion:
    """One fluid in dimensionless form: density ratio rho/rho_e and slowness ratio alpha = c_e/c."""

    density: float
    slowness: float


@dataclass(frozen=True)
class ControlGains:
    """PD feedback of one shell: u = proportional * phi_s + derivative * dphi_s/dt, t dimensionless (Eq. 17)."""

    proportional: float
    derivative: float


@dataclass(frozen=True)
class ShellProblem:
    """One shell in dimensionless form.

    Attributes
    ----------
    radius : float
        R/a.
    section : Section or None
        Section integrals in SI; None for a rigid shell (w = v = 0).
    mass : float
        I/(rho_e a).
    gains : ControlGains or None
        Feedback from this shell's sensor to its actuator.
    """

    radius: float
    section: Section | None
    mass: float
    gains: ControlGains | None = None


@dataclass(frozen=True)
class Problem:
    """The dimensionless problem.

    Attributes
    ----------
    system : System
        Where it comes from.
    scales : Scales
    shells : tuple of ShellProblem
        From the inside out.
    fluids : tuple of FluidRegion or None
        From the inside out, one more than the shells; None is a vacuum.
    ingredients : Ingredients
        Formulas by their place, the theory manual's unless a study changes one.
    """

    system: System
    scales: Scales
    shells: tuple[ShellProblem, ...]
    fluids: tuple[FluidRegion | None, ...]
    ingredients: Ingredients = OWN

    @property
    def open_loop(self) -> Problem:
        """The problem without feedback."""
        return replace(self, shells=tuple(replace(shell, gains=None) for shell in self.shells))

    def stiffness(self, index: int, m: np.ndarray) -> WallStiffness:
        """Return the dimensionless modal stiffness of one shell, K a/(rho_e c_e^2)."""
        wall = self.shells[index].section
        assert wall is not None
        factor = self.scales.length / self.scales.pressure
        return WallStiffness(*(factor * entry for entry in self.ingredients.stiffness(wall, m)))

    def sensor_gain(self, index: int, m: np.ndarray, role: str = "sensor") -> tuple[np.ndarray, np.ndarray]:
        """Return volts of a layer per unit dimensionless (V, W) of one shell (Eq. 20); zeros if it has no such layer."""
        wall = self.shells[index].section
        layer = wall.layer(role) if wall is not None else None
        if wall is None or layer is None:
            return np.zeros_like(m), np.zeros_like(m)
        gain_v, gain_w = potential_gain(layer, m, wall.radius)
        return self.scales.length * gain_v, self.scales.length * gain_w

    def actuator_pressure(self, index: int) -> float:
        """Return the dimensionless inward pressure per volt of control, -e32/(R rho_e c_e^2) (Eqs. 4, 13)."""
        wall = self.shells[index].section
        actuator = wall.layer("actuator") if wall is not None else None
        if wall is None or actuator is None:
            return 0.0
        return -actuator.actuator_coupling / (wall.radius * self.scales.pressure)


def dimensionless(system: System) -> Problem:
    """Return the dimensionless problem of a system."""
    exterior = system.exterior
    a, c, rho = system.reference_radius, exterior.sound_speed, exterior.density
    scales = Scales(length=a, time=a / c, pressure=rho * c**2)
    shells = tuple(_shell(system, i, rho * a) for i in range(len(system.shells)))
    fluids = tuple(FluidRegion(fluid.density / rho, c / fluid.sound_speed) if isinstance(fluid, Fluid) else None for fluid in system.fluids)
    return Problem(system, scales, shells, fluids)


def _shell(system: System, index: int, mass_scale: float) -> ShellProblem:
    shell = system.shells[index]
    radius = shell.radius / system.reference_radius
    if isinstance(shell, RigidShell):
        return ShellProblem(radius, None, 0.0)
    wall = section(shell)
    return ShellProblem(radius, wall, wall.mass / mass_scale, _gains(system, index))


def _gains(system: System, index: int) -> ControlGains | None:
    control = system.control
    if control is None or index not in system.controlled_shells:
        return None
    return ControlGains(control.proportional, control.derivative)
