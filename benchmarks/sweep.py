"""Absorber sweeps: cases per second on one prepared structure, and what a second worker brings, the two taking turns.

The paper's hybrid structure at M = 60, dt = 4e-3, T = 5. Throughput is that of a pool that is already warm, kernels included.
"""

from __future__ import annotations

import statistics
import time

import coaxshell as cx
from coaxshell.studies.evaluation import Batch, Case, batches, evaluate
from coaxshell.studies.executors import process_pool
from coaxshell.studies.metrics import metrics_of
from coaxshell.studies.paths import varied
from coaxshell.studies.resolution import Resolution
from coaxshell.studies.running import run_cases

RESOLUTION = Resolution(duration=5.0, time_step=4e-3, modes=60)
ASKED = ["inner.peak_stress", "inner.rms_stress", "absorbers.mass"]
CASES = 32
TURNS = 3


def planned(workers: int) -> list[Batch]:
    """Return the sweep's batches."""
    base = cx.presets.load("hybrid")
    cases = [Case(i, varied(base, {"absorbers.mass": 5.0 + 0.1 * i})) for i in range(CASES)]
    return batches(cases, metrics_of(ASKED, base), RESOLUTION, workers)


def seconds_of(workers: int) -> float:
    """Return the time of the whole sweep with a warm pool of so many workers."""
    base = cx.presets.load("hybrid")
    systems = [varied(base, {"absorbers.mass": 5.0 + 0.1 * i}) for i in range(CASES)]
    metrics = metrics_of(ASKED, base)
    with process_pool(workers) as pool:
        list(pool.map(evaluate, planned(workers)[: 2 * workers]))
        start = time.perf_counter()
        run_cases(systems, metrics, RESOLUTION, executor=pool)
        return time.perf_counter() - start


def main() -> None:
    """Print cases per second with one and with two workers, and the ratio of turns side by side."""
    ratios, one, two = [], [], []
    for _ in range(TURNS):
        one.append(seconds_of(1))
        two.append(seconds_of(2))
        ratios.append(one[-1] / two[-1])
    for name, seconds in (("one worker", one), ("two workers", two)):
        print(
            f"absorber sweep of {CASES} cases, N = 25, M = 60, dt = 4e-3, T = 5, {name}: {CASES / statistics.median(seconds):.1f} cases/s"
        )
    print(f"two workers over one: {statistics.median(ratios):.2f} (turns: {', '.join(f'{ratio:.2f}' for ratio in ratios)})")


if __name__ == "__main__":
    main()
