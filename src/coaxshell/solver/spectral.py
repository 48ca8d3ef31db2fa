"""How the spectral engine works: nodes of the Laplace grid by blocks that stay in the processor's cache, on all threads.

NumPy releases the interpreter lock, so that several blocks are solved at a time.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from itertools import pairwise

import numpy as np

from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.numerics.threads import map_on_threads

# A block of complex numbers of this many order-node pairs is 1 MB, small enough that a dozen of them share a cache.
_BLOCK_ELEMENTS = 64 * 1024


def node_blocks(grid: LaplaceGrid, max_order: int) -> list[slice]:
    """Return consecutive slices of the Laplace nodes, each of about the same size."""
    count = grid.nodes.size
    width = max(64, _BLOCK_ELEMENTS // (max_order + 1))
    blocks = max(min(2, count // 64), round(count / width), 1)  # of short runs two, that two threads have something to do
    edges = np.linspace(0, count, blocks + 1).astype(int)
    return [slice(int(a), int(b)) for a, b in pairwise(edges)]


def map_node_blocks(blocks: list[slice], work: Callable[[slice], None], progress: Progress | None, stage: str) -> None:
    """Run ``work`` on every block on all threads, telling the progress after each."""
    for done, _ in enumerate(map_on_threads(work, blocks), start=1):
        if progress is not None:
            progress(done / len(blocks), stage)


class Stopwatch:
    """Seconds by stage, in the order in which the stages ended; added to those of earlier ones if given."""

    def __init__(self, seconds: dict[str, float] | None = None) -> None:
        self.seconds: dict[str, float] = {} if seconds is None else seconds
        self._last = time.perf_counter()

    def lap(self, stage: str) -> None:
        """Book the time since the last lap on ``stage``."""
        now = time.perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - self._last
        self._last = now
