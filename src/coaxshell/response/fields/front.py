"""Pulses under the window of a band, so that incident fronts rise as the scattered ones do."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from coaxshell.acoustics.free_field import TimeFunction
from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.fields.band import window

_REACH = 12
"""Time steps of the band on either side of a front within which its window is felt."""
_FINER = 32
"""Points of the table per time step of the band."""
_PERIOD = 64
"""Reaches in the table's period: so many that its contour lies as close to the imaginary axis as the field's own."""


def banded(pulse: TimeFunction, band: LaplaceGrid) -> Callable[[FloatArray], FloatArray]:
    """Return the pulse under the band's window near its front, tabulated; elsewhere as it is, where the window changes nothing.

    The transform of the pulse, delayed by the reach so that what rises before the front is kept, is inverted on a grid 32 times finer.
    """
    reach = _REACH * band.time_step
    fine = LaplaceGrid(band.time_step / _FINER, _PERIOD * _REACH * _FINER, 1e-8)
    cut = np.interp(fine.nodes.imag, band.nodes.imag, window(band), right=0.0)
    table = fine.invert(pulse.transform(fine.nodes) * np.exp(-fine.nodes * reach), cut)

    def history(t: FloatArray) -> FloatArray:
        result = pulse.history(t)
        near = np.abs(t) < reach
        result[near] = np.interp(t[near] + reach, fine.time, table)
        return result

    return history
