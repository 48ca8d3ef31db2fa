"""Optimisations from the page: the same designs and numbers as ``coaxshell.optimise``, run in one worker with what it has at hand."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from typing import Any, NamedTuple

from coaxshell.apps.studio import descriptions, limits, worker
from coaxshell.errors import InputError
from coaxshell.model import System
from coaxshell.model.base import shown
from coaxshell.model.naming import suggestion
from coaxshell.response import Response
from coaxshell.solver.settings import Settings
from coaxshell.studies.evaluation import Outcome, evaluated, failure
from coaxshell.studies.metrics import metric_names
from coaxshell.studies.optimisation.optimising import Problem, problem_of, searched
from coaxshell.studies.optimisation.optimum import Optimum
from coaxshell.studies.optimisation.search import Candidate
from coaxshell.studies.optimisation.targets import Objective, Target
from coaxshell.studies.optimisation.variables import space_of
from coaxshell.studies.structures import Structures

ENTRIES = frozenset({"from", "to", "scale", "each"})


class Found(NamedTuple):
    """What an optimisation came to, and the physics warnings of its best design."""

    optimum: Optimum
    warnings: tuple[str, ...]


def planned(system: System, settings: Settings, data: dict[str, Any]) -> Problem:
    """Return the optimisation that a request describes.

    Raises
    ------
    InputError
        As ``coaxshell.optimise``; also what is too large here, and metrics that are functions in a file, which a page must not run.
    """
    for entry in ("uncertain", "confirm", "start"):
        if entry in data:
            raise InputError(entry, "is not taken here", "leave it out; coaxshell optimise takes it")
    variables = _variables(system, data.get("variables"))
    names = metric_names(system, settings.dimensions)
    objectives, constraints = _objectives(data.get("objectives"), names), _constraints(data.get("constraints", []), names)
    evaluations = _whole(data, "evaluations", 1, limits.EVALUATIONS, 100)
    population = None if data.get("population") is None else _whole(data, "population", 4, limits.POPULATION, None)
    method = data.get("method", "auto")
    if not isinstance(method, str):
        raise InputError("method", f"{shown(method)} is not allowed", "give the name of a method, or auto")
    search_by = (method, evaluations, population, "auto", _whole(data, "seed", 0, 2**31, 0))
    return problem_of(system, variables, objectives, constraints, settings, (None, 0), search_by, None)


def _variables(system: System, variables: Any) -> dict[str, Any]:
    if not isinstance(variables, dict) or not 1 <= len(variables) <= limits.VARIED:
        raise InputError("variables", f"{shown(variables)} is not allowed", f"give a table of 1 to {limits.VARIED} paths and their ranges")
    for path, given in variables.items():
        limits.check_path("variables", path)
        where = f"variables.{path}"
        if isinstance(given, dict):
            unknown = sorted(set(given) - ENTRIES)
            if unknown:
                raise InputError(f"{where}.{unknown[0]}", "is not taken here", f"allowed: {', '.join(sorted(ENTRIES))}")
            limits.check_values(where, list(given.values()))
        elif not isinstance(given, list) or len(given) > limits.CASES:
            raise InputError(where, f"{shown(given)} is not allowed", f"give from and to, or a list of at most {limits.CASES} choices")
        limits.check_values(where, given)
    space = space_of(system, variables)
    if len(space.variables) > limits.COORDINATES:
        raise InputError("variables", f"{len(space.variables)} in all are too many here", f"at most {limits.COORDINATES}")
    for variable in space.variables:
        counts = [level for level in variable.levels if isinstance(level, int)]
        if counts:
            limits.check_counts(f"variables.{variable.name}", max(counts))
    return variables


def _objectives(given: Any, known: list[str]) -> list[Objective]:
    if not isinstance(given, list) or not 1 <= len(given) <= 2:
        raise InputError("objectives", f"{shown(given)} is not allowed", "give a list of one or two metrics")
    found = []
    for number, item in enumerate(given):
        where = f"objectives[{number}]"
        entries = item if isinstance(item, dict) else {"metric": item}
        unknown = sorted(set(entries) - {"metric", "maximise"})
        if unknown:
            raise InputError(f"{where}.{unknown[0]}", "is not an entry of an objective", "allowed: metric, maximise")
        if not isinstance(entries.get("maximise", False), bool):
            raise InputError(f"{where}.maximise", f"{shown(entries['maximise'])} is not allowed", "must be true or false")
        found.append(Objective(_known(entries.get("metric"), known, where), entries.get("maximise", False)))
    return found


def _constraints(given: Any, known: list[str]) -> list[str]:
    if not isinstance(given, list) or len(given) > limits.CONSTRAINTS:
        raise InputError("constraints", f"{shown(given)} is not allowed", f"give a list of at most {limits.CONSTRAINTS} texts")
    limits.check_values("constraints", given)
    for number, text in enumerate(given):
        if isinstance(text, str) and ("<=" in text or ">=" in text):
            _known(text.split("<=")[0].split(">=")[0].strip(), known, f"constraints[{number}]")
    return given


def _known(name: Any, known: list[str], where: str) -> str:
    if not isinstance(name, str) or name not in known:
        raise InputError(where, f"{shown(name)} is not a metric of this system", suggestion(str(name)[: limits.TEXT], known))
    return name


def _whole(data: dict[str, Any], entry: str, least: int, most: int, default: int | None) -> int:
    value = data.get(entry, default)
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise InputError(entry, f"{shown(value)} is not allowed", f"give a whole number from {least:,} to {most:,}")
    return value


class Hand:
    """Run the systems of an optimisation in one worker, one after another, on the structure at hand; reported as parts of the whole.

    Parameters
    ----------
    problem : Problem
    settings : Settings
    """

    def __init__(self, problem: Problem, settings: Settings) -> None:
        prepared, self._settings, self._metrics = None, settings, problem.targets.metrics
        with suppress(InputError):  # an unstable feedback is the baseline's own failure
            prepared = worker.structure(problem.space.base, settings) if settings.dimensions == 2 else None
        self._structures = Structures(problem.resolution, prepared, worker.report)
        self._count, self._done, self._stage = 1 + problem.evaluations, 0, "baseline"
        self.warnings: dict[System, tuple[str, ...]] = {}

    def __call__(self, systems: Sequence[System | InputError], resolution: Settings) -> list[Outcome]:
        """Return the outcome of each system, in order."""
        return [self._outcome(system) for system in systems]

    def told(self, fraction: float, stage: str) -> None:
        """Take in what the search says after every generation."""
        done = round(fraction * (self._count - 1))
        self._done, self._stage = 1 + done, f"{done}: {stage.removeprefix('optimising: ')}"
        worker.report(self._done / self._count, self._stage)

    def _outcome(self, system: System | InputError) -> Outcome:
        if isinstance(system, InputError):
            return failure(self._metrics, str(system))
        with worker.part(min(self._done, self._count - 1), self._count, self._stage):
            outcome = evaluated(system, self._metrics, self._solved)
        self._done += 1
        self.warnings[system] = outcome.warnings
        return outcome

    def _solved(self, system: System) -> Response:
        limits.check_system(system)
        limits.check_cost(system, self._settings, live=False)
        return self._structures.response(system)


def optimise(problem: Problem, settings: Settings) -> Found:
    """Carry out an optimisation."""
    hand = Hand(problem, settings)
    optimum = searched(problem, hand, hand.told)
    best = optimum.space.system(optimum.best.values)
    return Found(optimum, hand.warnings.get(best, ()) if isinstance(best, System) else ())


def told(found: Found) -> dict[str, Any]:
    """Return an optimisation as plain data; what was not computed is None."""
    optimum = found.optimum
    goals, best = optimum.targets.goals, optimum.best
    single = len(goals) == 1
    columns = [[_plain(one.targets.get(goal.target.name)) for one in optimum.history] for goal in goals]
    return {
        "feasible": optimum.feasible,
        "evaluations": len(optimum.history),
        "method": optimum.method,
        "seed": optimum.seed,
        "resolution": optimum.resolution.arguments(),
        "variables": [
            {"name": one.name, "unit": one.units, "label": one.long_name, "baseline": _plain(before), "best": _plain(after)}
            for one, before, after in zip(optimum.space.variables, optimum.baseline.values, best.values, strict=True)
        ],
        "targets": [_target(target, optimum) for target in optimum.targets.all],
        "history": {
            "objectives": columns,
            "feasible": [one.feasible for one in optimum.history],
            "best": _best_so_far(optimum.history, goals[0].target.name) if single else None,
        },
        "front": [] if single else [_design(one, optimum) for one in optimum.front],
        "best": {"number": best.number, **_system(optimum, best)},
        "warnings": list(found.warnings),
    }


def design(found: Found, number: int) -> dict[str, Any]:
    """Return one of the designs as the answer to a valid description; InputError if its values make no system."""
    return descriptions.told(found.optimum.system_of(found.optimum.history[number]))


def _system(optimum: Optimum, best: Candidate) -> dict[str, Any]:
    try:
        system = optimum.system_of(best)
    except InputError:
        return {"system": None, "toml": None}
    return {"system": descriptions.normalised(system), "toml": system.to_toml_string()}


def _target(target: Target, optimum: Optimum) -> dict[str, Any]:
    goal = next((goal for goal in optimum.targets.goals if goal.target == target), None)
    return {
        "name": target.name,
        "unit": target.metric.units,
        "label": target.metric.long_name,
        "goal": None if goal is None else "maximise" if goal.maximise else "minimise",
        "limits": [
            {"sign": ">=" if limit.least else "<=", "value": limit.limit} for limit in optimum.targets.limits if limit.target == target
        ],
        "baseline": _plain(optimum.baseline.targets.get(target.name)),
        "best": _plain(optimum.best.targets.get(target.name)),
    }


def _design(one: Candidate, optimum: Optimum) -> dict[str, Any]:
    targets = [_plain(one.targets.get(target.name)) for target in optimum.targets.all]
    return {"number": one.number, "values": [_plain(value) for value in one.values], "targets": targets}


def _best_so_far(history: Sequence[Candidate], name: str) -> list[float | None]:
    """Return the objective of the best feasible design up to each evaluation."""
    found: list[float | None] = []
    best = history[0]
    for one in history:
        best = one if one.rank < best.rank else best
        found.append(best.targets[name] if best.feasible else None)
    return found


def _plain(value: Any) -> Any:
    if isinstance(value, bool | int | str) or value is None:
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return getattr(value, "name", "") or type(value).__name__  # a part of a description, such as a fluid
