"""The paper's bare double shell, M = 150, 5000 steps: time of one warm call, its parts, and peak memory."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

import coaxshell as cx
from benchmarks.measure import medians, peak_memory
from coaxshell.solver import spectral

CODE = "import coaxshell as cx; system = cx.presets.load('bare')"
SOLVE = "; cx.simulate(system).warnings"


class _UnitLoad:
    """Stand in for the sources: a load of 1 on every order, which costs nothing."""

    parities = 1

    def __init__(self, problem: object, grid: object, orders: np.ndarray) -> None:
        self._orders = orders

    def __call__(self, surface: object, nodes: slice) -> list[np.ndarray]:
        return [np.ones_like(surface.exterior)]


@contextmanager
def _without_loads() -> Iterator[None]:
    kept = spectral.SurfaceLoads
    spectral.SurfaceLoads = _UnitLoad
    try:
        yield
    finally:
        spectral.SurfaceLoads = kept


def main() -> None:
    """Print the medians."""
    system = cx.presets.load("bare")

    def judged() -> dict[str, float]:
        response = cx.simulate(system)
        response.errors()  # estimated when read
        return response.timings

    def without_loads() -> None:
        with _without_loads():
            judged()

    full, unloaded = medians([judged, without_loads])
    print(f"bare, M = 150, 5000 steps: {full:.3f} s (median of 9 warm calls)")
    print(f"  of these the incident wave's modal loads: {full - unloaded:.3f} s, {100 * (full - unloaded) / full:.0f} %")
    timings = judged()
    total = sum(timings.values())
    for stage, seconds in timings.items():
        print(f"  {stage}: {100 * seconds / total:.0f} %")
    idle, solved = peak_memory(CODE + "; cx.simulate"), peak_memory(CODE + SOLVE)
    print(f"  peak memory of a fresh process: {solved:.0f} MiB, {solved - idle:.0f} MiB of them above the imports")


if __name__ == "__main__":
    main()
