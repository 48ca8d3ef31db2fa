"""Search by gradients: sequential quadratic programming from several starts side by side.

Every evaluation is a run forwards and one backwards for each metric, whatever the number of variables. A peak is searched as a mean of
a power (:mod:`coaxshell.studies.gradients.norms`), which is smooth; designs are compared by the peak itself. Limits on peaks hold the
peak itself, with the slope of the mean in proportion (C. Le et al., Stress-based topology optimization for continua, Struct. Multidisc.
Optim. 41 (2010) 605-620). The starts take their steps together, so that their runs share all workers and nothing depends on who is
faster; one that has arrived begins anew elsewhere. Counts and choices are an outer loop: every combination of them has starts of its
own, and after each round of steps the better half of the combinations goes on (successive halving: K. Jamieson, A. Talwalkar,
Non-stochastic best arm identification and hyperparameter optimization, AISTATS 2016).
"""

from __future__ import annotations

import itertools
import math
import re
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import product
from queue import Queue
from typing import Any, NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import stats
from coaxshell.studies.gradients.sensitivity import neighbours
from coaxshell.studies.gradients.slopes import slope_metrics
from coaxshell.studies.optimisation.targets import Limit, Target, Targets
from coaxshell.studies.optimisation.variables import Space, Variable

POWER = 64.0
"""Power of the mean that stands for a peak in the search."""
STARTS = 4
"""Starts side by side, unless told otherwise."""
MOST_COMBINATIONS = 32
"""Combinations of counts and choices that are all tried."""
ROUND = 6
"""Steps of every start after which the worse half of the combinations is given up."""
_STATISTICS = ("", "mean", "worst")
_ANGLE = re.compile(r"absorbers\[(\d+)\]\.angle")
_PRECISION = 1e-8
_UNSOLVED = 10.0
"""What a design that cannot be run is worse by than the last one, in units of the first: the step towards it is shortened."""
_INSIDE = 1e-7
"""Relative distance from a limit at which the search stays: a design on the limit keeps it then, whatever is rounded."""

Tables = Callable[[FloatArray], list[FloatArray | None]]
"""From points, shape (K, n), to the metrics of each, shape (samples, metrics); None for a design that could not be run."""


class Linear(NamedTuple):
    """A design's searched objective and limits (at least 0 where kept), with their slopes in the unit cube."""

    objective: float
    slope: FloatArray
    limits: FloatArray
    limit_slopes: FloatArray


class Arc(NamedTuple):
    """The distance between two neighbours, m, linear in the variables: offset + by x."""

    offset: float
    by: FloatArray


