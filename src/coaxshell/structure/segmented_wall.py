"""A thin wall between electrodes that are cut into segments (:mod:`coaxshell.structure.segments`).

A loop from segment to segment feeds orders back to others: it is no part of what one order of the wall is. The wall itself is that without
feedback, whose driven layers are short-circuited; the solver closes the loops of all orders together
(:mod:`coaxshell.solver.segmented`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.electroded_wall import ElectrodedWall, LossyElectrodedWall
from coaxshell.structure.segments import Segments
from coaxshell.structure.shell_model import Leading, WallOperator


@dataclass(frozen=True, kw_only=True)
class SegmentedWall(ElectrodedWall):
    """A wall of thin layers between segments of electrodes.

    Attributes
    ----------
    segments : Segments
    """

    segments: Segments

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
        """Return the membrane frequency of each order, with what feedback stiffens the pattern of it by."""
        if self.gains is None:
            return super().highest_frequency(modes)
        alone = self.open.highest_frequency(modes)
        stiffening = np.maximum(self.gains.stiffening(modes.orders, alone), 0.0)
        return np.asarray(np.sqrt(alone**2 + stiffening * self._spread(modes)))

    def _spread(self, modes: Modes) -> FloatArray:
        """Return the sum of r_m |P||S|/M over all orders of the pattern of each order."""
        orders = np.arange(0.0, modes.orders.max() + 1.0)
        every = Modes(orders)
        size = np.hypot(*self.drive(every)[:2]) * np.hypot(*self.sensor_gain(every)[:2]) / self.mass
        total = self.segments.loop_shares(orders, 1) @ size
        pattern = np.abs(modes.orders - self.segments.count * np.rint(modes.orders / self.segments.count))
        return np.asarray(total[pattern.astype(int)])

    def _feedback_size(self, modes: Modes) -> FloatArray:
        """Return the sum over the orders of a pattern, of each order, times the weight that the law gives it; 0 without feedback."""
        if self.gains is None:
            return np.zeros_like(modes.orders)
        return np.asarray(self._spread(modes) * np.abs(self.gains.weight(modes.orders)))


@dataclass(frozen=True, kw_only=True)
class LossySegmentedWall(SegmentedWall, LossyElectrodedWall):
    """A wall of thin layers between segments of electrodes, of which some have losses."""
