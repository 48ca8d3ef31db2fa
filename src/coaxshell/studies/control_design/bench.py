"""What a law would do, from the plant alone: margins on the contour of stability, stresses and voltages on the grid of a run.

The plant is found once; a law then costs one division for each order and node, and the inverse transform of a few stresses around the
circle: a hundredth of a run.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.winding import turning
from coaxshell.response.synthesis import angle_basis
from coaxshell.solver.margins import followed, margins_of
from coaxshell.solver.plant import Plant, diagonal, loci, solved_loop
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import Settings
from coaxshell.solver.structure_spectra import StructureSpectra
from coaxshell.structure.control_law import ControlLaw

_STEP = 10.0
"""Degrees between the places at which stresses are looked at."""
_WITHIN = 1e-4
"""Share of a layer's thickness by which its face lies within it."""
_BEYOND, _FAR = 40.0, 160
"""How far above the highest frequency of the walls, and by how many nodes, loops are followed."""


class Margins(NamedTuple):
    """The least of all loops and orders: factors on the gain, radians, and how many poles grow."""

    gain: float
    lesser: float
    phase: float
    unstable: int


class Effect(NamedTuple):
    """What a law does: largest hoop stresses of core and of ceramics and largest voltage, one a controlled shell, Pa and V."""

    core: FloatArray
    ceramic: FloatArray
    volts: FloatArray


@dataclass(frozen=True)
class _Output:
    """A stress of a controlled shell at a depth: without control, (parities, orders, nodes), per volt on each, and of its own voltage."""

    shell: int
    ceramic: bool
    alone: ComplexArray
    per_volt: ComplexArray
    own: float


