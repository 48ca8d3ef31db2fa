"""What engineers read by frequency: shock spectra, answers at given frequencies, natural frequencies. Processor time, medians of turns."""

from __future__ import annotations

import statistics
import time
import warnings
from collections.abc import Callable

import numpy as np

import coaxshell as cx
from coaxshell.numerics.blas_threads import one_blas_thread

TURNS = 5
FREQUENCIES = np.linspace(10.0, 2000.0, 2000)
ANGLES = np.arange(360.0)


def timed(work: Callable[[], object]) -> float:
    """Return the processor time of some work, s, the median of turns after a first one."""
    found = []
    for turn in range(TURNS + 1):
        start = time.process_time()
        work()
        if turn:
            found.append(time.process_time() - start)
    return statistics.median(found)


def main() -> None:
    """Print the time of each."""
    with one_blas_thread(), warnings.catch_warnings():
        warnings.simplefilter("ignore", cx.PhysicsWarning)
        run = cx.simulate("bare", duration=5.0, time_step=1e-3, modes=150)
        hertz = np.geomspace(50.0, 1e4, 200)
        of = timed(lambda: run.shock_spectrum("outer", ANGLES, hertz))
        print(f"shock spectra, 200 frequencies at 360 angles, 5000 instants: {of:.2f} s")
        for name in ("bare", "active", "hybrid", "coated"):
            of = timed(lambda name=name: cx.frequency_response(name, FREQUENCIES, "target_strength", modes=60))
            print(f"target strength of {name} at {FREQUENCIES.size} frequencies, M = 60: {of:.2f} s")
        print(f"natural frequencies of bare, orders 0 to 12, dry and wet: {timed(lambda: cx.natural_frequencies('bare')):.2f} s")


if __name__ == "__main__":
    main()
