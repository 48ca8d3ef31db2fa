"""What the paper's actuator leaves out (Eqs. 4, 13, 19): the traction along the wall and the moment that its pressure comes with.

A hoop force N = -e32 u at z_a loads (V, W) by e32 B(z_a)' u, of which Eq. 19 has the pressure -(e32/R) u on W alone.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import Problem
from coaxshell.structure.electroded_wall import ElectrodedWall
from coaxshell.structure.shell_model import Gain, WallEnergy, WallMotion, WallStiffness
from coaxshell.structure.stress import strain_gain
from coaxshell.structure.thin_wall import ThinWall


@dataclass(frozen=True, kw_only=True)
class WhollyDriven(ElectrodedWall):
    """A wall that reads curvature as the paper's does and is driven by all that its actuator exerts, e32 as the paper takes it."""

    def stiffness(self, modes: Modes) -> WallStiffness:
        """Return K; the sensor's faces are grounded."""
        return ThinWall.stiffness(self, modes)

    def energy(self, motion: WallMotion) -> WallEnergy:
        """Return the energies of a motion."""
        return ThinWall.energy(self, motion)

    def drive(self, modes: Modes) -> Gain:
        """Return e32 B(z_a)."""
        actuator = self.section.layer("actuator")
        assert actuator is not None
        v, w = strain_gain(modes.orders, self.radius, actuator.centre)
        return Gain(actuator.actuator_coupling * v, actuator.actuator_coupling * w)

    def sensor_gain(self, modes: Modes, role: str = "sensor") -> Gain:
        """Return volts of the sensor per unit (V, W) (Eq. 20)."""
        return ThinWall.sensor_gain(self, modes, role)


def whole_actuation(problem: Problem) -> Problem:
    """Return a problem under the paper's law with all that its actuators exert."""
    walls = tuple(
        WhollyDriven(**{field.name: getattr(wall, field.name) for field in fields(wall)}) if type(wall) is ThinWall else wall
        for wall in problem.shells
    )
    return replace(problem, shells=walls)
