"""Worker processes, and who is served next: what a person waits for before what may take its time; studies have a process of their own.

Everything here runs in the event loop; only :func:`coaxshell.apps.studio.worker.perform` runs elsewhere.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import time
from collections import OrderedDict, deque
from collections.abc import Callable, Hashable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field
from itertools import count
from typing import Any

from coaxshell.apps.studio import limits, worker
from coaxshell.apps.studio.refusals import RefusedError
from coaxshell.errors import InputError

REMEMBERED = 4
"""Structures that a worker is taken to have at hand."""
NICENESS, STUDY_NICENESS = 5, 15
"""The page's own requests go first, and studies last."""
WATCHED_EVERY = 1.0
"""Seconds between two looks at a task that runs."""
_FEWER = "ask for fewer orders, a coarser time step or a shorter duration"


@dataclass(eq=False)
class Work:
    """A task that waits, runs or is done.

    Attributes
    ----------
    task, arguments
        What is called in the worker; it must be importable there.
    place : hashable
        The structure it needs; a worker that has it is preferred.
    live : bool
        A person waits for it.
    study : bool
        It may take many minutes, so that nothing else should wait for it.
    future : asyncio.Future
        Its value; InputError, RefusedError, or cancelled.
    """

    number: int
    task: Callable[..., Any]
    arguments: tuple[Any, ...]
    place: Hashable
    live: bool
    study: bool
    future: asyncio.Future[Any]
    process: _Process | None = None
    started: Callable[[], None] | None = None
    dropped: bool = False


@dataclass(eq=False)
class _Process:
    board: Any
    stage: Any
    executor: ProcessPoolExecutor
    study: bool = False
    work: Work | None = None
    since: float = field(default_factory=time.monotonic)
    recent: OrderedDict[Hashable, None] = field(default_factory=OrderedDict)

    @property
    def told(self) -> tuple[float, bytes]:
        """What the task last reported."""
        return float(self.board[worker.FRACTION]), bytes(self.stage.value)

    @property
    def grown(self) -> bool:
        """Whether it holds noticeably more memory than when it was new."""
        return bool(self.board[worker.HELD] > limits.REST_GROWTH * self.board[worker.FIRST] > 0)

    def kill(self) -> None:
        """End it at once, whatever it is at."""
        for child in list((self.executor._processes or {}).values()):
            child.kill()