@dataclass(frozen=True)
class Bench:
    """The plant of a system at the nodes of its run and on the contour of its stability.

    Attributes
    ----------
    problem : Problem
        Of the system, under control by any law.
    settings : Settings
    delay : float
        Of the loop, transits: for how finely the contour has to follow it.
    """

    problem: Problem
    settings: Settings
    delay: float = 0.0

    @property
    def modes(self) -> Modes:
        """The orders of the run."""
        assert isinstance(self.settings.modes, int)
        return Modes.up_to(self.settings.modes)

    @cached_property
    def grid(self) -> LaplaceGrid:
        """The nodes of the run."""
        return LaplaceGrid(self.settings.time_step, self.settings.steps)

    @cached_property
    def at_run(self) -> Plant:
        """The plant at the nodes of the run."""
        return Plant.of(self.problem, self.modes, self.grid.nodes)

    @cached_property
    def contour(self) -> Plant:
        """The plant on Re s = 1/duration: evenly as far as walls resonate, beyond by a growing step, or as a delay turns."""
        least, step = 1.0 / self.settings.duration, 0.8 / self.settings.duration
        ends = Modes(np.array([1.0, max(1.0, self.modes.max_order)]))
        highest = 1.2 * max(float(np.hypot(*wall.highest_frequency(ends))) for wall in self.problem.shells if wall.moves)
        nodes = np.union1d(np.arange(0.0, highest, step), np.geomspace(highest, _BEYOND * highest, _FAR))
        if self.delay:
            nodes = np.union1d(nodes, np.arange(highest, _BEYOND * highest, 0.8 / self.delay))
        return Plant.of(self.problem, self.modes, np.asarray(least + 1j * nodes, dtype=np.complex128))

    @cached_property
    def _alone(self) -> tuple[ComplexArray, ComplexArray]:
        structure = StructureSpectra(self.problem.open_loop, self.grid, self.modes)
        return structure.normal, structure.tangential

    @cached_property
    def readings(self) -> ComplexArray:
        """What the sensors read without control, (controlled, parities, orders, nodes)."""
        normal, tangential = self._alone
        gains = {i: self.problem.shells[i].sensor_gain(self.modes).columns for i in self.at_run.shells}
        return np.stack([gain.v * tangential[i] + gain.w * normal[i] for i, gain in gains.items()])

    @cached_property
    def outputs(self) -> list[_Output]:
        """Hoop stresses at the faces of the core and at the outer face of each piezoelectric layer of the controlled shells, Pa."""
        found, scale = [], self.problem.scales.pressure
        normal, tangential = self._alone
        for i in self.at_run.shells:
            wall, shell = self.problem.shells[i], self.problem.system.shells[i]
            z = wall.faces[0]
            for layer in getattr(shell, "layers", ()):
                thickness = layer.thickness / self.problem.scales.length
                inner, z, ceramic = z, z + thickness, isinstance(layer.material, Piezoelectric)
                if layer is not shell.core and not ceramic:  # type: ignore[union-attr]
                    continue
                for depth in (z - _WITHIN * thickness,) if ceramic else (inner + _WITHIN * thickness, z - _WITHIN * thickness):
                    alone: ComplexArray | float = 0.0
                    per_volt: ComplexArray | float = 0.0
                    for factor, gain in wall.stress_parts(self.modes, depth):
                        g = scale if factor is None else scale * factor.at(self.grid.nodes)
                        alone = alone + g * (gain.columns.v * tangential[i] + gain.columns.w * normal[i])
                        per_volt = per_volt + g * self.at_run.per_volt(i, gain)
                    own = scale * wall.control_stress(depth)
                    found.append(_Output(i, ceramic, np.asarray(alone), np.asarray(per_volt), own))
        return found

    @cached_property
    def _basis(self) -> FloatArray:
        parities = self.readings.shape[1]
        angles = np.arange(0.0, 180.0 + _STEP if parities == 1 else 360.0, _STEP)
        return angle_basis(angles, self.modes.count, parities).reshape(len(angles), -1)

    def _largest(self, modal: ComplexArray) -> float:
        return float(np.abs(self.grid.invert(self._basis @ modal.reshape(-1, modal.shape[-1]))).max())

    @cached_property
    def without(self) -> Effect:
        """What the sources do without control."""
        return self._effect(None)

    def effect(self, law: ControlLaw) -> Effect:
        """Return what the sources do under a law on all controlled shells."""
        plant = self.at_run
        wide = np.broadcast_to(law.at(plant.nodes, plant.modes), plant.transfer.shape[2:])
        return self._effect(solved_loop(plant.transfer, diagonal(wide, len(plant.shells)), self.readings))

    def _effect(self, volts: ComplexArray | None) -> Effect:
        shells = list(self.at_run.shells)
        core, ceramic, voltage = (np.zeros(len(shells)) for _ in range(3))
        for one in self.outputs:
            place, total = shells.index(one.shell), one.alone
            if volts is not None:
                total = total + np.einsum("jmk,jhmk->hmk", one.per_volt, volts) + one.own * volts[place]
            kept = ceramic if one.ceramic else core
            kept[place] = max(kept[place], self._largest(total))
        if volts is not None:
            voltage = np.array([self._largest(one) for one in volts])
        return Effect(core, ceramic, voltage)

    def margins(self, law: ControlLaw, highest: int) -> Margins:
        """Return the margins of a law of the orders up to one, the loops of all shells changed alike."""
        plant = self._contour_up_to(highest)
        wide = np.broadcast_to(law.at(plant.nodes, plant.modes), plant.transfer.shape[2:])
        values = loci(plant.transfer, diagonal(wide, len(plant.shells)))
        closed = np.prod(1.0 - values, axis=0)
        turned = turning(closed) + np.angle(1.0 / closed[:, -1])
        unstable = int(np.rint(np.maximum(-turned / np.pi, 0.0)).sum())
        if unstable:
            return Margins(1.0, 1.0, 0.0, unstable)
        found = [margins_of(plant.modes.orders, plant.nodes, one) for one in followed(values)]
        gain, lesser, phase = (np.stack([getattr(one, name) for one in found]) for name in ("gain", "lesser_gain", "phase"))
        return Margins(float(gain.min()), float(lesser.max()), float(phase.min()), 0)

    def _contour_up_to(self, highest: int) -> Plant:
        if highest not in self._cut:
            self._cut[highest] = self.contour.up_to(highest)
        return self._cut[highest]

    @cached_property
    def _cut(self) -> dict[int, Plant]:
        return {}
