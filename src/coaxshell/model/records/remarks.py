"""What a reader of a record should know before trusting an answer to it: where it is cut off, absurd magnitudes, a baseline left."""

from __future__ import annotations

import numpy as np

from coaxshell.model.prefixes import engineering
from coaxshell.numerics.arrays import FloatArray

CUT_OFF = 0.1
"""Share of the peak that the last sample may have."""
BASELINE = 0.02
"""Share of the peak that the mean before the trigger may have."""
LONGEST, SHORTEST = 60.0, 1e-7
"""Seconds of a pressure record."""
LEAST, MOST = 1.0, 1e10
"""Pascals of its peak."""


def remarks(
    time: FloatArray,
    pressure: FloatArray,
    recorded_time: FloatArray,
    recorded: FloatArray,
    *,
    start: float | None,
    shift: float | None,
    baseline: bool,
) -> tuple[str, ...]:
    """Return the remarks on a record, each with its numbers and what to do.

    Parameters
    ----------
    time, pressure : ndarray, shape (N,)
        The history that it stands for (s, Pa).
    recorded_time, recorded : ndarray, shape (R,)
        Times and scaled pressures as they were read.
    start, shift : float, optional
        Options of the record.
    baseline : bool
        Whether its baseline is taken off.
    """
    peak = float(np.abs(pressure).max())
    if peak == 0:
        return ("the record is zero throughout",)
    before = recorded_time + (shift if shift is not None else 0.0) < 0
    left_out = recorded[before] if start is None else recorded[:0]
    told = _before(left_out, recorded_time[0], peak, baseline) if left_out.size else ""
    return tuple(text for text in (*_magnitudes(time[-1], peak), _cut_off(pressure, peak), told) if text)


def _magnitudes(end: float, peak: float) -> tuple[str, ...]:
    unit = "; is its unit right? give time_unit"
    found = []
    if end > LONGEST:
        found.append(f"the record lasts {end:.4g} s, longer than any shock (above {LONGEST:g} s){unit}")
    if end < SHORTEST:
        found.append(f"the record lasts {end:.4g} s only (below {SHORTEST:g} s){unit}")
    unit = unit.replace("time_unit", "pressure_unit or scale")
    if peak < LEAST:
        found.append(f"the peak is {peak:.4g} Pa, less than any gauge of shocks tells (below {LEAST:g} Pa){unit}")
    if peak > MOST:
        found.append(f"the peak is {peak:.4g} Pa, beyond any acoustic pulse (above {MOST:g} Pa){unit}")
    return tuple(found)


def _cut_off(pressure: FloatArray, peak: float) -> str:
    share = abs(float(pressure[-1])) / peak
    if share <= CUT_OFF:
        return ""
    return (
        f"the record stops at {100 * share:.0f} % of its peak (above {100 * CUT_OFF:.0f} %) and drops to zero there at once; "
        "taper its end, or use a longer one"
    )


def _before(values: FloatArray, first: float, peak: float, baseline: bool) -> str:
    """Tell of samples before t = 0: those left out, if they hold more than noise, or a baseline that they show."""
    largest, mean = float(np.abs(values - values.mean()).max()), float(values.mean())
    if not baseline and abs(mean) > BASELINE * peak:
        text = f"before t = 0 the record stands at {engineering(mean, 'Pa')}, {100 * abs(mean) / peak:.0f} % of its peak"
        return f'{text}; remove its baseline ("pre-trigger")'
    if largest > CUT_OFF * peak:
        return (
            f"{values.size} samples before t = 0 are left out, which reach {engineering(largest, 'Pa')}, "
            f"{100 * largest / peak:.0f} % of the peak; start = {first:g} keeps them"
        )
    return ""
