"""Runs of the reproduction: solved when first asked for, kept in memory and in a store, shared by figures and claims."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.apps.paper.fields import Fields, fields_of
from coaxshell.apps.paper.observed import Observed, StressPeaks, observe
from coaxshell.errors import PhysicsWarning
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.identity import origin
from coaxshell.numerics.progress import Progress
from coaxshell.solver.settings import Settings
from coaxshell.studies.executors import completed
from coaxshell.studies.store import Store, digest
from coaxshell.studies.structures import solve_each

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response import Response

Solver = Callable[["Mapping[str, System]", Settings, "Progress | None"], "Iterator[tuple[str, Response]]"]
"""Solves systems in turn; :func:`coaxshell.studies.structures.solve_each` or one with slips turned on."""

FEWEST = 12
"""Below it the start of the processes costs more than it saves."""

_SHARES = 6
"""Shares a process: few, since each prepares its structure; several, since they take unequal times."""


@dataclass(frozen=True)
class Share:
    """Systems that one process solves one after another, as sent to it."""

    solver: Solver
    systems: Mapping[str, System]
    resolution: Settings
    peaks_only: bool


def in_turn(share: Share, progress: Progress | None = None) -> Iterator[tuple[str, Observed]]:
    """Yield (name, run) of each system, solved in this process."""
    for name, response in share.solver(share.systems, share.resolution, progress):
        yield name, observe(response, peaks_only=share.peaks_only)


def shared_out(share: Share, workers: int, progress: Progress | None = None) -> Iterator[tuple[str, Observed]]:
    """Yield (name, run) of each system, solved by several processes; in any order, the runs the same as in turn."""
    names, count, done = list(share.systems), len(share.systems), 0
    size = -(-count // (_SHARES * workers))
    parts = [{name: share.systems[name] for name in names[start : start + size]} for start in range(0, count, size)]
    tasks = [Share(share.solver, part, share.resolution, share.peaks_only) for part in reversed(parts)]  # the longest come last
    for task, found in completed(tasks, _carried_out, workers=workers):
        if isinstance(found, Exception):
            raise found
        done += len(task.systems)
        if progress:
            progress(done / count, "solving")
        yield from found.items()


def _carried_out(share: Share) -> dict[str, Observed]:
    with one_blas_thread(), warnings.catch_warnings():
        warnings.simplefilter("ignore", PhysicsWarning)  # every run keeps its own
        return dict(in_turn(share))


CORRECTED = "corrected"
_FURTHER = ("apps/paper/observed.py", "apps/paper/fields.py", "apps/paper/slips")
"""What kept numbers come from beside the solver and all that it builds on."""


def key_of(*parts: Any) -> str:
    """Return the name of a kept piece: the hash of what it is of and of the code that its numbers come from."""
    return digest([origin(*_FURTHER), *parts])


class NoFieldsError(Exception):
    """Fields were asked of a variant that has none."""


class Runs:
    """Runs by system and resolution.

    Parameters
    ----------
    resolution : Settings
        Of every run that is not asked for at another one.
    solver : callable
        From systems by name, a resolution and a report of progress to pairs of (name, response).
    variant : str
        Name of the model that the solver computes; "corrected" or another one in the store.
    store : Store, optional
        Where finished runs are kept.
    has_fields : bool
        Whether the pressure fields of its responses obey the model that was solved.
    workers : int
        Processes for many runs at once; of more than one the solver must be importable.
    """

    def __init__(
        self,
        resolution: Settings | None = None,
        *,
        solver: Solver = solve_each,
        variant: str = CORRECTED,
        store: Store | None = None,
        has_fields: bool = True,
        workers: int = 1,
    ) -> None:
        self.resolution = resolution or Settings()
        self.variant = variant
        self._solver = solver
        self._has_fields = has_fields
        self._store = store
        self._workers = workers
        self._known: dict[str, Observed] = {}
        self._fields: dict[str, Fields] = {}

    def __call__(self, system: System, resolution: Settings | None = None) -> Observed:
        """Return the run of one system."""
        return next(observed for _, observed in self.each({system.name or "run": system}, resolution=resolution))

    def each(
        self,
        systems: Mapping[str, System],
        progress: Progress | None = None,
        *,
        resolution: Settings | None = None,
        peaks_only: bool = False,
    ) -> Iterator[tuple[str, Observed]]:
        """Yield (name, run) of each system in turn; those not known yet are solved.

        Parameters
        ----------
        systems : mapping of str to System
        progress : callable, optional
            Called with the fraction done and "solving".
        resolution : Settings, optional
        peaks_only : bool
            Whether runs without histories will do.
        """
        settings = resolution or self.resolution
        keys = {name: self._key(system, settings) for name, system in systems.items()}
        missing = {name: systems[name] for name, key in keys.items() if self._find(key, peaks_only) is None}
        share = Share(self._solver, missing, settings, peaks_only)
        several = self._workers > 1 and len(missing) >= FEWEST
        solved = shared_out(share, self._workers, progress) if several else in_turn(share, progress) if missing else iter(())
        for name, key in keys.items():
            while self._find(key, peaks_only) is None:
                found, observed = next(solved)
                self._keep(keys[found], observed)
            yield name, self._known[key]
        for _ in solved:  # lets the solver report that it is through
            pass

    def fields(self, system: System, progress: Progress | None = None) -> Fields:
        """Return what is kept of the fields of a system (:func:`coaxshell.apps.paper.fields.fields_of`).

        Raises
        ------
        NoFieldsError
            The variant has none.
        """
        if not self._has_fields:
            raise NoFieldsError(self.variant)
        key = key_of("fields", self.variant, system.canonical(), self.resolution.arguments())
        if key not in self._fields:
            piece = self._store.get(key) if self._store else None
            if piece is None:
                ((_, response),) = self._solver({system.name: system}, self.resolution, None)
                piece = fields_of(response, progress), {}
                if self._store:
                    self._store.put(key, *piece)
            self._fields[key] = piece[0]
        return self._fields[key]

    def _key(self, system: System, resolution: Settings) -> str:
        return key_of("run", self.variant, system.canonical(), resolution.arguments())

    def _find(self, key: str, peaks_only: bool) -> Observed | None:
        found = self._known.get(key) or (self._load(key) if self._store else None)
        if found is None or not (peaks_only or found.histories):
            return None
        self._known[key] = found
        return found

    def _keep(self, key: str, observed: Observed) -> None:
        self._known[key] = observed
        if self._store:
            self._store.put(key, *packed(observed))

    def _load(self, key: str) -> Observed | None:
        piece = self._store.get(key) if self._store else None
        return unpacked(*piece) if piece else None


def packed(observed: Observed) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return a run as arrays by name and plain values."""
    arrays = {"time": observed.time, "absorber": observed.absorber}
    arrays |= {" ".join(name): values for name, values in observed.histories.items()}
    arrays |= {f"circle {name}": values for name, values in observed.circle.items()}
    values = {
        "transit_time": observed.transit_time,
        "modes": observed.modes,
        "shells": {name: asdict(shell) for name, shell in observed.shells.items()},
        "warnings": list(observed.warnings),
    }
    return arrays, values


