"""From systems to metrics: the one pure function that workers call, and how cases are put together for it."""

from __future__ import annotations

import math
import threading
import time
import traceback
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from coaxshell.errors import InputError
from coaxshell.model.system import System
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.response import Response
from coaxshell.solver.settings import Settings
from coaxshell.studies.metrics import Metric
from coaxshell.studies.reading import MetricSource
from coaxshell.studies.structures import Structures, structure_of

LARGEST_BATCH = 4
"""Cases in one batch at most: what is done again when a worker or the study is killed."""


@dataclass(frozen=True)
class Case:
    """One system to evaluate, and the number by which the study knows it."""

    number: int
    system: System


@dataclass(frozen=True)
class Batch:
    """Cases of one structure, what to read from each, at which resolution; pickles.

    Attributes
    ----------
    cases : tuple of Case
    metrics : tuple of Metric
    resolution : Settings
    judged : bool
        Whether the physics warnings of each run are wanted: they need its error estimates, which take nearly as long as itself.
    """

    cases: tuple[Case, ...]
    metrics: tuple[Metric, ...]
    resolution: Settings
    judged: bool = True


@dataclass(frozen=True)
class Outcome:
    """What became of a case.

    Attributes
    ----------
    values : tuple of float
        One a metric; all NaN if the case failed.
    reason : str
        Why it failed; "" if it did not.
    expected : bool
        Whether the failure is the case's own (input or physics refused) and would come again, or an accident (a worker that died).
    warnings : tuple of str
        Physics warnings of the run, where they were wanted.
    seconds : float
        What it took.
    """

    values: tuple[float, ...]
    reason: str = ""
    expected: bool = True
    warnings: tuple[str, ...] = ()
    seconds: float = 0.0

    @property
    def failed(self) -> bool:
        """Whether there are no values."""
        return bool(self.reason)


def failure(metrics: Sequence[Metric], reason: str, *, expected: bool = True, seconds: float = 0.0) -> Outcome:
    """Return the outcome of a case that failed: NaN for every metric, and the reason on one line."""
    return Outcome((math.nan,) * len(metrics), " ".join(reason.split()) or "failed", expected, (), seconds)


_kept = threading.local()


def evaluate(batch: Batch) -> list[Outcome]:
    """Return the outcome of every case of a batch, in order.

    The same whoever evaluates it: BLAS is held to one thread (its sums depend on their number), and an answer depends on its own
    system alone. The kernels of the last structure are kept for the next batch of the same worker.

    Raises
    ------
    OtherCodeError
        A function of the user's is not the one here that it was where the study was begun.
    """
    for metric in batch.metrics:
        if metric.function is not None:
            metric.function.require_same(metric.name)
    structures: Structures | None = getattr(_kept, "structures", None)
    if structures is None or structures.resolution != batch.resolution:
        structures = _kept.structures = Structures(batch.resolution)
    with one_blas_thread():
        return [evaluated(case.system, batch.metrics, structures.response, judged=batch.judged) for case in batch.cases]


def forget() -> None:
    """Let go of the kernels that :func:`evaluate` keeps in this thread."""
    _kept.structures = None


def evaluated(system: System, metrics: tuple[Metric, ...], solved: Callable[[System], Response], *, judged: bool = True) -> Outcome:
    """Return what became of one system: its metrics, or why it has none; *solved* gives its response, with its warnings if *judged*."""
    start = time.perf_counter()
    try:
        response = solved(system)
        reading = MetricSource(response)
        values = tuple(metric(reading) for metric in metrics)
    except InputError as error:
        return failure(metrics, str(error), seconds=time.perf_counter() - start)
    except Exception as error:  # noqa: BLE001 - one case must not end the study; its reason says where to look
        place = traceback.extract_tb(error.__traceback__)[-1]
        text = f"unexpected {type(error).__name__}: {error} ({place.name}, line {place.lineno})"
        return failure(metrics, text, expected=False, seconds=time.perf_counter() - start)
    return Outcome(values, warnings=response.warnings if judged else (), seconds=time.perf_counter() - start)


def batches(cases: Iterable[Case], metrics: tuple[Metric, ...], resolution: Settings, workers: int, *, judged: bool = True) -> list[Batch]:
    """Return the cases in batches, each of one structure and small enough that all workers stay busy to the end.

    Cases that share a structure stay together whatever their order, so that its kernels are prepared once a worker.
    """
    groups: dict[System, list[Case]] = {}
    for case in cases:
        groups.setdefault(structure_of(case.system), []).append(case)
    made = []
    for group in groups.values():
        size = min(LARGEST_BATCH, max(1, len(group) // (4 * workers)))
        made += [Batch(tuple(group[i : i + size]), metrics, resolution, judged) for i in range(0, len(group), size)]
    return made
