"""One circumferential order at one axial wavenumber: shells and fluids as M x'' + C x' + K x.

In each fluid a velocity potential carries the motion, u = grad phi, p = -rho dphi/dt, the exterior one the scattered wave alone. It is
truncated so far away that nothing returns. Lengths are in a, times in a/c_e, pressures in rho_e c_e^2; w is positive inward, so
u_r = -dw/dt at a wall. An axial wavenumber k adds k^2 to the Laplacian of every fluid and strains the walls; without it U is at rest.
Unknowns: V of all shells, W of all shells, U of all shells, the potentials from the inside out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.apps.verification.independent.electrodes import Electrodes
from coaxshell.apps.verification.independent.elements import RadialMatrices, elements
from coaxshell.apps.verification.independent.walls import Wall
from coaxshell.model.control import PDControl
from coaxshell.model.feedback import Feedback
from coaxshell.model.fluids import Fluid
from coaxshell.model.gains import gains_of, law_of, reads_of, saturates, segments_of
from coaxshell.model.parts import laws_of
from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.model.shells import Shell
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray

MARGIN = 0.1
"""How far beyond the reach of the last echo the exterior is cut, in a."""


class Region(NamedTuple):
    """One fluid: density and slowness relative to the exterior's, and its elements."""

    density: float
    slowness: float
    radial: RadialMatrices


class Block(NamedTuple):
    """Matrices of one order and the place of the potential at the outermost surface outside."""

    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    exterior_point: int
    late: FloatArray
    """Load of each delayed law per volt, shape (laws, size); laws are the last unknowns of a block."""


