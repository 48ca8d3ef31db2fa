"""Baseline and best of an optimisation again, at finer resolutions than that of its search."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from coaxshell.model.system import System
from coaxshell.solver.settings import Settings
from coaxshell.studies.optimisation.search import Run, Scenarios
from coaxshell.studies.optimisation.targets import Targets


@dataclass(frozen=True)
class Confirmation:
    """Targets of two systems at one resolution, by name; empty for a system whose run was refused there."""

    resolution: Settings
    baseline: dict[str, float]
    best: dict[str, float]

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain data."""
        return {"resolution": self.resolution.arguments(), "baseline": self.baseline, "best": self.best}


def finer(system: System, resolution: Settings, confirm: Mapping[str, Any] | None) -> tuple[Settings, ...]:
    """Return the resolutions of a confirmation: that of the search with some settings changed, and the same at half the time step.

    Raises
    ------
    InputError
        A setting is unknown or not allowed.
    """
    if not confirm:
        return ()
    fine = Settings.of(system, confirm, base=resolution, where="confirm")
    return fine, replace(fine, time_step=fine.time_step / 2)


def confirmed(
    baseline: System, best: System, resolutions: tuple[Settings, ...], targets: Targets, scenarios: Scenarios, run: Run
) -> tuple[Confirmation, ...]:
    """Return both systems' targets at each resolution."""
    found = []
    for resolution in resolutions:
        told = []
        for system in (baseline, best):
            outcomes = run(list(scenarios(system)), resolution)
            failed = any(outcome.failed for outcome in outcomes)
            told.append({} if failed else targets.values(np.array([outcome.values for outcome in outcomes], dtype=np.float64)))
        found.append(Confirmation(resolution, told[0], told[1]))
    return tuple(found)
