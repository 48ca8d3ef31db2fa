"""Run independent tasks on any ``concurrent.futures.Executor``, Dask's too: results as they come, whatever becomes of the workers."""

from __future__ import annotations

import multiprocessing
import os
import platform
import signal
import sys
import threading
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, TypeVar

from coaxshell.errors import InputError
from coaxshell.numerics.identity import difference, environment
from coaxshell.solver.settings import whole

T = TypeVar("T")
R = TypeVar("R")

MAX_WORKERS = 1024
AHEAD = 2
"""Tasks handed out per worker: one in work and one waiting."""


class OtherEnvironmentError(InputError):
    """A process elsewhere has another coaxshell, Python or key library than the one that asks it."""


@dataclass(frozen=True)
class Alike:
    """Work that a process does only if its code and key libraries are those of the process that asks; pickles.

    Attributes
    ----------
    work : callable
    expected : str
        The environment of the process that asks.
    """

    work: Callable[[Any], Any]
    expected: str

    def __call__(self, task: Any) -> Any:
        """Return the result of a task; OtherEnvironmentError says what differs."""
        own = environment()
        if own != self.expected:
            where = f"process {os.getpid()} on {platform.node() or 'another machine'}"
            remedy = "install the same coaxshell, Python, numpy and scipy everywhere, and start the workers again"
            raise OtherEnvironmentError("executor", f"{where} is not like this one: {difference(own, self.expected)}", remedy)
        return self.work(task)


class WorkerDiedError(RuntimeError):
    """The process that worked on a task ended before it was done, as when memory ran out."""


def worker_count(workers: int | None) -> int:
    """Return how many processes to use: as asked, or one a core that this process may use; InputError if that is not a number."""
    if workers is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return whole("workers", workers, MAX_WORKERS)


def capacity(executor: Executor | None, workers: int | None) -> int:
    """Return how many tasks can be in work at a time."""
    if executor is None:
        return worker_count(workers)
    client = getattr(executor, "_client", None)  # Dask's, whose number of workers changes
    if client is not None:
        return max(1, sum(int(cores) for cores in client.ncores().values()))
    return int(getattr(executor, "_max_workers", 0) or worker_count(workers))


def completed(
    tasks: Iterable[T], work: Callable[[T], R], *, executor: Executor | None = None, workers: int | None = None
) -> Iterator[tuple[T, R | Exception]]:
    """Yield (task, result) as they are done, in any order; an exception in place of the result if the work raised one.

    Tasks are drawn only as workers come free, so that a caller may leave one out at the last moment. With ``workers=1`` all is
    done in this process. Otherwise in a pool of processes of our own, unless an *executor* is given. When a process of our own
    pool dies, a new pool is made; the tasks that were in work are done again at the end, one by one, and the one under which a
    process dies again gets :class:`WorkerDiedError`. When the caller stops early or is interrupted, nothing new is begun.

    Raises
    ------
    InputError
        The executor given is shut down, its workers cannot be reached or are not like this process; processes cannot be started.
    """
    alike: Callable[[T], R] = Alike(work, environment())
    if executor is not None:
        yield from _on(executor, tasks, alike, AHEAD * capacity(executor, workers))
    elif worker_count(workers) == 1:
        for task in tasks:
            yield task, _tried(work, task)
    else:
        yield from _in_own_pool(tasks, alike, worker_count(workers))


def _tried(work: Callable[[T], R], task: T) -> R | Exception:
    try:
        return work(task)
    except Exception as error:  # noqa: BLE001 - handed to the caller, who knows what to do with it
        return error


def _in_own_pool(tasks: Iterable[T], work: Callable[[T], R], workers: int) -> Iterator[tuple[T, R | Exception]]:
    waiting, suspects = iter(tasks), deque[T]()
    while True:
        with process_pool(workers) as pool:
            begun = pool.submit(os.getpid)
            lost = yield from _drained(pool, waiting, work, AHEAD * workers)
        if not lost:
            break
        if isinstance(begun.exception(), BrokenProcessPool):  # none of them came to do anything
            raise InputError("workers", *_NO_START)
        suspects += lost
    while suspects:  # one at a time, so that only the guilty one is blamed
        task = suspects.popleft()
        with process_pool(1) as pool:
            lost = yield from _drained(pool, iter([task]), work, 1)
        if lost:
            yield task, WorkerDiedError("the process that worked on it died, twice (out of memory?)")


