"""Evaluate the cases of a study: those that a store holds already are read, the others are worked on and kept."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import ExitStack
from dataclasses import replace
from typing import Any

from coaxshell.errors import InputError
from coaxshell.model.paths import within
from coaxshell.model.system import System
from coaxshell.solver.settings import Settings
from coaxshell.solver.solvable import require_solvable
from coaxshell.studies.cost import case_cost, require_room
from coaxshell.studies.evaluation import Batch, Case, Outcome, batches, evaluate, failure, forget
from coaxshell.studies.execution import Execution
from coaxshell.studies.executors import completed, process_pool
from coaxshell.studies.metrics import Metric, require_readable
from coaxshell.studies.store import StudyStore
from coaxshell.studies.user_functions import OtherCodeError


def run_study(
    systems: Sequence[System | InputError],
    metrics: tuple[Metric, ...],
    resolution: Settings,
    execution: Execution,
    parts: Mapping[str, Any],
    where: str = "",
) -> list[Outcome]:
    """Return the outcome of every case, in order; InputError, within *where*, if none of them is possible."""
    require_readable(metrics, resolution.dimensions)
    systems = [_solvable(item, resolution) for item in systems]
    refused = [item for item in systems if isinstance(item, InputError)]
    if len(refused) == len(systems):
        first = refused[0]
        raise within(where, InputError(first.where, f"no case is possible: {first.problem}", first.remedy))
    store = execution.opened(parts, metrics)
    with execution.started() as ready:
        return run_cases(systems, metrics, resolution, ready, store)


def run_cases(
    systems: Sequence[System | InputError],
    metrics: tuple[Metric, ...],
    resolution: Settings,
    execution: Execution,
    store: StudyStore | None = None,
    *,
    keep: bool = False,
    judged: bool = True,
) -> list[Outcome]:
    """Return the outcome of every case, in order.

    Parameters
    ----------
    systems : sequence of System, or of the InputError for which there is none
    metrics : tuple of Metric
    resolution : Settings
    execution : Execution
        Its executor or its workers (by default one a core, or 1 where a function stands in a notebook), and whom to tell of progress.
    store : StudyStore, optional
        Where finished cases are kept, and looked for first.
    keep : bool
        Leave the last structure's kernels in this process for the next call; :func:`coaxshell.studies.evaluation.forget` ends that.
    judged : bool
        Whether outcomes tell the physics warnings of their runs.

    Raises
    ------
    InputError
        A function of the user's cannot be sent to another process.
    KeyboardInterrupt
        As it came; what was finished is in the store.
    """
    execution = _in_reach(execution, metrics)
    executor, workers_at_once = execution.executor, execution.capacity
    if executor is not None or workers_at_once > 1:
        _sendable(metrics, executor)
    keys = {n: store.key(one, resolution) for n, one in enumerate(systems) if store is not None and isinstance(one, System)}
    outcomes = {n: failure(metrics, str(one)) for n, one in enumerate(systems) if isinstance(one, InputError)}
    _look_up(keys, store, outcomes)
    report = execution.progress or (lambda fraction, stage: None)
    report(len(outcomes) / len(systems), "cases")
    waiting = [Case(i, system) for i, system in enumerate(systems) if i not in outcomes and isinstance(system, System)]
    if executor is None:
        require_room(case_cost([case.system for case in waiting], resolution), len(waiting), workers_at_once)
    planned = batches(waiting, metrics, resolution, workers_at_once, judged=judged)
    processes = 1 if executor is None and len(planned) == 1 else execution.workers
    try:
        for batch, result in completed(_still_needed(planned, store, keys, outcomes), evaluate, executor=executor, workers=processes):
            for case, outcome in zip(batch.cases, _told(result, batch), strict=True):
                outcomes[case.number] = outcome
                if store is not None:
                    store.save(keys[case.number], outcome)
            report(len(outcomes) / len(systems), "cases")
    finally:
        if not keep:
            forget()
    return [outcomes[number] for number in range(len(systems))]


class WorkerPool:
    """Run cases again and again by workers that stay in between; a pool that breaks is replaced. Outcomes tell no physics warnings.

    Parameters
    ----------
    execution : Execution
        With its cluster, if there is one, reached.
    metrics : tuple of Metric
    store : StudyStore, optional
        Where finished cases are kept, and looked for first.
    """

    def __init__(self, execution: Execution, metrics: tuple[Metric, ...], store: StudyStore | None = None) -> None:
        self._given, self._metrics, self._store = _in_reach(replace(execution, progress=None), metrics), metrics, store
        self._stack = ExitStack()
        self._pool: Executor | None = None

    def __enter__(self) -> WorkerPool:
        return self

    def __exit__(self, *unused: object) -> None:
        self._stack.close()
        forget()

    def __call__(self, systems: Sequence[System | InputError], resolution: Settings) -> list[Outcome]:
        """Return the outcome of each system, in order."""
        given = self._given
        if given.executor is None and self._pool is None and given.capacity > 1:
            self._pool = self._stack.enter_context(process_pool(given.capacity))
        ready = given if self._pool is None else replace(given, executor=self._pool)
        outcomes = run_cases(systems, self._metrics, resolution, ready, self._store, keep=True, judged=False)
        lost = [k for k, outcome in enumerate(outcomes) if outcome.reason.startswith("WorkerDiedError")]
        if lost and given.executor is None:
            self._stack.close()
            self._pool = None
            again = run_cases([systems[k] for k in lost], self._metrics, resolution, given, self._store, keep=True, judged=False)
            for k, outcome in zip(lost, again, strict=True):
                outcomes[k] = outcome
        return outcomes


def _solvable(system: System | InputError, resolution: Settings) -> System | InputError:
    """Return a system, or why it cannot be solved in the dimensions asked for."""
    try:
        if isinstance(system, System):
            require_solvable(system, resolution)
    except InputError as error:
        return error
    return system


def _look_up(keys: Mapping[int, str], store: StudyStore | None, outcomes: dict[int, Outcome]) -> None:
    """Add what the store holds of some cases to the outcomes."""
    for number, key in keys.items():
        found = None if store is None else store.load(key)
        if found is not None:
            outcomes[number] = found


def _still_needed(
    planned: Sequence[Batch], store: StudyStore | None, keys: dict[int, str], outcomes: dict[int, Outcome]
) -> Iterator[Batch]:
    """Yield batches without the cases that another writer has finished in the meantime."""
    for batch in planned:
        _look_up({case.number: keys[case.number] for case in batch.cases if case.number in keys}, store, outcomes)
        left = tuple(case for case in batch.cases if case.number not in outcomes)
        if left:
            yield replace(batch, cases=left)


def _told(result: list[Outcome] | Exception, batch: Batch) -> list[Outcome]:
    if isinstance(result, OtherCodeError):
        raise result
    if isinstance(result, Exception):
        reason = f"{type(result).__name__}: {result}"
        return [failure(batch.metrics, reason, expected=False) for _ in batch.cases]
    return result


def _in_reach(execution: Execution, metrics: Sequence[Metric]) -> Execution:
    """Return an execution in this process where a function stands in a notebook, unless another was asked for."""
    asked = execution.executor is not None or execution.workers is not None
    here = any(metric.function is not None and metric.function.only_here for metric in metrics)
    return replace(execution, workers=1) if here and not asked else execution


def _sendable(metrics: Sequence[Metric], executor: Executor | None) -> None:
    """Raise InputError for a function that other processes do not get; Dask sends those of a notebook by value."""
    for metric in metrics:
        if metric.function is None:
            continue
        where, remedy = f"metrics.{metric.name}", "define it at the top of a module, or use workers=1"
        if not metric.function.pickles:
            raise InputError(where, "this function cannot be sent to another process", remedy)
        if (executor is None or isinstance(executor, ProcessPoolExecutor)) and metric.function.only_here:
            problem = "this function stands in a notebook or an interactive session, which other processes cannot read"
            raise InputError(where, problem, "write it to a .py file and import it, or use workers=1")
