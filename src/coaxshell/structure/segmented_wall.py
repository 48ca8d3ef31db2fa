"""A thin wall between electrodes that are cut into segments (:mod:`coaxshell.structure.segments`).

A loop from segment to segment feeds orders back to others: it is no part of what one order of the wall is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.structure.segments import Segments
from coaxshell.structure.tied_wall import LossyTiedWall, TiedWall


@dataclass(frozen=True, kw_only=True)
class SegmentedWall(TiedWall):
    """A wall of thin layers between segments of electrodes.

    Attributes
    ----------
    segments : Segments
    """

    segments: Segments

    @property
    def electrode_segments(self) -> Segments | None:
        """Segments of its electrodes."""
        return self.segments

    def _spread(self, modes: Modes) -> FloatArray:
        """Return the sum of r_m |P| |S|/M over all orders of the pattern of each order."""
        orders = np.arange(0.0, modes.orders.max() + 1.0)
        total = self.segments.loop_shares(orders, 1) @ self._size(Modes(orders, modes.wavenumber))
        pattern = np.abs(modes.orders - self.segments.count * np.rint(modes.orders / self.segments.count))
        return np.asarray(total[pattern.astype(int)])


@dataclass(frozen=True, kw_only=True)
class LossySegmentedWall(SegmentedWall, LossyTiedWall):
    """A wall of thin layers between segments of electrodes, of which some have losses."""
