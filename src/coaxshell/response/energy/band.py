"""How much of the spectrum and how many radii the energy of a fluid region needs.

Waves of phase h across the region (frequency times slowness times width) make an energy density with 2 h/(2 pi) periods, which
h/2 Gauss points integrate. Nearly all the energy lies far below the highest frequency, so the whole band would be a waste. The field is
kept up to the frequency above which a part NEGLIGIBLE of the walls' kinetic energy lies, with a roll-off around it: what is left
out meets what is kept only within the roll-off, so the energy loses a part of about that size. Full resolution is given to
frequencies up to the one above which a part FAINT lies, half as much to the rest.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.energy.motion import Motion

NEGLIGIBLE, FAINT = 4e-7, 1e-5

MAX_RADII = 500

_FULL, _NONE = 0.9, 1.2
"""The roll-off begins and ends at these multiples of the frequency."""


class Band(NamedTuple):
    """What is kept of the spectrum in one region.

    Attributes
    ----------
    window : ndarray, shape (nodes kept,)
        Weights of the lowest nodes of the grid; all but the first count double, for their conjugates.
    highest, strong : float
        Frequencies at which the window ends and above which a part FAINT of the walls' energy lies.
    """

    window: FloatArray
    highest: float
    strong: float


def band_of(motion: Motion, walls: tuple[int, ...]) -> Band:
    """Return the band for the field between the given walls."""
    grid = motion.grid
    taper, step = grid.taper(), grid.frequency_step
    needed = strong = 1
    for wall in walls:
        power = np.einsum("m,hmk->k", motion.circle, np.abs(motion.normal_velocity[wall]) ** 2) * taper**2
        above = np.cumsum(power[::-1])[::-1]
        needed = max(needed, int(np.count_nonzero(above > NEGLIGIBLE * above[0])))
        strong = max(strong, int(np.count_nonzero(above > FAINT * above[0])))
    position = (np.arange(taper.size) / needed - _FULL) / (_NONE - _FULL)
    kept = max(2, int(np.count_nonzero(position < 1.0)))
    window: FloatArray = taper[:kept] * np.cos(0.5 * np.pi * np.clip(position[:kept], 0.0, 1.0)) ** 2
    window[1:] *= 2.0
    return Band(window, kept * step, strong * step)


def radii_needed(band: Band, phase: float, orders: int) -> int:
    """Return the number of Gauss points in a region *phase* wide (slowness times width) for modes r^m up to m = orders - 1."""
    waves = max(0.25 * band.highest, 0.45 * band.strong) * phase
    return min(MAX_RADII, int(12 + 2.0 * math.sqrt(orders) + waves))
