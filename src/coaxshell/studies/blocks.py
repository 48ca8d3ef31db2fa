"""Blocks of a run in three dimensions: worked on where an execution says, and kept if it has a store."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial

from coaxshell.errors import InputError
from coaxshell.numerics.progress import ShareDone
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

    def __call__(self, work: partial[Found], blocks: list[slice], tell: ShareDone | None = None) -> Iterator[Found]:
        """Yield what is found at each block, in their order; InputError if whoever works on one dies again and again."""
        kept = {block.start for block in blocks if self.store is not None and _key(work, block) in self.store}
        ready: dict[int, Found] = {}
        wanting = [block for block in blocks if block.start not in kept]
        fresh = self._fresh(work, wanting, _of_whole(tell, len(wanting) / len(blocks)))
        for block in blocks:
            if block.start in kept:
                yield self._read(work, block)
                continue
            while block.start not in ready:
                done, found = next(fresh)
                ready[done.start] = found
            yield ready.pop(block.start)
        if tell is not None:
            tell(1.0)

    def _fresh(self, work: partial[Found], blocks: list[slice], tell: ShareDone | None) -> Iterator[tuple[slice, Found]]:
        """Yield blocks that are worked on now, as they are done, and keep them."""
        for block, result in self._worked_on(work, blocks, tell):
            if isinstance(result, WorkerDiedError) or type(result).__name__ == "KilledWorker":  # Dask's word for it
                raise InputError("execution", f"a block of Laplace nodes cannot be solved: {result}", "use fewer workers, or more memory")
            if isinstance(result, Exception):
                raise result
            self._keep(work, block, result)
            yield block, result

    def _worked_on(self, work: partial[Found], blocks: list[slice], tell: ShareDone | None) -> Iterator[tuple[slice, Found | Exception]]:
        if self.executor is None and self.workers is None:
            yield from zip(blocks, on_threads(work, blocks, tell), strict=True)
            return
        # From another process nothing is heard of a block until it is done.
        results = completed(blocks, partial(alike, work), executor=self.executor, workers=self.workers)
        for done, each in enumerate(results, start=1):
            yield each
            if tell is not None:
                tell(done / len(blocks))

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


def _of_whole(tell: ShareDone | None, part: float) -> ShareDone | None:
    """Return what tells how far the whole is when a part of it, the last one, is so far."""
    return None if tell is None else lambda share: tell(1.0 - part * (1.0 - share))


def _key(work: partial[Found], block: slice) -> str:
    return f"{work.func.__name__}-{block.start}-{block.stop}"
