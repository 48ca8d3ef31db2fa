"""The paper's bare double shell in three dimensions, M = k_max = 60, 1250 steps, one station, against the same run in two.

Processor seconds, which other work on the machine disturbs less than the clock; the two take turns.
"""

from __future__ import annotations

import statistics
import time
import warnings

import coaxshell as cx

SETTINGS = {"modes": 60, "time_step": 4e-3, "duration": 5.0}
_TURNS, _SHORT = 3, 5
"""Turns, and runs in two dimensions in each."""


def processor_seconds(runs: int, dimensions: int) -> float:
    """Return the processor time of one of some runs."""
    start = time.process_time()
    for _ in range(runs):
        cx.simulate("bare", dimensions=dimensions, **SETTINGS)
    return (time.process_time() - start) / runs


def main() -> None:
    """Print the medians, and their ratio for each axial wavenumber."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cx.PhysicsWarning)
        waves = len(cx.simulate("bare", dimensions=3, **SETTINGS).spatial.sampling.modes)
        pairs = [(processor_seconds(_SHORT, 2), processor_seconds(1, 3)) for _ in range(_TURNS)]
    plane, spatial = (statistics.median(column) for column in zip(*pairs, strict=True))
    print(f"bare, M = k_max = 60, 1250 steps, {waves} axial wavenumbers: {spatial:.2f} s of processor time")
    print(f"  in two dimensions {plane:.3f} s: {spatial / plane:.0f} times, {spatial / plane / waves:.2f} of it for each wavenumber")


if __name__ == "__main__":
    main()