@dataclass(frozen=True)
class Slopes:
    """What a search by gradients reads from the metrics of a design.

    Attributes
    ----------
    targets : Targets
        With the metrics that hold slopes.
    space : Space
    """

    targets: Targets
    space: Space

    @property
    def variables(self) -> tuple[Variable, ...]:
        """What the search varies: the variables of its space."""
        return self.space.variables

    @classmethod
    def of(cls, space: Space, targets: Targets, uncertain: set[str]) -> Slopes:
        """Return them for an optimisation; *uncertain* are the paths of properties that vary by themselves.

        Raises
        ------
        InputError
            Counts have too many combinations, or nothing varies beside them; a variable is uncertain too; a metric or a statistic has no
        gradient.
        """
        many = math.prod(len(variable.levels) for variable in space.variables if variable.levels)
        if many > MOST_COMBINATIONS:
            problem = f'"gradient" tries every combination of counts and choices, and there are {many}'
            raise InputError("method", problem, f'use method="cma-es", or at most {MOST_COMBINATIONS} combinations')
        if all(variable.levels for variable in space.variables):
            raise InputError("method", '"gradient" needs a variable that varies continuously', 'use method="cma-es"')
        for variable in space.variables:
            paths = (*variable.paths, *variable.mirrored)
            both = uncertain & {*paths, *(f"absorbers.{path.split('.')[-1]}" for path in paths if path.startswith("absorbers"))}
            if both:
                raise InputError("method", f'"gradient" cannot vary what is uncertain too: {min(both)}', 'use method="cma-es"')
        wrong = next((target.name for target in targets.all if target.statistic not in _STATISTICS), None)
        if wrong is not None:
            raise InputError("method", f'"gradient" knows mean and worst of uncertain properties, not {wrong}', 'use method="cma-es"')
        moved = [
            () if one.levels else (*((path, 1.0) for path in one.paths), *((path, -1.0) for path in one.mirrored))
            for one in space.variables
        ]
        more = tuple(slope for metric in targets.metrics for slope in slope_metrics(metric, POWER, moved))
        return cls(replace(targets, metrics=(*targets.metrics, *more)), space)

    def __call__(self, table: FloatArray, point: FloatArray, arcs: list[Arc]) -> Linear:
        """Return a design to first order.

        Parameters
        ----------
        table : ndarray, shape (samples, metrics)
        point : ndarray, shape (n,)
            Its place in the unit cube.
        arcs : list of Arc
            What a limit on the spacing holds.
        """
        stretch = np.array([_stretch(one, float(share)) for one, share in zip(self.variables, point, strict=True)])
        goal = self.targets.goals[0]
        searched, slope, _ = self._target(table, goal.target)
        sign = -1.0 if goal.maximise else 1.0
        limits: list[float] = []
        slopes: list[FloatArray] = []
        for limit in self.targets.limits:
            if _of_spacing(limit):
                size = limit.limit or 1.0
                limits += [(arc.offset + float(arc.by @ self._si(point)) - limit.limit) / size - _INSIDE for arc in arcs]
                slopes += [arc.by * stretch / size for arc in arcs]
                continue
            mean, by, exact = self._target(table, limit.target)
            scale = (1.0 if limit.least else -1.0) / (abs(limit.limit) or 1.0)
            limits.append(scale * (exact - limit.limit) - _INSIDE)
            slopes.append(scale * (exact / mean if mean else 1.0) * by * stretch)
        return Linear(
            sign * searched,
            sign * slope * stretch,
            np.array(limits),
            np.array(slopes).reshape(len(limits), len(stretch)),
        )

    def arcs(self, point: FloatArray) -> list[Arc]:
        """Return the neighbours whose distance varies, as they stand at a point: the least of their arcs has corners, each has none.

        Mirror images are left out, whose arcs say the same.
        """
        spaced = any(_of_spacing(limit) for limit in self.targets.limits)
        system = self.space.system(self.space.values(point)) if spaced else None
        if not isinstance(system, System):
            return []
        turned = np.zeros((len(system.absorber_list), len(self.variables)))
        for column, variable in enumerate(self.variables):
            for paths, sign in ((variable.paths, 1.0), (variable.mirrored, -1.0)):
                for match in filter(None, map(_ANGLE.fullmatch, paths)):
                    turned[int(match[1]), column] = sign
        found: dict[tuple[float, ...], Arc] = {}
        for one, other, radius, arc in neighbours(system):
            by = np.radians(radius) * (turned[other] - turned[one])
            if by.any():
                found.setdefault((round(arc, 6), *by), Arc(arc - float(by @ self._si(point)), by))
        return list(found.values())

    def _si(self, point: FloatArray) -> FloatArray:
        """Return the values of the variables at a point."""
        return np.array(self.space.values(point), dtype=np.float64)

    def _target(self, table: FloatArray, target: Target) -> tuple[float, FloatArray, float]:
        """Return a target as it is searched, its slopes by the variables in SI, and its exact value."""
        columns, n = {metric.name: k for k, metric in enumerate(self.targets.metrics)}, len(self.variables)
        exact = target.value(table[:, columns[target.metric.name]])
        first = columns[f"{target.metric.name} as searched"]
        means, slopes = table[:, first], table[:, first + 1 : first + 1 + n]
        if not target.statistic:
            return float(means[0]), slopes[0], exact
        if target.statistic == "mean":
            return float(means[1:].mean()), slopes[1:].mean(axis=0), exact
        worst = 1 + int(np.argmax(means[1:]))
        return float(means[worst]), slopes[worst], exact


def _of_spacing(limit: Limit) -> bool:
    """Return whether a limit holds absorbers apart."""
    return limit.least and limit.target.metric.quantity == "absorber_spacing" and not limit.target.statistic


def _stretch(variable: Variable, share: float) -> float:
    """Return what a variable changes by per unit of its place in the unit cube; nothing where its values are counted."""
    if variable.levels:
        return 0.0
    if variable.log:
        return float(np.log(variable.high / variable.low) * variable.at(share))
    return variable.high - variable.low


class _StoppedError(Exception):
    """The search has ended."""


class _NowhereError(Exception):
    """A descent would begin where nothing can be run."""


