"""Absorber sweeps: cases per second on one prepared structure, and what a second worker brings, the two taking turns.

The paper's hybrid structure at M = 60, dt = 4e-3, T = 5. Throughput is that of a pool that is already warm, kernels included.
"""

from __future__ import annotations

import statistics
import time

import coaxshell as cx
from coaxshell.solver.settings import Settings
from coaxshell.studies import Execution
from coaxshell.studies.evaluation import Batch, Case, batches, evaluate
from coaxshell.studies.executors import process_pool
from coaxshell.studies.metrics import metrics_of
from coaxshell.studies.running import run_cases
from coaxshell.studies.varied_fields import varied

RESOLUTION = Settings(duration=5.0, time_step=4e-3, modes=60)
ASKED = ["inner.peak_stress", "inner.rms_stress", "absorbers.mass"]
CASES = 32
TURNS = 3


def planned(workers: int) -> list[Batch]:
    """Return the sweep's batches."""
    base = cx.presets.load("hybrid")
    cases = [Case(i, varied(base, {"absorbers.mass": 5.0 + 0.1 * i})) for i in range(CASES)]
    return batches(cases, metrics_of(ASKED, base), RESOLUTION, workers)


def timed(batch: Batch) -> tuple[int, float]:
    """Return the number of cases of a batch and the processor time that they took."""
    start = time.process_time()
    return len(evaluate(batch)), time.process_time() - start


def processor_seconds(workers: int) -> float:
    """Return the processor time a case with so many workers at once: free of what else the machine does, but for shared caches."""
    with process_pool(workers) as pool:
        list(pool.map(evaluate, planned(workers)[: 2 * workers]))
        done = list(pool.map(timed, planned(workers)))
    return sum(seconds for _, seconds in done) / sum(count for count, _ in done)


def seconds_of(workers: int) -> float:
    """Return the time of the whole sweep with a warm pool of so many workers."""
    base = cx.presets.load("hybrid")
    systems = [varied(base, {"absorbers.mass": 5.0 + 0.1 * i}) for i in range(CASES)]
    metrics = metrics_of(ASKED, base)
    with process_pool(workers) as pool:
        list(pool.map(evaluate, planned(workers)[: 2 * workers]))
        start = time.perf_counter()
        run_cases(systems, metrics, RESOLUTION, Execution(executor=pool))
        return time.perf_counter() - start


def main() -> None:
    """Print cases per second with one and with two workers, and the ratio of turns side by side."""
    ratios, one, two, share = [], [], [], []
    for _ in range(TURNS):
        one.append(seconds_of(1))
        two.append(seconds_of(2))
        ratios.append(one[-1] / two[-1])
        share.append([processor_seconds(1), processor_seconds(2)])
    for name, seconds in (("one worker", one), ("two workers", two)):
        print(
            f"absorber sweep of {CASES} cases, N = 25, M = 60, dt = 4e-3, T = 5, {name}: {CASES / statistics.median(seconds):.1f} cases/s"
        )
    alone, beside = (statistics.median(column) for column in zip(*share, strict=True))
    print(f"processor time a case: {alone:.3f} s with one worker, {beside:.3f} s with two")
    print(f"two workers over one: {statistics.median(ratios):.2f} (turns: {', '.join(f'{ratio:.2f}' for ratio in ratios)})")


if __name__ == "__main__":
    main()