def _on(executor: Executor, tasks: Iterable[T], work: Callable[[T], R], ahead: int) -> Iterator[tuple[T, R | Exception]]:
    lost = yield from _drained(executor, iter(tasks), work, ahead)
    for task in lost:
        yield task, WorkerDiedError("the executor broke while it was in work")


def _drained(
    executor: Executor, tasks: Iterator[T], work: Callable[[T], R], ahead: int
) -> Generator[tuple[T, R | Exception], None, list[T]]:
    """Yield results until tasks run out or the executor breaks; return the tasks that were in work when it broke."""
    running: dict[Future[R], T] = {}
    lost: list[T] = []
    try:
        while True:
            while not lost and len(running) < ahead:
                task = next(tasks, None)
                if task is None:
                    break
                try:
                    running[executor.submit(work, task)] = task
                except BrokenProcessPool:
                    lost.append(task)
                except RuntimeError as problem:
                    raise InputError("executor", f"cannot be used: {problem}", "give one that is not shut down") from None
            if not running:
                return lost
            done, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in done:
                task = running.pop(future)
                error = future.exception()
                if isinstance(error, BrokenProcessPool):
                    lost.append(task)
                elif isinstance(error, OtherEnvironmentError) or (error is not None and not isinstance(error, Exception)):
                    raise error
                elif error is not None and _unpacking(error):
                    lacks = f"a worker cannot unpack the work ({type(error).__name__}: {error})"
                    raise InputError("executor", lacks, "it needs the same coaxshell, and the modules that your functions come from")
                else:
                    yield task, future.result() if error is None else error
    finally:
        for future in running:
            future.cancel()


_NO_START = (
    "no process could be started: each runs the main program first, and that failed or began this study again",
    'put what the program does under if __name__ == "__main__":, or use workers=1',
)


def _require_main() -> None:
    """Raise InputError if processes cannot be started from this program: it has no file, or it is one of them and has no guard."""
    main = sys.modules["__main__"]
    file = getattr(main, "__file__", None)
    if file is not None and getattr(main, "__spec__", None) is None and not os.path.isfile(file):
        remedy = "save it as a file and run that, or use workers=1"
        raise InputError("workers", f"processes cannot be started from a program without a file ({file})", remedy)
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        raise SystemExit(1)  # the process that started this one tells why


def _unpacking(error: BaseException) -> bool:
    """Return whether work failed before it began, for want of what it is made of."""
    text = str(error)
    return isinstance(error, ImportError) or "deserializ" in text or (isinstance(error, AttributeError) and "Can't get attribute" in text)


@contextmanager
def process_pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Yield a pool of processes that are started afresh (never forked from this one), and end it at once afterwards.

    Its processes leave Ctrl-C to the parent and end when the parent does, even by kill -9.

    Raises
    ------
    InputError
        This program has no file from which processes could start.
    """
    _require_main()
    kind = "forkserver" if "forkserver" in multiprocessing.get_all_start_methods() else "spawn"
    context = multiprocessing.get_context(kind)
    if kind == "forkserver":
        context.set_forkserver_preload(["coaxshell.studies.evaluation"])
    pool = ProcessPoolExecutor(workers, mp_context=context, initializer=begin_worker)
    try:
        yield pool
    finally:
        pool.shutdown(wait=True, cancel_futures=True)


def begin_worker(*signals: str) -> None:
    """Leave Ctrl-C, and other *signals* that the system knows, to the parent, and end when it does, even by kill -9."""
    for name in ("SIGINT", *signals):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


@contextmanager
def dask_executor(address: str, timeout: float = 10.0) -> Iterator[Executor]:
    """Yield an executor on the Dask cluster whose scheduler is at *address*, such as ``tcp://10.0.0.1:8786``.

    The workers need coaxshell of the same version; the store stays on this machine.

    Raises
    ------
    InputError
        Dask is not installed, or nobody answers within *timeout* seconds.
    """
    try:
        from distributed import Client
    except ImportError:
        raise InputError("dask", "needs the package distributed", 'install it: pip install "coaxshell[cluster]"') from None
    try:
        client: Any = Client(address, timeout=timeout, set_as_default=False)  # type: ignore[no-untyped-call]
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            "address", f"no scheduler answers at {address!r} ({error})", "give its address, as in tcp://10.0.0.1:8786"
        ) from None
    try:
        # What a worker was about when it died is done again elsewhere; three deaths under one task are not chance.
        yield client.get_executor(retries=0)
    finally:
        client.close()
