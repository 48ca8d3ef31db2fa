"""How a study, or a run in three dimensions, is worked on: one holder for calls and commands; nothing of it changes a number."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import Any

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.system import System
from coaxshell.numerics.progress import Progress
from coaxshell.solver.axial.blocks import BlockMap
from coaxshell.solver.settings import Settings, SettingsKeywords, whole
from coaxshell.studies.blocks import BlocksSharedOut
from coaxshell.studies.executors import MAX_WORKERS, capacity, dask_executor
from coaxshell.studies.metrics import Metric
from coaxshell.studies.store import StudyStore


@dataclass(frozen=True)
class Execution:
    """How a study is worked on: case by case; or a single run in three dimensions: block by block of its Laplace nodes.

    Attributes
    ----------
    executor : concurrent.futures.Executor, optional
        Where the work is done; a pool of processes of our own otherwise.
    workers : int, optional
        Processes of that pool, one a core by default; 1 works in this process. A single run takes threads of this process by default.
    store : str or Path, optional
        Folder in which every finished case or block is kept; safe to kill at any moment, safe for several writers.
    resume : bool
        Go on with what the store holds.
    progress : callable, optional
        Called with the fraction done and a word.
    dask : str, optional
        Address of the scheduler of a Dask cluster where the work is done, as ``tcp://10.0.0.1:8786``.

    Raises
    ------
    InputError
        No number of processes, or two places to work at.
    """

    executor: Executor | None = None
    workers: int | None = None
    store: str | Path | None = None
    resume: bool = False
    progress: Progress | None = None
    dask: str | None = None

    def __post_init__(self) -> None:
        if self.workers is not None:
            object.__setattr__(self, "workers", whole("workers", self.workers, MAX_WORKERS))
        for name in ("workers", "executor") if self.dask is not None else ():
            if getattr(self, name) is not None:
                raise InputError(name, "has no effect beside dask, whose cluster has its own", "give one or the other")

    @property
    def capacity(self) -> int:
        """How many cases can be in work at a time."""
        return capacity(self.executor, self.workers)

    def opened(self, parts: Mapping[str, Any], metrics: Sequence[Metric], where: str = "store") -> StudyStore | None:
        """Return the store of a study, told from others by its *parts*; None if nothing is to be kept. Errors call it *where*."""
        return None if self.store is None else StudyStore(Path(self.store), parts, metrics, resume=self.resume, where=where)

    @contextmanager
    def mapping(self, run: Mapping[str, Any]) -> Iterator[BlockMap]:
        """Yield the map of the blocks of a run in three dimensions, told from others by the parts of *run*.

        In this process on all of its cores, unless there are an executor, workers or a cluster; with a store finished blocks are kept.
        """
        store = self.opened(run, ())
        with self.started() as ready:
            yield BlocksSharedOut(ready.executor, ready.workers, store)

    @contextmanager
    def started(self) -> Iterator[Execution]:
        """Yield it with its cluster, if there is one, reached and in the place of an executor; InputError if nobody answers."""
        if self.dask is None:
            yield self
            return
        with dask_executor(self.dask) as executor:
            yield replace(self, executor=executor, dask=None)


class StudyKeywords(SettingsKeywords, total=False):
    """The keywords of every study: the settings of its runs, how it is worked on, and an *execution* that the latter change."""

    executor: Executor | None
    workers: int | None
    store: str | Path | None
    resume: bool
    progress: Progress | None
    dask: str | None
    execution: Execution | None


_NAMES = tuple(field.name for field in fields(Execution))


def asked(system: System, keywords: Mapping[str, Any]) -> tuple[Settings, Execution]:
    """Return what the keywords of a study ask for, see :class:`StudyKeywords`; errors as of :meth:`Settings.asked`, and of Execution."""
    of_work = {name: keywords[name] for name in _NAMES if name in keywords}
    of_runs = {name: value for name, value in keywords.items() if name not in (*_NAMES, "execution")}
    base = keywords.get("execution") or Execution()
    if not isinstance(base, Execution):
        raise InputError("execution", f"{shown(base)} is not an Execution", "give one such as Execution(workers=2)")
    return Settings.asked(system, of_runs), replace(base, **of_work)