@dataclass(frozen=True)
class Assembly:
    """A system's scales, walls and fluid regions, ready to be assembled order by order."""

    system: System
    length: float
    transit: float
    pressure: float
    walls: tuple[Wall, ...]
    regions: tuple[Region | None, ...]
    wavenumber: float = 0.0

    @classmethod
    def of(cls, system: System, duration: float, element: float, wavenumber: float = 0.0) -> Assembly:
        """Return the assembly of a system of elastic shells for a duration in transits, at an axial wavenumber in 1/a."""
        a, c, rho = system.reference_radius, system.exterior.sound_speed, system.exterior.density
        if any(law.transducers == "electrodes" for law in laws_of(system)):
            whole = isinstance(system.control, Feedback) or (segments_of(system) is None and not saturates(system))
            if wavenumber or not whole:
                raise NotImplementedError("electrodes are written without wavenumbers, and cut and limited for Feedback alone, here")
            system = _with_standard_permittivity(system)
        walls = tuple(Wall.of(shell) for shell in system.shells if isinstance(shell, Shell))
        if len(walls) != len(system.shells):
            raise NotImplementedError("the independent solver has no rigid shells")
        inner = [0.0, *(w.wetted[1] / a for w in walls)]
        outer = [*(w.wetted[0] / a for w in walls), inner[-1] + duration / 2 + MARGIN]
        regions = tuple(
            Region(fluid.density / rho, c / fluid.sound_speed, elements(inner[j], outer[j], element)) if isinstance(fluid, Fluid) else None
            for j, fluid in enumerate(system.fluids)
        )
        return cls(system, a, a / c, rho * c**2, walls, regions, wavenumber)

    @property
    def head(self) -> float:
        """Radius of the surface that the exterior fluid wets, in a."""
        return self.walls[-1].wetted[1] / self.length

    @property
    def saturates(self) -> bool:
        """Whether the voltage of the paper's law is limited."""
        return saturates(self.system) and not isinstance(self.system.control, Feedback)

    def block(self, m: int) -> Block:
        """Return the matrices of one order."""
        n = len(self.walls)
        sizes = [0 if region is None else region.radial.nodes.size for region in self.regions]
        offset = 3 * n + np.concatenate([[0], np.cumsum(sizes)]).astype(int)
        laws = len(self.system.controlled_shells) if self.rational else 0
        mass, damping, stiffness = (np.zeros((int(offset[-1]) + laws,) * 2) for _ in range(3))
        for j, region in enumerate(self.regions):
            if region is not None:
                self._fluid(region, j, m, slice(int(offset[j]), int(offset[j + 1])), (mass, damping, stiffness))
        for i in range(n):
            self._shell(i, m, (mass, damping, stiffness))
        late = np.zeros((laws, mass.shape[0]))
        for law, i in enumerate(self.system.controlled_shells if self.rational else ()):
            self._law(i, m, int(offset[-1]) + law, (mass, damping, stiffness), late[law])
        return Block(mass, damping, stiffness, int(offset[-2]), late)

    def _fluid(self, region: Region, j: int, m: int, rows: slice, matrices: tuple[FloatArray, FloatArray, FloatArray]) -> None:
        mass, damping, stiffness = matrices
        n, radial, rho = len(self.walls), region.radial, region.density
        mass[rows, rows] = rho * region.slowness**2 * radial.mass
        stiffness[rows, rows] = rho * (radial.radial + m * m * radial.angular + self.wavenumber**2 * radial.mass)
        for i, point, sign in ((j - 1, rows.start, 1), (j, rows.stop - 1, -1)):  # outside of shell j - 1, inside of shell j
            if 0 <= i < n:
                radius = self.walls[i].wetted[int(sign > 0)] / self.length
                damping[point, n + i] = -sign * rho * radius
                damping[n + i, point] = sign * rho * radius
        if radial.nodes[0] == 0 and m > 0:  # the potential of order m vanishes on the axis
            axis = rows.start
            mass[axis, :] = mass[:, axis] = stiffness[axis, :] = stiffness[:, axis] = 0.0
            mass[axis, axis] = 1.0

    def _shell(self, i: int, m: int, matrices: tuple[FloatArray, FloatArray, FloatArray]) -> None:
        mass, damping, stiffness = matrices
        n, wall = len(self.walls), self.walls[i]
        at, radius = self.displacements(i), wall.radius / self.length
        mass[at, at] = wall.inertia / (self.system.exterior.density * self.length) * radius
        stiffness[np.ix_(at, at)] += wall.stiffness(m, self._per_metre) * self.length / self.pressure * radius
        control = law_of(self.system, i)
        if isinstance(control, PDControl) and not self.saturates:
            proportional, derivative = gains_of(self.system, i)
            if control.transducers == "electrodes":
                shell = self.system.shells[i]
                assert isinstance(shell, Shell)
                found = Electrodes.of(shell, m)
                stiffness[np.ix_(at, at)] += found.stiffness * self.length / self.pressure * radius
                fed_back = np.outer(found.load, found.reading) * self.length / self.pressure * radius
                stiffness[np.ix_(at, at)] -= proportional * fed_back
                damping[np.ix_(at, at)] -= derivative * fed_back
                return
            volts = self.volts(i, m)
            inward = self.inward(i)
            stiffness[n + i, at] -= inward * proportional * volts
            damping[n + i, at] -= inward * derivative * volts

    @property
    def rational(self) -> Feedback | None:
        """The control law if it is one of second order."""
        control = self.system.control
        if isinstance(control, tuple) and any(isinstance(law, Feedback) for law in control):
            raise NotImplementedError("one law of second order for all shells is written in the independent solver")
        return control if isinstance(control, Feedback) else None

    @property
    def law(self) -> tuple[FloatArray, FloatArray]:
        """b and a of u = b_0 y'' + b_1 y' + b_2 y, a_0 y'' + a_1 y' + a_2 y = phi, t in transits."""
        assert self.rational is not None
        numerator, denominator = self.rational.bridged(1.0)  # all sensors of its walls are self-sensing, where there is a bridge
        if self.rational.bridge_imbalance and self.rational.delay:
            raise NotImplementedError("a bridge out of balance is written for laws at once in the independent solver")
        if len(denominator) != 3 or self.rational.transducers != "electrodes":
            raise NotImplementedError("laws of second order between electrodes are written in the independent solver")
        powers = self.transit ** -np.arange(2.0, -1.0, -1.0)
        padded = np.zeros(3)
        padded[3 - len(numerator) :] = numerator
        return padded * powers, np.array(denominator) * powers

    def _law(self, i: int, m: int, place: int, matrices: tuple[FloatArray, FloatArray, FloatArray], late: FloatArray) -> None:
        """Write the law of a shell as one more unknown y, of what its matrix reads; a delayed law's load is known from the past, *late*."""
        shell, control = self.system.shells[i], self.rational
        assert isinstance(shell, Shell)
        assert control is not None
        at, found, (top, bottom) = self.displacements(i), Electrodes.of(shell, m), self.law
        radius = self.walls[i].radius / self.length
        matrices[2][np.ix_(at, at)] += found.stiffness * self.length / self.pressure * radius
        load = found.load / self.pressure * radius
        for matrix, b, a in zip(matrices, top, bottom, strict=True):
            matrix[place, place] = a
            if not control.delay:
                matrix[at, place] -= load * b
        for j, factor in (reads_of(self.system, i) or {i: 1.0}).items():
            read = self.system.shells[j]
            assert isinstance(read, Shell)
            matrices[2][place, self.displacements(j)] -= factor * Electrodes.of(read, m).reading * self.length
        late[at] = load

    @property
    def _per_metre(self) -> float:
        return self.wavenumber / self.length

    def displacements(self, i: int) -> list[int]:
        """Return the places of V, W and U of a shell."""
        n = len(self.walls)
        return [i, n + i, 2 * n + i]

    def volts(self, i: int, m: int) -> FloatArray:
        """Return volts of a shell's sensor per unit (V, W, U)."""
        return self.walls[i].sensor(m, self._per_metre) * self.length

    def inward(self, i: int) -> float:
        """Return the inward load of the actuator on the W equation of a shell per volt, -e32/R times the radius of the row."""
        wall = self.walls[i]
        return -wall.actuator.actuation / (wall.radius * self.pressure) * wall.radius / self.length


def _with_standard_permittivity(system: System) -> System:
    """Return a system whose controlled shells have mu33 + e33^2/c33 in all fields, as walls between electrodes do."""
    shells = list(system.shells)
    for i in system.controlled_shells:
        shell = shells[i]
        assert isinstance(shell, Shell)
        layers = [
            x.replace(material=x.material.replace(permittivity_reduction="standard")) if isinstance(x.material, Piezoelectric) else x
            for x in shell.layers
        ]
        shells[i] = shell.replace(layers=layers)
    return system.replace(shells=shells)
