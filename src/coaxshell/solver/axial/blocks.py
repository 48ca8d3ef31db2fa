"""Blocks of Laplace nodes, independent of each other: what is shared out among threads, processes or machines."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from typing import Protocol, TypeVar

import numpy as np

from coaxshell.numerics.laplace_grid import WORKERS, LaplaceGrid

_BLOCK_ELEMENTS = 8 * 1024
"""Order-node pairs of a block, 128 kB a complex array: a few dozen of them stay in a processor's cache."""
_FEWEST = 32

Found = TypeVar("Found")


class BlockMap(Protocol):
    """Gives what a function makes of each block, in the order of the blocks: on threads, or in processes of one or many machines."""

    def __call__(self, work: Callable[[slice], Found], blocks: list[slice]) -> Iterable[Found]:
        """Return the results as they are needed."""
        ...


def on_threads(work: Callable[[slice], Found], blocks: list[slice]) -> Iterable[Found]:
    """Map blocks on all cores of this machine."""
    with ThreadPoolExecutor(WORKERS) as pool:
        yield from pool.map(work, blocks)


def node_blocks(grid: LaplaceGrid, max_order: int) -> list[slice]:
    """Return consecutive slices of the Laplace nodes, each of about the same size."""
    count = grid.nodes.size
    blocks = max(WORKERS, round(count / max(_FEWEST, _BLOCK_ELEMENTS // (max_order + 1))))
    edges = np.linspace(0, count, blocks + 1).astype(int)
    return [slice(int(a), int(b)) for a, b in pairwise(edges)]
