"""The answer of an optimisation: the best system, the front, the history, and all of it as files."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from coaxshell._version import __version__
from coaxshell.errors import InputError
from coaxshell.model.prefixes import against
from coaxshell.model.system import System
from coaxshell.numerics.files import replacing_folder
from coaxshell.numerics.identity import numerics
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.summary_text import aligned
from coaxshell.solver.settings import Settings
from coaxshell.studies.optimisation.confirmation import Confirmation
from coaxshell.studies.optimisation.search import Candidate, non_dominated
from coaxshell.studies.optimisation.targets import Targets
from coaxshell.studies.optimisation.variables import Space

OPTIMUM_PARTS = ("best.toml", "optimum.json", "history.csv", "front")
"""What a saved optimum holds."""


@dataclass(frozen=True)
class Optimum:
    """What an optimisation found.

    Attributes
    ----------
    space, targets, resolution, method, seed
        The problem, and how it was searched.
    history : tuple of Candidate
        Every design in the order in which it was asked for.
    baseline : Candidate
        The base system's own values, in the same terms.
    confirmations : tuple of Confirmation
        Baseline and best at finer resolutions.
    complete : bool
        False if it was interrupted.
    """

    space: Space
    targets: Targets
    resolution: Settings
    method: str
    seed: int
    history: tuple[Candidate, ...]
    baseline: Candidate
    confirmations: tuple[Confirmation, ...] = field(default=())
    complete: bool = True

    @property
    def best(self) -> Candidate:
        """The best feasible design, of several objectives the front's first; the least violating one if none is feasible."""
        front = self.front
        return front[0] if front else min(self.history, key=lambda one: (*one.rank, one.number))

    @property
    def feasible(self) -> bool:
        """Whether any design keeps all limits."""
        return any(one.feasible for one in self.history)

    @property
    def front(self) -> list[Candidate]:
        """Feasible designs that none beats in every objective; a single one for one objective."""
        return non_dominated(self.history)

    @property
    def system(self) -> System:
        """The best system, ready to run."""
        return self.system_of(self.best)

    def system_of(self, candidate: Candidate) -> System:
        """Return the system of a design; InputError if its values make none."""
        system = self.space.system(candidate.values)
        if isinstance(system, InputError):
            raise system
        name = self.space.base.name.removesuffix("optimised").removesuffix(", ")
        return system.replace(name=f"{name}, optimised" if name else "optimised")

    def to_dataset(self) -> xr.Dataset:
        """Return the history: one variable a target, one coordinate a variable of the search, by ``evaluation``."""
        dims = ("evaluation",)
        coordinates = {
            variable.name: xr.Variable(
                dims, _column([one.values[k] for one in self.history]), {"units": variable.units, "long_name": variable.long_name}
            )
            for k, variable in enumerate(self.space.variables)
        }
        coordinates["generation"] = xr.Variable(dims, np.array([one.generation for one in self.history]))
        data = {
            f"{target.name} (target)" if target.name in coordinates else target.name: xr.Variable(
                dims,
                np.array([one.targets.get(target.name, np.nan) for one in self.history]),
                {"units": target.metric.units, "long_name": target.metric.long_name},
            )
            for target in self.targets.all
        }
        data["violation"] = xr.Variable(
            dims, np.array([one.violation for one in self.history]), {"long_name": "relative excess over the limits; 0: feasible"}
        )
        data["reason"] = xr.Variable(
            dims, np.array([one.reason for one in self.history], dtype=object), {"long_name": "why a design was not computed"}
        )
        return xr.Dataset(data, coordinates, self._attributes())

    def to_csv(self) -> str:
        """Return the history as a table with commas, one design a line."""
        return str(self.to_dataset().to_dataframe().reset_index().to_csv(index=False))

    def _attributes(self) -> dict[str, Any]:
        return {
            "title": f"optimisation of {self.space.base.name or 'a system'}",
            "source": f"coaxshell {__version__}",
            "numerics": numerics(),
            "scenario": self.space.base.to_toml_string(),
            "settings": json.dumps(self.resolution.arguments()),
            "method": self.method,
            "seed": self.seed,
            "objectives": json.dumps([goal.target.name for goal in self.targets.goals]),
            "constraints": json.dumps([limit.text for limit in self.targets.limits]),
        }

    def to_dict(self) -> dict[str, Any]:
        """Return the essentials as plain data: best and baseline, front, confirmations."""
        return {
            "title": f"optimisation of {self.space.base.name or 'a system'}",
            "numerics": numerics(),
            "method": self.method,
            "seed": self.seed,
            "evaluations": len(self.history),
            "complete": self.complete,
            "feasible": self.feasible,
            "constraints": [limit.text for limit in self.targets.limits],
            "units": {target.name: target.metric.units for target in self.targets.all},
            "baseline": self._told(self.baseline),
            "best": self._told(self.best),
            "front": [self._told(one) for one in self.front] if len(self.targets.goals) > 1 else [],
            "confirmations": [one.to_dict() for one in self.confirmations],
        }

    def _told(self, one: Candidate) -> dict[str, Any]:
        names = [variable.name for variable in self.space.variables]
        return {
            "evaluation": one.number,
            "variables": dict(zip(names, one.values, strict=True)),
            "targets": one.targets,
            "violation": one.violation,
        }

    def save(self, folder: str | Path) -> Path:
        """Write ``best.toml``, ``optimum.json``, ``history.csv`` (and the front's systems as ``front/NN.toml``) to a folder.

        The files appear together; an earlier result is replaced.

        Raises
        ------
        InputError
            The folder holds something else than an earlier result, or cannot be written.
        """
        with replacing_folder(folder, OPTIMUM_PARTS, "output", force=True) as made:
            self._write(made)
        return Path(folder)

    def _write(self, folder: Path) -> None:
        self.system.to_toml(folder / "best.toml")
        (folder / "optimum.json").write_text(json.dumps(self.to_dict(), indent=1), encoding="utf-8")
        (folder / "history.csv").write_text(self.to_csv(), encoding="utf-8")
        if len(self.targets.goals) > 1:
            (folder / "front").mkdir()
            for number, one in enumerate(self.front):
                self.system_of(one).to_toml(folder / "front" / f"{number:02d}.toml")

    def __str__(self) -> str:
        """Return aligned tables: what was reached against the baseline, the best values of the variables, confirmations."""
        found = f"{len(self.history)} evaluations by {self.method}" + ("" if self.complete else ", interrupted")
        if not self.feasible:
            found += "; NO design keeps all limits: the one nearest to it is shown"
        rows: list[tuple[str, ...]] = [("", "baseline", "best", "best is", "unit")]
        for target in self.targets.all:
            before, after = self.baseline.targets.get(target.name), self.best.targets.get(target.name)
            rows.append((target.name, _number(before), _number(after), against(after, before), target.metric.units))
        variables: list[tuple[str, ...]] = [("variable", "baseline", "best", "unit")]
        for variable, before, after in zip(self.space.variables, self.baseline.values, self.best.values, strict=True):
            variables.append((variable.name, _number(before), _number(after), variable.units))
        lines = [found, "", *aligned(rows, left=1), "", *aligned(variables, left=1)]
        if self.confirmations:
            lines += ["", *aligned(_confirmed(self.confirmations), left=2)]
        if len(self.targets.goals) > 1:
            lines += ["", f"{len(self.front)} designs on the front; best is the one of the smallest {self.targets.goals[0].target.name}"]
        return "\n".join(lines)


def _confirmed(confirmations: Sequence[Confirmation]) -> list[tuple[str, ...]]:
    rows: list[tuple[str, ...]] = [("confirmed at", "metric", "baseline", "best", "best is")]
    for one in confirmations:
        label = f"M = {one.resolution.modes}, dt = {one.resolution.time_step:g}"
        for name, after in one.best.items():
            before = one.baseline[name]
            rows.append((label, name, _number(before), _number(after), against(after, before)))
    return rows


def _number(value: Any) -> str:
    return "-" if value is None else f"{value:.5g}" if isinstance(value, int | float) else str(value)


def _column(values: Sequence[Any]) -> np.ndarray[Any, Any]:
    return np.array(values) if all(isinstance(value, int | float) for value in values) else np.array([str(v) for v in values], dtype=object)
