"""What the places of some measurements would show in many runs, side by side, kept in a store."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from concurrent.futures import Executor
from contextlib import ExitStack
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.identity import numerics
from coaxshell.solver.settings import Settings
from coaxshell.studies.execution import Execution
from coaxshell.studies.executors import WorkerDiedError, completed, process_pool
from coaxshell.studies.fitting.places import Place, predicted
from coaxshell.studies.store import Store, digest
from coaxshell.studies.structures import Structures


@dataclass(frozen=True)
class Task:
    """One system to run, and what is read from it; pickles."""

    number: int
    system: System
    places: tuple[Place, ...]
    resolution: Settings


@dataclass(frozen=True)
class Predicted:
    """What one run showed at each place, shape (places, T), and the times of its instants (s); a reason instead if it was refused."""

    values: FloatArray
    time: FloatArray
    reason: str = ""


_kept = threading.local()


def predict(task: Task) -> Predicted:
    """Run one system; the kernels of the last structure are kept for the next task of the same worker."""
    structures: Structures | None = getattr(_kept, "structures", None)
    if structures is None or structures.resolution != task.resolution:
        structures = _kept.structures = Structures(task.resolution)
    try:
        with one_blas_thread():
            response = structures.response(task.system)
            values = np.array([predicted(response, one) for one in task.places])
    except InputError as error:
        return Predicted(np.empty((0, 0)), np.empty(0), str(error))
    return Predicted(values, response.time_seconds)


class Predictions:
    """Runs systems side by side, each once; with a store, not even a second time after an interruption.

    Parameters
    ----------
    places : sequence of Place
    resolution : Settings
    execution : Execution
        With its cluster, if there is one, reached.
    """

    def __init__(self, places: Sequence[Place], resolution: Settings, execution: Execution) -> None:
        self._places = tuple(places)
        self._resolution, self._execution = resolution, execution
        self._store = None if execution.store is None else Store(Path(execution.store))
        self._stack = ExitStack()
        self._pool: Executor | None = execution.executor
        self._known: dict[str, Predicted] = {}
        self.runs = 0

    def __enter__(self) -> Predictions:
        return self

    def __exit__(self, *unused: object) -> None:
        self._stack.close()
        _kept.structures = None

    def __call__(self, systems: Sequence[System | InputError]) -> list[Predicted]:
        """Return what each system shows, in order; a reason for those that could not be run.

        Raises
        ------
        Exception
            Whatever else than InputError a run ended by.
        """
        found: list[Predicted | None] = [_refused(one) if isinstance(one, InputError) else None for one in systems]
        keys = ["" if isinstance(one, InputError) else self._key(one) for one in systems]
        for number, key in enumerate(keys):
            if found[number] is None:
                found[number] = self._known.get(key) or self._stored(key)
        tasks = [
            Task(number, one, self._places, self._resolution)
            for number, one in enumerate(systems)
            if found[number] is None and isinstance(one, System)
        ]
        several = len(tasks) > 1
        if several and self._pool is None and self._execution.capacity > 1:
            self._pool = self._stack.enter_context(process_pool(self._execution.capacity))
        for task, result in completed(tasks, predict, executor=self._pool if several else None, workers=1):
            if isinstance(result, WorkerDiedError):
                remedy = 'put what the program does under if __name__ == "__main__":, or use workers=1'
                raise InputError("workers", f"a process did not come to its end ({result})", remedy)
            if isinstance(result, Exception):
                raise result
            self.runs += 1
            found[task.number] = self._known[keys[task.number]] = result
            if self._store is not None and not result.reason:
                self._store.put(keys[task.number], {"histories": result.values, "time": result.time}, {})
        return [one for one in found if one is not None]

    def _key(self, system: System) -> str:
        return digest([numerics(), system.canonical(), self._resolution.arguments(), [asdict(one) for one in self._places]])

    def _stored(self, key: str) -> Predicted | None:
        kept = None if self._store is None else self._store.get(key)
        if kept is None or "histories" not in kept[0]:
            return None
        self._known[key] = Predicted(kept[0]["histories"], kept[0]["time"])
        return self._known[key]


def _refused(error: InputError) -> Predicted:
    return Predicted(np.empty((0, 0)), np.empty(0), str(error))


def with_duration(settings: Settings, transits: float) -> Settings:
    """Return settings whose run is at least so long, a whole number of steps."""
    steps = int(np.ceil(transits / settings.time_step - 1e-9))
    return replace(settings, duration=steps * settings.time_step)