class Workers:
    """A few worker processes with two queues; of more than one worker, one is always left for what is live.

    Studies wait in a queue of their own for a process of their own, started with the first of them, that gives way to all others.

    Parameters
    ----------
    processes : int
    """

    def __init__(self, processes: int = 2) -> None:
        self._context = multiprocessing.get_context("spawn")
        self._numbers = count(1)
        self._processes = [self._started() for _ in range(processes)]
        self._queues: dict[str, deque[Work]] = {"live": deque(), "jobs": deque(), "studies": deque()}
        self._tasks: set[asyncio.Task[None]] = set()
        self._closed = False

    def _started(self, study: bool = False) -> _Process:
        board, stage = self._context.RawArray("d", 4), self._context.RawArray("c", 64)
        executor = ProcessPoolExecutor(
            1, mp_context=self._context, initializer=worker.begin, initargs=(board, stage, STUDY_NICENESS if study else NICENESS)
        )
        executor.submit(worker.ready)
        return _Process(board, stage, executor, study)

    def submit(
        self,
        task: Callable[..., Any],
        *arguments: Any,
        place: Hashable = None,
        live: bool = True,
        study: bool = False,
        started: Callable[[], None] | None = None,
        instead_of: Work | None = None,
    ) -> Work:
        """Queue a task, in the place of another if that still waits; RefusedError when too many wait."""
        if self._closed:
            raise RefusedError(503, "closing", "server", "is ending", "start it again")
        queue = self._queues[_queue(live, study)]
        replaced = instead_of is not None and instead_of in queue
        if not replaced and len(queue) >= (limits.LIVE_WAITING if live else limits.JOBS_WAITING):
            raise RefusedError(429, "busy", "server", f"{len(queue)} tasks are waiting", "try again in a moment")
        work = Work(next(self._numbers), task, arguments, place, live, study, asyncio.get_running_loop().create_future(), started=started)
        if replaced and instead_of is not None:
            queue[queue.index(instead_of)] = work
            instead_of.future.cancel()
        else:
            queue.append(work)
        self._feed()
        return work

    def drop(self, work: Work) -> None:
        """Take a task out of its queue, or stop it at its next report."""
        work.dropped = True
        if work.process is not None:
            work.process.board[worker.STOP] = work.number
        elif work in (queue := self._queues[_queue(work.live, work.study)]):
            queue.remove(work)
            work.future.cancel()

    def progress(self, work: Work) -> tuple[float, str]:
        """Return fraction and stage of a task."""
        if work.process is None:
            return 0.0, "waiting"
        fraction, stage = work.process.told
        return fraction, stage.decode(errors="replace")

    def rest(self, seconds: float) -> bool:
        """Renew what has been idle for so long and has grown, since a process keeps memory that it has freed; tell whether all rest."""
        idle = [one for one in self._processes if one.work is None and time.monotonic() - one.since > seconds]
        for process in idle:
            if process.grown:
                self._renew(process, again=not process.study)
        return len(idle) == len(self._processes)

    def _renew(self, process: _Process, again: bool = True) -> None:
        """End a process that is at nothing, and start another in its place."""
        process.executor.shutdown(wait=False)
        if self._closed or process not in self._processes:
            return
        place = self._processes.index(process)
        self._processes[place : place + 1] = [self._started(process.study)] if again else []

    def _feed(self) -> None:
        if self._closed:
            return
        for queue in self._queues.values():
            while queue:
                process = self._free_for(queue[0])
                if process is None:
                    break
                work = queue.popleft()
                process.work, work.process = work, process
                task = asyncio.get_running_loop().create_task(self._carried_out(process, work))
                self._tasks.add(task)
                task.add_done_callback(self._tasks.discard)

    def _free_for(self, work: Work) -> _Process | None:
        if work.study and not any(process.study for process in self._processes):
            self._processes.append(self._started(study=True))
        mine = [process for process in self._processes if process.study == work.study]
        free = [process for process in mine if process.work is None]
        behind = sum(process.work is not None and not process.work.live for process in mine)
        if not free or (not work.live and behind >= max(1, len(mine) - 1)):
            return None
        return next((process for process in free if work.place in process.recent), free[0])

    async def _carried_out(self, process: _Process, work: Work) -> None:
        if work.started is not None:
            work.started()
        process.recent[work.place] = None
        process.recent.move_to_end(work.place)
        if len(process.recent) > REMEMBERED:
            process.recent.popitem(last=False)
        silent = False
        try:
            future = asyncio.wrap_future(process.executor.submit(worker.perform, work.number, work.task, work.arguments))
            silent = await _watched(process, work, future)
            outcome: worker.Outcome = await future
        except BrokenProcessPool:
            self._renew(process)
            if work.dropped:
                work.future.cancel()
            _settle(work, _lost(silent))
        except BaseException as error:
            if work.future.done():
                raise
            work.future.set_exception(error)
            if not isinstance(error, Exception):
                raise
        else:
            if outcome.state == "done" and not work.future.done():
                work.future.set_result(outcome.value)
            elif work.future.done():
                pass
            elif outcome.state == "input":
                _settle(work, InputError(*outcome.value))
            else:
                work.future.cancel()
        finally:
            process.work, process.since = None, time.monotonic()
            if process in self._processes and process.board[worker.HELD] > limits.WORKER_BYTES:
                self._renew(process)
            self._feed()

    def close(self) -> None:
        """Stop everything now; who waits is told."""
        self._closed = True
        waiting = [work for queue in self._queues.values() for work in queue]
        for work in [*waiting, *(process.work for process in self._processes if process.work is not None)]:
            _settle(work, RefusedError(503, "closing", "server", "is ending", "start it again"))
        for queue in self._queues.values():
            queue.clear()
        for process in self._processes:
            running = list((process.executor._processes or {}).values())
            process.executor.shutdown(wait=False, cancel_futures=True)
            for child in running:
                child.terminate()
            for child in running:
                child.join(2)


async def _watched(process: _Process, work: Work, future: asyncio.Future[Any]) -> bool:
    """Wait for a task; end its process, and return True, when it reports nothing for too long, or goes on long after it was dropped."""
    told, since, most = process.told, time.monotonic(), limits.SILENT_SECONDS
    while not future.done():
        await asyncio.wait([future], timeout=WATCHED_EVERY)
        if process.told != told:
            told, since = process.told, time.monotonic()
        if work.dropped and most > limits.DROPPED_SECONDS:
            since, most = time.monotonic(), limits.DROPPED_SECONDS
        if not future.done() and time.monotonic() - since > most:
            process.kill()
            await asyncio.wait([future])
            return True
    return False


def _queue(live: bool, study: bool) -> str:
    return "studies" if study else "live" if live else "jobs"


def _lost(silent: bool) -> InputError:
    if silent:
        return InputError("system", f"its solution made no progress for {limits.SILENT_SECONDS:g} s and was ended", _FEWER)
    return InputError("system", "the worker that solved it has died, most likely for want of memory", _FEWER)


def _settle(work: Work, error: Exception) -> None:
    if not work.future.done():
        work.future.set_exception(error)