def unpacked(arrays: Mapping[str, Any], values: Mapping[str, Any]) -> Observed:
    """Return the run that :func:`packed` took apart."""
    from coaxshell.response.peaks import Peak
    from coaxshell.response.summary import ShellSummary
    from coaxshell.response.wall_stress import WallPeak

    def peak(plain: Any) -> Any:
        if not isinstance(plain, dict) or "angle" not in plain:
            return plain
        return WallPeak(**plain) if "depth" in plain else Peak(**plain)

    def shell(plain: Mapping[str, Any]) -> ShellSummary | StressPeaks:
        def peaks(values: Mapping[str, Any]) -> dict[str, Any]:
            return {name: peak(one) for name, one in values.items()}

        if "further" not in plain:
            return StressPeaks(**peaks(plain))
        return ShellSummary(**{**peaks(plain), "further": peaks(plain.get("further", {}))})

    split = {tuple(name.split()): np.asarray(array, dtype=np.float64) for name, array in arrays.items()}
    return Observed(
        time=split["time",],
        transit_time=values["transit_time"],
        modes=values["modes"],
        shells={name: shell(plain) for name, plain in values["shells"].items()},
        histories={(q, s, p): array for (q, s, p), array in ((k, a) for k, a in split.items() if len(k) == 3)},
        circle={name[1]: array for name, array in split.items() if name[0] == "circle"},
        absorber=split["absorber",],
        warnings=tuple(values["warnings"]),
    )
