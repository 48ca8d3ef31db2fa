"""What an optimisation is after: objectives and limits on metrics, and how designs compare (feasibility first)."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.limits import EXPRESSION
from coaxshell.model.base import shown
from coaxshell.model.system import System
from coaxshell.model.units import DIMENSIONS, Dimension, to_si
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response import Response
from coaxshell.studies.metrics import ANYWHERE, Metric, metrics_of
from coaxshell.studies.uncertainty.statistics import ROBUST, statistic
from coaxshell.studies.user_functions import UserCode

UNSOLVED, FAILED = 1e6, 1e12
"""Added to the violation of a design that breaks a limit before any run, and of one whose run is refused: worse than any limit broken
in a run, and worst of all."""

_STATISTIC = re.compile(rf"({'|'.join(ROBUST)})\((.+)\)")
_LIMIT = re.compile(r"(.+?)\s*(<=|>=)\s*(.+)")


@dataclass(frozen=True)
class Objective:
    """A metric to make small, or large with ``maximise=True``.

    Attributes
    ----------
    metric : str or callable
        Its name, "mean(NAME)", "p95(NAME)" or "worst(NAME)" over the uncertain properties, or a function of a Response.
    maximise : bool
    """

    metric: str | Callable[[Response], float]
    maximise: bool = False


@dataclass(frozen=True)
class Target:
    """A metric, or a statistic of it over uncertain properties ("" for the nominal system)."""

    metric: Metric
    statistic: str = ""

    @property
    def name(self) -> str:
        """Name of the metric, as the user wrote it, within its statistic."""
        return f"{self.statistic}({self.metric.name})" if self.statistic else self.metric.name

    def value(self, samples: FloatArray) -> float:
        """Return its value from those of the nominal system and, after it, of each sample of the uncertain ones."""
        if not self.statistic:
            return float(samples[0])
        return statistic(self.statistic, samples[1:])


@dataclass(frozen=True)
class Limit:
    """A constraint: a target at most, or at least, a limit in SI."""

    target: Target
    limit: float
    least: bool

    @property
    def text(self) -> str:
        """The constraint as a user would write it, in SI."""
        return f"{self.target.name} {'>=' if self.least else '<='} {self.limit:g} {self.target.metric.units}".removesuffix(" 1")

    def excess(self, value: float) -> float:
        """Return by how much a value breaks the limit, relative to it; 0 if it does not."""
        over = self.limit - value if self.least else value - self.limit
        return max(0.0, over) / (abs(self.limit) or 1.0)


@dataclass(frozen=True)
class Goal:
    """One objective."""

    target: Target
    maximise: bool = False


@dataclass(frozen=True)
class Targets:
    """All that is asked of a design.

    Attributes
    ----------
    goals : tuple of Goal
    limits : tuple of Limit
    metrics : tuple of Metric
        Every metric that they need, each once.
    """

    goals: tuple[Goal, ...]
    limits: tuple[Limit, ...]
    metrics: tuple[Metric, ...]

    @property
    def statistics(self) -> bool:
        """Whether any of them is a statistic over uncertain properties."""
        return any(target.statistic for target in self.all)

    @property
    def all(self) -> tuple[Target, ...]:
        """Goals and limits, each target once."""
        found = [goal.target for goal in self.goals] + [limit.target for limit in self.limits]
        return tuple(dict.fromkeys(found))

    def values(self, table: FloatArray) -> dict[str, float]:
        """Return the value of each target by name from the metrics, shape (samples, metrics)."""
        column = {metric.name: k for k, metric in enumerate(self.metrics)}
        return {target.name: target.value(table[:, column[target.metric.name]]) for target in self.all}

    def objectives(self, values: Mapping[str, float]) -> tuple[float, ...]:
        """Return what is to be made small."""
        return tuple((-1.0 if goal.maximise else 1.0) * values[goal.target.name] for goal in self.goals)

    def violation(self, values: Mapping[str, float]) -> float:
        """Return the sum of all relative excesses over the limits whose targets are given; 0 for a feasible design."""
        return sum(limit.excess(values[limit.target.name]) for limit in self.limits if limit.target.name in values)


def energy(objective: FloatArray, violation: FloatArray) -> FloatArray:
    """Return numbers that order designs by Deb's feasibility rules.

    A feasible design is better than any other, of two feasible ones the one of the smaller objective, of two others the one of the
    smaller violation: K. Deb, An efficient constraint handling method for genetic algorithms, Comput. Methods Appl. Mech. Eng. 186
    (2000) 311-338.
    """
    return np.where(violation > 0.0, 1e100 * (1.0 + violation), objective)


def targets_of(objectives: Any, constraints: Any, system: System, code: UserCode = ANYWHERE) -> Targets:
    """Return what is asked of a design, checked against the base system.

    Raises
    ------
    InputError
        There is no objective, a metric is unknown, a constraint is not ``METRIC <= LIMIT``, its unit is wrong, or nothing meets it.
    """
    asked = _listed(objectives, "objectives")
    if not asked:
        raise InputError("objectives", "there are none", "name at least one, such as inner.peak_stress")
    goals = tuple(_goal(item, f"objectives[{k}]", system, code) for k, item in enumerate(asked))
    limits = tuple(_limit(item, f"constraints[{k}]", system, code) for k, item in enumerate(_listed(constraints, "constraints")))
    names = [goal.target.name for goal in goals]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError("objectives", f"{twice!r} is given twice", "give each once")
    every = dict.fromkeys([goal.target.metric for goal in goals] + [limit.target.metric for limit in limits])
    return Targets(goals, limits, tuple(every))


def _listed(given: Any, where: str) -> list[Any]:
    if given is None:
        return []
    if isinstance(given, str | Objective) or callable(given) or (isinstance(given, Mapping) and "metric" in given):
        return [given]
    if isinstance(given, Mapping) or not isinstance(given, Sequence):
        raise InputError(where, f"{shown(given)} is not a list", 'give one such as ["inner.peak_stress"]')
    return list(given)


def _goal(item: Any, where: str, system: System, code: UserCode) -> Goal:
    if isinstance(item, Mapping):
        unknown = sorted(set(item) - {"metric", "maximise"})
        if unknown:
            raise InputError(f"{where}.{unknown[0]}", "is not an entry of an objective", "allowed: metric, maximise")
        if "metric" not in item:
            raise InputError(f"{where}.metric", "is missing", "name one, such as inner.peak_stress")
        if not isinstance(item.get("maximise", False), bool):
            raise InputError(f"{where}.maximise", f"{shown(item['maximise'])} is not allowed", "must be true or false")
        item = Objective(item["metric"], item.get("maximise", False))
    if isinstance(item, Objective):
        return Goal(_target(item.metric, where, system, code), item.maximise)
    return Goal(_target(item, where, system, code))


def _target(item: Any, where: str, system: System, code: UserCode) -> Target:
    statistic = ""
    if isinstance(item, str):
        EXPRESSION.check(len(item), where)
    if isinstance(item, str) and (match := _STATISTIC.fullmatch(item.strip())):
        statistic, item = match.groups()
    try:
        return Target(metrics_of([item], system, code)[0], statistic)
    except InputError as error:
        raise InputError(error.where.replace("metrics[0]", where), error.problem, error.remedy) from None


def _limit(item: Any, where: str, system: System, code: UserCode) -> Limit:
    if isinstance(item, str):
        EXPRESSION.check(len(item), where)
    match = _LIMIT.fullmatch(item.strip()) if isinstance(item, str) else None
    if match is None:
        raise InputError(
            where, f"{shown(item)} is not a constraint", 'write "METRIC <= LIMIT" or "METRIC >= LIMIT", as in "absorbers.mass <= 250 kg/m"'
        )
    name, sign, text = match.groups()
    target = _target(name, where, system, code)
    if target.metric.function is not None and not code.run:
        return Limit(target, 0.0, sign == ">=")  # its unit is not known yet
    try:
        limit = to_si(text, _dimension(target.metric.units))
    except InputError as error:
        raise InputError(where, error.problem, error.remedy) from None
    if sign == "<=" and limit < 0 and target.metric.function is None:
        raise InputError(where, f"{item!r} is impossible", f"{target.metric.name} is never below 0")
    return Limit(target, limit, sign == ">=")


def _dimension(units: str) -> Dimension:
    unit = "" if units == "1" else units
    known = next((dimension for dimension in DIMENSIONS.values() if dimension.unit == unit), None)
    return known or Dimension(f"a quantity in {unit}", unit, f"1 {unit}")
