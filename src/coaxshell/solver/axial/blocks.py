"""Blocks of Laplace nodes, independent of each other: what is shared out among threads, processes or machines.

What is found at a block are arrays by name, so that whoever maps the blocks can send and keep them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor, wait
from contextlib import AbstractContextManager
from functools import partial
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress, ShareDone, heard_by
from coaxshell.numerics.threads import WORKERS

BLOCK_NODES = 600
"""Nodes of a block: NumPy lets other threads run only beside its loops of more than 500 numbers, and those over nodes are the shortest."""
_LOOK_SECONDS = 0.1
"""How often it is told how far the threads are."""

Found = dict[str, npt.NDArray[Any]]
"""Arrays by name."""
Work = Callable[[slice], Found]


class BlockMap(Protocol):
    """Gives what a function makes of each block, in the order of the blocks: on threads, or in processes of one or many machines.

    Work is a ``functools.partial`` of a function that a module has at its top, so that it can be sent; its name says what is found.
    """

    def __call__(self, work: partial[Found], blocks: list[slice], tell: ShareDone | None = None) -> Iterable[Found]:
        """Return the results as they are needed; *tell* is told the share of all work done, and may raise to end it."""
        ...


class Workplace(Protocol):
    """Where runs in three dimensions have their blocks worked on: :class:`coaxshell.Execution` is one."""

    @property
    def progress(self) -> Progress | None:
        """Whom to tell of progress."""
        ...

    def mapping(self, run: Mapping[str, Any]) -> AbstractContextManager[BlockMap]:
        """Return the map of the blocks of a run, told from others by plain data."""
        ...


def on_threads(work: partial[Found], blocks: list[slice], tell: ShareDone | None = None) -> Iterator[Found]:
    """Map blocks on all cores of this machine; nothing works on when the results are no longer wanted."""
    tally = _Tally(len(blocks))
    with one_blas_thread(), ThreadPoolExecutor(WORKERS) as pool:  # here: BLAS heeds one thread of a process alone, the first that tells it
        waiting = deque(pool.submit(tally.carried_out, work, number, block) for number, block in enumerate(blocks))
        try:
            while waiting:
                while wait([waiting[0]], None if tell is None else _LOOK_SECONDS).not_done:
                    tally.told(tell)
                yield waiting.popleft().result()
                tally.told(tell)  # after whoever keeps it has had it
        finally:
            tally.wanted = False
            for one in waiting:
                one.cancel()


class _UnwantedError(BaseException):
    """The results of a block are no longer wanted."""


class _Tally:
    """How far each of some blocks is, and whether they are wanted: blocks hear that they are not when they next tell how far they are."""

    def __init__(self, count: int) -> None:
        self.shares, self.wanted = [0.0] * count, True

    def carried_out(self, work: Work, number: int, block: slice) -> Found:
        """Return what is found at a block, and keep count of it."""

        def hear(share: float) -> None:
            if not self.wanted:
                raise _UnwantedError
            self.shares[number] = share

        with heard_by(hear):
            found = alike(work, block)
        self.shares[number] = 1.0
        return found

    def told(self, tell: ShareDone | None) -> None:
        """Tell the share of all blocks that is done."""
        if tell is not None:
            tell(sum(self.shares) / len(self.shares))


def alike(work: Work, block: slice) -> Found:
    """Return what is found at a block, to the last bit the same wherever that is done: sums of BLAS depend on its number of threads."""
    with one_blas_thread():
        return work(block)


def node_blocks(grid: LaplaceGrid) -> list[slice]:
    """Return consecutive slices of the Laplace nodes, two at least, each of about the same size, the same on every machine."""
    count = grid.nodes.size
    edges = np.linspace(0, count, max(2, round(count / BLOCK_NODES)) + 1).astype(int)
    return [slice(int(a), int(b)) for a, b in pairwise(edges)]
