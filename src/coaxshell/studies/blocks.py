"""Blocks of a run in three dimensions: worked on where an execution says, and kept if it has a store."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial

from coaxshell.errors import InputError
from coaxshell.solver.axial.blocks import Found, alike, on_threads
from coaxshell.studies.executors import WorkerDiedError, completed
from coaxshell.studies.store import Store


@dataclass(frozen=True)
class BlocksSharedOut:
    """A map of blocks, see :class:`coaxshell.solver.axial.blocks.BlockMap`.

    Attributes
    ----------
    executor : concurrent.futures.Executor, optional
    workers : int, optional
        Processes of a pool of our own; with neither, threads of this process.
    store : Store, optional
        Where finished blocks are kept, and looked for first.
    """

    executor: Executor | None = None
    workers: int | None = None
    store: Store | None = None

    def __call__(self, work: partial[Found], blocks: list[slice]) -> Iterator[Found]:
        """Yield what is found at each block, in their order; InputError if whoever works on one dies again and again."""
        kept = {block.start for block in blocks if self.store is not None and _key(work, block) in self.store}
        ready: dict[int, Found] = {}
        fresh = iter(self._fresh(work, [block for block in blocks if block.start not in kept]))
        for block in blocks:
            if block.start in kept:
                yield self._read(work, block)
                continue
            while block.start not in ready:
                done, found = next(fresh)
                ready[done.start] = found
            yield ready.pop(block.start)

    def _fresh(self, work: partial[Found], blocks: list[slice]) -> Iterator[tuple[slice, Found]]:
        """Yield blocks that are worked on now, as they are done, and keep them."""
        for block, result in self._worked_on(work, blocks):
            if isinstance(result, WorkerDiedError) or type(result).__name__ == "KilledWorker":  # Dask's word for it
                raise InputError("execution", f"a block of Laplace nodes cannot be solved: {result}", "use fewer workers, or more memory")
            if isinstance(result, Exception):
                raise result
            self._keep(work, block, result)
            yield block, result

    def _worked_on(self, work: partial[Found], blocks: list[slice]) -> Iterable[tuple[slice, Found | Exception]]:
        if self.executor is None and self.workers is None:
            return zip(blocks, on_threads(work, blocks), strict=True)
        return completed(blocks, partial(alike, work), executor=self.executor, workers=self.workers)

    def _keep(self, work: partial[Found], block: slice, found: Found) -> None:
        if self.store is not None:
            self.store.put(_key(work, block), found, {})

    def _read(self, work: partial[Found], block: slice) -> Found:
        """Return what is kept of a block; it is worked on again if a power cut left half of it."""
        kept = None if self.store is None else self.store.get(_key(work, block))
        if kept is not None:
            return kept[0]
        found = alike(work, block)
        self._keep(work, block, found)
        return found


def _key(work: partial[Found], block: slice) -> str:
    return f"{work.func.__name__}-{block.start}-{block.stop}"
