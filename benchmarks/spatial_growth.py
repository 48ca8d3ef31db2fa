"""How the cost of a run in three dimensions grows with M and k_max, with either alone, with T, the steps in it and the stations.

Processor seconds of the paper's bare double shell, which other work on the machine disturbs less than the clock: the median of some turns,
and the exponent of the last step.
"""

from __future__ import annotations

import statistics
import sys
import time
import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

import coaxshell as cx
from benchmarks.measure import exponent

BASE: Mapping[str, Any] = {"modes": 32, "axial_modes": 32.0, "time_step": 1e-2, "duration": 3.0, "stations": (0.0,), "dimensions": 3}
GROWTH: Mapping[str, tuple[tuple[float, ...], Callable[[float], dict[str, Any]]]] = {
    "M = k_max": ((16, 32, 64), lambda n: {"modes": int(n), "axial_modes": n}),
    "M alone": ((16, 32, 64), lambda n: {"modes": int(n)}),
    "k_max alone": ((16, 32, 64), lambda n: {"axial_modes": n}),
    "T": ((1.5, 3, 6), lambda n: {"duration": n}),
    "steps in T": ((150, 300, 600), lambda n: {"time_step": BASE["duration"] / n}),
    "stations": ((1, 4, 16, 64), lambda n: {"stations": tuple(np.linspace(0.0, 1.0, int(n)))}),
}
"""What grows: its values, and the settings that they make."""


def seconds(settings: Mapping[str, Any]) -> tuple[float, int]:
    """Return the processor time of a run, and its axial wavenumbers."""
    start = time.process_time()
    found = cx.simulate("bare", **{**BASE, **settings})
    return time.process_time() - start, len(found.spatial.sampling.modes)


def main(turns: int = 3) -> None:
    """Print a row for everything that grows."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cx.PhysicsWarning)
        seconds({"modes": 4, "axial_modes": 4.0})  # what the first run of a process makes
        for name, (values, of) in GROWTH.items():
            taken = [[seconds(of(value)) for _ in range(turns)] for value in values]
            medians = [statistics.median(one for one, _ in each) for each in taken]
            told = ", ".join(f"{v:g}: {s:.2f} s ({each[0][1]})" for v, s, each in zip(values, medians, taken, strict=True))
            print(f"{name}: {told}; exponent {exponent(values[-2:], medians[-2:]):.2f}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