class _Start(threading.Thread):
    """One descent after another in a thread, which asks for designs and waits for them."""

    def __init__(self, number: int, first: FloatArray, slopes: Slopes, seed: int, combination: int = 0) -> None:
        super().__init__(daemon=True, name=f"start {number}")
        self.asked: Queue[FloatArray | BaseException] = Queue()
        self.answer: Queue[FloatArray | None] = Queue()
        self.stopped, self.combination, self.best = False, combination, math.inf
        self._counted = np.array([bool(one.levels) for one in slopes.variables])
        self._first, self._slopes, self._rng = first, slopes, np.random.default_rng([seed, number])
        self._at: FloatArray | None = None
        self._linear: Linear | None = None
        self._arcs: list[Arc] = []

    def run(self) -> None:
        """Descend until the search ends; an error is handed to whoever waits."""
        point = self._first
        try:
            while True:
                with suppress(_NowhereError):
                    self._descend(point)
                point = np.where(self._counted, point, self._rng.random(point.size))
        except _StoppedError:
            pass
        except BaseException as error:  # noqa: BLE001 - raised again in the thread that waits
            self.asked.put(error)

    def _descend(self, point: FloatArray) -> None:
        from scipy.optimize import minimize

        self._linear, self._size, self._arcs = None, 1.0, self._slopes.arcs(point)
        self._size = abs(self._at_point(np.asarray(point)).objective) or 1.0
        constraints: Any = []
        if self._slopes.targets.limits:
            constraints = {"type": "ineq", "fun": lambda x: self._at_point(x).limits, "jac": lambda x: self._at_point(x).limit_slopes}
        keywords: Any = {
            "jac": lambda x: self._at_point(x).slope / self._size,
            "bounds": [(at, at) if held else (0.0, 1.0) for at, held in zip(point.tolist(), self._counted, strict=True)],
            "constraints": constraints,
            "options": {"ftol": _PRECISION, "maxiter": 10_000},
        }
        objective: Any = lambda x: self._at_point(x).objective / self._size  # noqa: E731 - the library's types want another kind of function
        minimize(objective, point, method="SLSQP", **keywords)

    def _at_point(self, x: FloatArray) -> Linear:
        point = np.clip(x, 0.0, 1.0)
        if self._linear is None or self._at is None or not np.array_equal(point, self._at):
            self.asked.put(point.copy())
            table = self.answer.get()
            if self.stopped:
                raise _StoppedError
            self._linear = self._worse() if table is None else self._slopes(table, point, self._arcs)
            self._at = point.copy()
            if table is not None and (self._linear.limits >= -2.0 * _INSIDE).all():
                self.best = min(self.best, self._linear.objective)
        return self._linear

    def _worse(self) -> Linear:
        """Return something in the place of a design that could not be run: the last one, but worse."""
        if self._linear is None:
            raise _NowhereError
        return self._linear._replace(objective=self._linear.objective + _UNSOLVED * self._size)


def search_by_gradient(tables: Tables, slopes: Slopes, start: FloatArray, starts: int | None, seed: int) -> None:
    """Search until *tables* raises.

    Parameters
    ----------
    tables : callable
    slopes : Slopes
    start : ndarray, shape (n,)
        The base system's place, where the first start begins; the others in a Latin hypercube.
    starts : int or None
        Of each combination of counts.
    seed : int
    """
    shares = [[(k + 0.5) / len(one.levels) for k in range(len(one.levels))] if one.levels else [math.nan] for one in slopes.variables]
    combinations = np.array(list(product(*shares)))  # NaN where a variable is not counted
    count = starts or (STARTS if len(combinations) == 1 else 1)
    points = stats.qmc.LatinHypercube(start.size, rng=seed).random(count)
    points[0] = start
    placed = [np.where(np.isnan(one), point, one) for one in combinations for point in points]
    runners = [_Start(number, point, slopes, seed, number // count) for number, point in enumerate(placed)]
    every = list(runners)
    for runner in runners:
        runner.start()
    try:
        for step in itertools.count():
            asked = [runner.asked.get() for runner in runners]
            for one in asked:
                if isinstance(one, BaseException):
                    raise one
            if step and step % ROUND == 0:  # every start has read its last answer by now
                kept = _better_half(runners)
                asked = [one for runner, one in zip(runners, asked, strict=True) if runner in kept]
                runners = kept
            for runner, table in zip(runners, tables(np.array(asked)), strict=True):
                runner.answer.put(table)
    finally:
        for runner in every:
            runner.stopped = True
            runner.answer.put(None)
        for runner in every:
            runner.join()


def _better_half(runners: list[_Start]) -> list[_Start]:
    """Return the starts of the better half of the combinations; a start that is left out waits for an answer until the search ends."""
    best: dict[int, float] = {}
    for runner in runners:
        best[runner.combination] = min(best.get(runner.combination, math.inf), runner.best)
    kept = sorted(best, key=lambda one: (best[one], one))[: (len(best) + 1) // 2]
    return [runner for runner in runners if runner.combination in kept]
