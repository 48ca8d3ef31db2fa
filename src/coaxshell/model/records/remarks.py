"""What a reader of a record should know before trusting an answer to it: where it is cut off, absurd magnitudes, a baseline left."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.model.prefixes import engineering

if TYPE_CHECKING:
    from coaxshell.model.pulses import Sampled

CUT_OFF = 0.1
"""Share of the peak that the last sample may have."""
BASELINE = 0.02
"""Share of the peak that the mean before the trigger may have."""
LONGEST, SHORTEST = 60.0, 1e-7
"""Seconds of a pressure record."""
LEAST, MOST = 1.0, 1e10
"""Pascals of its peak."""


def remarks(record: Sampled) -> tuple[str, ...]:
    """Return the remarks on a record, each with its numbers and what to do."""
    time, pressure = record.curve
    peak = float(np.abs(pressure).max())
    if peak == 0:
        return ("the record is zero throughout",)
    return tuple(text for text in (*_magnitudes(time[-1], peak), _cut_off(pressure, peak), _before(record, peak)) if text)


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


def _cut_off(pressure: np.ndarray, peak: float) -> str:
    share = abs(float(pressure[-1])) / peak
    if share <= CUT_OFF:
        return ""
    return (
        f"the record stops at {100 * share:.0f} % of its peak (above {100 * CUT_OFF:.0f} %) and drops to zero there at once; "
        "taper its end, or use a longer one"
    )


def _before(record: Sampled, peak: float) -> str:
    """Tell of samples before t = 0: those left out, if they hold more than noise, or a baseline that they show."""
    time = np.asarray(record.time)
    shift = record.shift if record.shift is not None else -record.start if record.start is not None else 0.0
    before = time + shift < 0
    if record.start is not None or not before.any():
        return ""
    values = record.scale * np.asarray(record.pressure)[before] - record.offset
    largest, mean = float(np.abs(values - values.mean()).max()), float(values.mean())
    if record.baseline is None and abs(mean) > BASELINE * peak:
        text = f"before t = 0 the record stands at {engineering(mean, 'Pa')}, {100 * abs(mean) / peak:.0f} % of its peak"
        return f'{text}; remove its baseline ("pre-trigger")'
    if largest > CUT_OFF * peak:
        return (
            f"{before.sum()} samples before t = 0 are left out, which reach {engineering(largest, 'Pa')}, "
            f"{100 * largest / peak:.0f} % of the peak; start = {time[0]:g} keeps them"
        )
    return ""
