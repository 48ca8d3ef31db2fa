"""A thin wall between electrodes whose feedback is no matter of one order of it alone: it reads other walls, or ties orders to each other.

Such a wall is that without feedback, whose driven layers are short-circuited; the solver closes the loops of all walls together
(:mod:`coaxshell.solver.tied`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.belts import Belts
from coaxshell.structure.electroded_wall import ElectrodedWall, LossyElectrodedWall, length_of
from coaxshell.structure.shell_model import Gain, Leading, WallOperator


class Read(NamedTuple):
    """A wall that another one's actuators answer: its number, by how much its mean reading counts, and itself without feedback."""

    shell: int
    factor: float
    wall: ElectrodedWall


@dataclass(frozen=True, kw_only=True)
class TiedWall(ElectrodedWall):
    """A wall of thin layers between electrodes that are driven by what any wall reads.

    Attributes
    ----------
    reads : tuple of Read, or None
        What its actuators answer; None for its own reading alone.
    belts : Belts, or None
        Those into which its electrodes are cut along the axis; None where they are not.
    """

    reads: tuple[Read, ...] | None = None
    belts: Belts | None = None

    @property
    def shares(self) -> dict[int, float] | None:
        """By how much the reading of each wall counts, by number; None for its own alone."""
        return None if self.reads is None else {one.shell: one.factor for one in self.reads}

    @property
    def open(self) -> ElectrodedWall:
        """The wall without its feedback."""
        return self.with_gains(None)

    def operator(self, modes: Modes, s: ComplexArray) -> WallOperator:
        """Return impedance and V/W of the wall without feedback."""
        return self.passive(modes, s)

    def resistance(self, modes: Modes, s: ComplexArray) -> FloatArray:
        """Return Re Z/s of the wall without feedback."""
        return super().resistance(modes, s) if self.gains is None else self.open.resistance(modes, s)

    def leading(self, modes: Modes) -> Leading:
        """Return mass and damping at once of the wall without feedback."""
        return Leading(self.mass, self.damping)

    def highest_frequency(self, modes: Modes) -> FloatArray:
        """Return the membrane frequency of each order, with what feedback stiffens it by at most."""
        if self.gains is None:
            return super().highest_frequency(modes)
        alone = self.open.highest_frequency(modes)
        stiffening = np.maximum(self.gains.stiffening(modes.orders, alone), 0.0)
        return np.asarray(np.sqrt(alone**2 + stiffening * self._spread(modes)))

    @property
    def shown_potentials(self) -> int:
        """How many voltages stations show: under belts one more, of the charge that strain brings under a belt."""
        return super().shown_potentials + (1 if self.gains is not None and self.belts is not None else 0)

    def shown_voltages(self, modes: Modes, s: ComplexArray) -> tuple[Gain, ...]:
        """Return those of its layers and what it reads per unit (V, W, U), and 0 for what it gives, which is no matter of it alone.

        Under belts that of its charge comes before what it reads.
        """
        found, read = tuple(gain.columns for gain in self.potential_gains(modes)), self.sensor_gain(modes).columns
        if self.gains is None:
            return found
        held = () if self.belts is None else (self.charge_voltage(modes).columns,)
        return (*found, *held, read, read.times(0.0))

    @property
    def capacitance(self) -> float:
        """The sum of mu33~/t of all actuators."""
        return sum(held for _, held in self.charges(Modes(np.zeros(1))))

    def charge_voltage(self, modes: Modes) -> Gain:
        """Return the charge that strain brings to all actuators together, over their capacitance, per unit (V, W, U), V."""
        each = [gain for gain, _ in self.charges(modes)]
        if not each:  # it has no actuators
            return Gain(np.zeros_like(modes.orders), np.zeros_like(modes.orders))
        v, w = (np.sum([getattr(one, name) for one in each], axis=0) / self.capacitance for name in ("v", "w"))
        along = [one.u for one in each if one.u is not None]
        return Gain(v, w, np.sum(along, axis=0) / self.capacitance if along else None)

    def _size(self, modes: Modes) -> FloatArray:
        """Return |P| times the sum of |k||S| of all that it reads, over M, of each order."""
        own = [Read(0, 1.0, self)] if self.reads is None else self.reads
        read = sum((abs(one.factor) * length_of(one.wall.sensor_gain(modes)) for one in own), np.zeros_like(modes.orders))
        return np.asarray(length_of(self.drive(modes)) * read / self.mass)

    def _spread(self, modes: Modes) -> FloatArray:
        """Return the most that an order is fed back to itself, over M."""
        return self._size(modes)

    def _feedback_size(self, modes: Modes) -> FloatArray:
        """Return that, times the weight that the law gives each order; 0 without feedback."""
        if self.gains is None:
            return np.zeros_like(modes.orders)
        return np.asarray(self._spread(modes) * np.abs(self.gains.weight(modes.orders)))


@dataclass(frozen=True, kw_only=True)
class LossyTiedWall(TiedWall, LossyElectrodedWall):
    """A wall of thin layers, of which some have losses, between electrodes that are driven by what any wall reads."""
