"""The one call that identifies properties from measured histories: Gauss and Newton's method, every record on a clock of its own."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, Unpack

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.paths import within
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.keywords import showing
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.scalars import plain
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solvable import require_solvable
from coaxshell.studies.execution import Execution, StudyKeywords, asked
from coaxshell.studies.fitting.certainty import LOOSE, POORLY, Certainty, certainty
from coaxshell.studies.fitting.fitted import Fit, FittedRecord, FittedValue
from coaxshell.studies.fitting.matching import Matching
from coaxshell.studies.fitting.measurement import Measurement
from coaxshell.studies.fitting.predicting import Predicted, Predictions, with_duration
from coaxshell.studies.fitting.unknowns import STEP, Unknown, Unknowns, unknowns_of

ITERATIONS = 40
"""Steps of Gauss and Newton's method at most, each time the records are weighted anew."""
_ROUNDS = 4
_SETTLED = 0.02
"""Relative change of the noise of records below which they are weighted well enough."""
_QUIETEST = 1e-9
"""Least noise, relative to a record."""
_TOLERANCE = 1e-10
_LONGER = 1.02
_WORSE = 10.0
_EXCESS = 1.5
"""Residual over the noise told above which a record is not explained."""


@showing(StudyKeywords, Settings, Execution)
def fit(
    system: SystemLike,
    measured: Sequence[Measurement] | Measurement,
    *,
    variables: Any,
    confidence: float = 0.95,
    iterations: int = ITERATIONS,
    **keywords: Unpack[StudyKeywords],
) -> Fit:
    """Return the properties of a system with which its run comes closest to measured histories, and how certain they are.

    Least squares of (run - record)/noise over all samples by a trust region of Gauss and Newton's steps; the slopes are central
    differences of runs, made side by side, and of the clocks the rates of the run itself. Records whose noise is not told are weighted
    by what the fit leaves of them.

    Parameters
    ----------
    system : System, str or Path
        What is known, and where the search begins; it should be near, within half a period of what the records show.
    measured : list of Measurement
    variables : list of str, or mapping of path to :class:`Range` or None
        Properties by dotted path: "source.distance", "shells[0].layers[1].material.young_modulus", "fluids[1].sound_speed",
        "absorbers.damping". A range holds a value within limits; without one those of the property itself do.
    confidence : float
        Of the intervals.
    iterations : int
        Steps at most, each time the records are weighted anew.
    duration, time_step, modes, tolerance, refinement, engine, dimensions, stations, axial_modes, axial_period
        As those of :func:`coaxshell.simulate`; the duration is as long as the records unless given.
    executor, workers, store, resume, progress, dask, settings, execution
        As those of :func:`sweep`; a store keeps every run, so that an interrupted fit goes on.

    Returns
    -------
    Fit

    Raises
    ------
    InputError
        Anything wrong with records or variables, before the first run; the system itself cannot be run.
    """
    system = as_system(system)
    settings, execution = asked(system, keywords)
    given = {*keywords, *((keywords.get("settings") and ("duration",)) or ())}
    plan = plan_of(system, measured, variables, settings, long_enough="duration" not in given, limits=(confidence, iterations))
    return fit_plan(plan, execution)


@dataclass(frozen=True)
class FitPlan:
    """A fit whose parts have been checked."""

    unknowns: Unknowns
    records: tuple[Measurement, ...]
    resolution: Settings
    confidence: float
    iterations: int


def plan_of(system: System, measured: Any, variables: Any, settings: Settings, *, long_enough: bool, limits: tuple[float, int]) -> FitPlan:
    """Return the parts of a fit, checked; *long_enough* makes its runs as long as the records, *limits* are confidence and iterations."""
    records = _named([measured] if isinstance(measured, Measurement) else measured)
    for number, one in enumerate(records):
        try:
            if one.radius is None:
                system.shell_index(one.shell)
        except InputError as error:
            raise within(f"measured[{number}]", error) from None
        if one.station is not None and settings.dimensions == 2:
            raise InputError(f"measured[{number}].station", "belongs to three dimensions", "use dimensions=3, or leave it out")
        if one.quantity == "pressure" and settings.dimensions == 3:
            raise InputError(f"measured[{number}].quantity", "'pressure' is not fitted in three dimensions", "use gauges on the shells")
    if settings.dimensions == 3:
        stations = tuple(sorted({one.station or 0.0 for one in records}))
        settings = replace(settings, stations=stations)
    confidence, iterations = plain(limits[0]), plain(limits[1])
    if isinstance(confidence, bool) or not isinstance(confidence, int | float) or not 0.0 < confidence < 1.0:
        raise InputError("confidence", f"{shown(confidence)} is not allowed", "give a share of 1, such as 0.95")
    if isinstance(iterations, bool) or not isinstance(iterations, int) or iterations < 1:
        raise InputError("iterations", f"{shown(iterations)} is not allowed", "give a whole number of 1 or more")
    unknowns = unknowns_of(system, variables, records)
    if long_enough:
        begin, reach = _clocks(unknowns, records)
        end = max(one.time[one.used[-1]] - at + around for one, at, around in zip(records, begin, reach, strict=True))
        settings = with_duration(settings, _LONGER * float(end) / dimensionless(unknowns.system, settings=settings).scales.time)
    require_solvable(unknowns.system, settings)
    return FitPlan(unknowns, records, settings, float(confidence), iterations)


def _named(measured: Any) -> tuple[Measurement, ...]:
    """Return the measurements, each with a name of its own."""
    if not isinstance(measured, Sequence) or isinstance(measured, str) or not measured:
        raise InputError("measured", f"{shown(measured)} is not a list of measurements", "give at least one Measurement")
    found: list[Measurement] = []
    for number, one in enumerate(measured):
        if not isinstance(one, Measurement):
            raise InputError(f"measured[{number}]", f"{shown(one)} is not a measurement", "give a cx.Measurement")
        name = one.name or f"record {number + 1}"
        while any(name == other.name for other in found):
            name += "'"
        found.append(one if name == one.name else one.replace(name=name))
    return tuple(found)


def _clocks(unknowns: Unknowns, records: Sequence[Measurement]) -> tuple[FloatArray, FloatArray]:
    """Return where the clock of each record begins, s, and how far from there it may be."""
    begin = unknowns.offsets(np.zeros(len(unknowns.all)), records)
    reach = np.zeros(len(records))
    for one in unknowns.clocks:
        reach[list(one.records)] = one.high - one.start
    return begin, reach


def fit_plan(plan: FitPlan, execution: Execution) -> Fit:
    """Return the answer of a fit whose parts have been checked; see :func:`fit`."""
    with execution.started() as ready, Predictions([one.gauge for one in plan.records], plan.resolution, ready) as predictions:
        return _Search(plan, predictions, ready).answer()


class _Search:
    """Steps of Gauss and Newton's method, with what has been run so far at hand."""

    def __init__(self, plan: FitPlan, predictions: Predictions, execution: Execution) -> None:
        self._plan, self._unknowns, self._predictions = plan, plan.unknowns, predictions
        self._report = execution.progress or (lambda fraction, stage: None)
        self._first = self._run(np.zeros(len(self._unknowns.all)))
        begin, reach = _clocks(self._unknowns, plan.records)
        self._matching = Matching(plan.records, begin, reach, float(self._first.time[-1]))
        self._noise = self._matching.noise_to_begin_with
        self._told = [one.noise is not None for one in plan.records]
        self._worst, self._steps = math.nan, 0

    def answer(self) -> Fit:
        """Search, weigh the records by what is left of them, search again until that settles."""
        from scipy.optimize import least_squares

        x = self._clocks_set(np.zeros(len(self._unknowns.all)))
        low, high = self._unknowns.bounds
        converged = False
        for round_ in range(_ROUNDS):
            inside = np.clip(x, np.nextafter(low, high), np.nextafter(high, low))
            self._worst = float(np.linalg.norm(self._missing(inside, required=True)))
            keywords: dict[str, Any] = {"bounds": (low, high), "x_scale": "jac", "max_nfev": self._plan.iterations}
            tolerances: dict[str, Any] = dict.fromkeys(("ftol", "xtol", "gtol"), _TOLERANCE)
            found = least_squares(self._missing, inside, jac=self._slopes, method="trf", **keywords, **tolerances)
            x, converged = np.asarray(found.x), found.status > 0
            noise = self._weighed(x)
            settled = bool(np.all(np.abs(noise - self._noise) <= _SETTLED * self._noise))
            self._noise = noise
            if settled or all(self._told):
                break
            self._report(min(0.9, (round_ + 1) / _ROUNDS), "weighing the records anew")
        return self._told_as_fit(x, converged=converged)

    def _run(self, x: FloatArray) -> Predicted:
        """Return what the system at coordinates shows; InputError if it cannot be run."""
        system = self._unknowns.at(x)
        if isinstance(system, InputError):
            raise system
        (found,) = self._predictions([system])
        if found.reason:
            raise InputError("system", f"cannot be run: {found.reason}", "change it, or give narrower ranges")
        return found

    def _clocks_set(self, x: FloatArray) -> FloatArray:
        """Return coordinates with each clock where the run at the start comes closest to its records."""
        found, properties = x.copy(), len(self._unknowns.properties)
        for k, one in enumerate(self._unknowns.clocks):
            at = self._matching.offset(self._first, one.records, one.low, one.high, self._noise)
            found[properties + k] = one.coordinate(at)
        return found

    def _missing(self, x: FloatArray, *, required: bool = False) -> FloatArray:
        self._steps += 1
        self._report(min(0.9, self._steps / (self._steps + 10.0)), "fitting")
        system = self._unknowns.at(x)
        (found,) = self._predictions([system])
        if found.reason:
            if required:
                raise InputError("system", f"cannot be run: {found.reason}", "change it, or give narrower ranges")
            return np.full(self._matching.count, _WORSE * self._worst / math.sqrt(self._matching.count))
        return self._matching.missing(found, self._unknowns.offsets(x, self._plan.records), self._noise)

    def _slopes(self, x: FloatArray) -> FloatArray:
        """Return the Jacobian of the residuals, shape (samples, unknowns)."""
        low, high = self._unknowns.bounds
        properties, offsets = len(self._unknowns.properties), self._unknowns.offsets(x, self._plan.records)
        points = []
        for k in range(properties):
            for sign in (-1.0, 1.0):
                moved = x.copy()
                moved[k] = min(max(x[k] + sign * STEP, low[k]), high[k])
                points.append(moved)
        here, *beside = self._predictions([self._unknowns.at(point) for point in [x, *points]])
        jacobian = np.zeros((self._matching.count, x.size))
        at_x = self._matching.missing(here, offsets, self._noise)
        for k in range(properties):
            ends = [(float(points[j][k]), beside[j]) for j in (2 * k, 2 * k + 1)]
            rows = [
                (at, at_x if at == x[k] else self._matching.missing(found, offsets, self._noise)) for at, found in ends if not found.reason
            ]
            if len(rows) == 1:
                rows.append((float(x[k]), at_x))
            if len(rows) == 2 and rows[0][0] != rows[1][0]:
                jacobian[:, k] = (rows[1][1] - rows[0][1]) / (rows[1][0] - rows[0][0])
        for k, one in enumerate(self._unknowns.clocks, start=properties):
            for number in one.records:
                slope = self._matching.shown(here, number, float(offsets[number])).slope
                jacobian[self._matching.rows[number], k] = -slope * one.size / self._noise[number]
        return jacobian

    def _weighed(self, x: FloatArray) -> FloatArray:
        """Return the noise of each record: as told, or the RMS of what is left of it."""
        left = self._missing(x) * np.concatenate(
            [np.full(rows.stop - rows.start, noise) for rows, noise in zip(self._matching.rows, self._noise, strict=True)]
        )
        share = 1.0 - len(self._unknowns.all) / max(self._matching.count, len(self._unknowns.all) + 1)
        found = self._noise.copy()
        for k, (rows, values) in enumerate(zip(self._matching.rows, self._matching.values, strict=True)):
            if not self._told[k]:
                rest = float(np.sqrt(np.mean(left[rows] ** 2) / share))
                found[k] = max(rest, _QUIETEST * float(np.sqrt(np.mean(values**2))), 1e-300)
        return found

    def _told_as_fit(self, x: FloatArray, *, converged: bool) -> Fit:
        plan, unknowns, matching = self._plan, self._unknowns, self._matching
        how = certainty(self._slopes(x), self._missing(x), matching.rows, self._told, plan.confidence)
        loose = {i for direction in how.loose for i, _ in direction}
        values = [_value(one, float(at), k, how, k in loose) for k, (one, at) in enumerate(zip(unknowns.all, x, strict=True))]
        here, offsets = self._run(x), unknowns.offsets(x, plan.records)
        records = []
        for k, one in enumerate(plan.records):
            modelled, y = matching.shown(here, k, float(offsets[k])).values, matching.values[k]
            left = float(np.sqrt(np.mean((y - modelled) ** 2)))
            told = (one.name, one.quantity, one.place, one.unit, matching.time[k] - offsets[k], y, modelled)
            records.append(FittedRecord(*told, float(self._noise[k]), left, float(how.correlated[k])))
        names = [one.name for one in values]
        correlation = xr.DataArray(how.correlation, dims=("value", "other"), coords={"value": names, "other": names})
        system = unknowns.at(x)
        assert isinstance(system, System)
        name = unknowns.system.name.removesuffix("fitted").removesuffix(", ")
        return Fit(
            system.replace(name=f"{name}, fitted" if name else "fitted"),
            tuple(values),
            correlation,
            tuple(_sentence(direction, values, unknowns.all) for direction in how.loose),
            tuple(_remarks(values, how, loose, plan.records, converged)),
            tuple(records),
            plan.confidence,
            plan.resolution,
            self._predictions.runs,
            converged,
        )


def _value(one: Unknown, at: float, number: int, how: Certainty, loose: bool) -> FittedValue:
    deviation = float(how.deviation[number])
    value, reach = one.value(at), how.factor * deviation
    low, high = sorted((one.value(at - reach), one.value(at + reach)))
    size = abs(value) if one.log else one.size
    limits = [x for x in (one.low, one.high) if math.isfinite(x)]
    at_limit = any(abs(value - x) <= 1e-6 * one.size for x in limits)
    return FittedValue(one.name, one.unit, one.long_name, one.start, value, deviation * size, low, high, not loose, at_limit)


def _sentence(direction: list[tuple[int, float]], values: Sequence[FittedValue], unknowns: Sequence[Unknown]) -> str:
    """Return in words what moves along a direction that records do not tell."""
    names = [values[i].name for i, _ in direction]
    if len(names) == 1:
        return f"{names[0]} (the records hardly feel it: its standard deviation is beyond {100 * LOOSE:g} % of itself)"
    sizes = [abs(values[i].value) if unknowns[i].log else unknowns[i].size for i, _ in direction]
    moves = [f"{values[i].name} by {share * size:+.2g} {values[i].unit}" for (i, share), size in zip(direction, sizes, strict=True)]
    together = f"{', '.join(moves[:-1])} and {moves[-1]}"
    return f"{', '.join(names[:-1])} and {names[-1]} but in combination (the records stay nearly the same if {together} change together)"


def _remarks(values: Sequence[FittedValue], how: Certainty, loose: set[int], records: Sequence[Measurement], converged: bool) -> list[str]:
    found = [] if converged else ["the search has not converged: give more iterations, or begin nearer"]
    found += [
        f"{values[j].name} and {values[i].name} are told apart poorly: correlation {how.correlation[i, j]:+.3f}"
        for i in range(len(values))
        for j in range(i)
        if not loose & {i, j} and abs(how.correlation[i, j]) > POORLY
    ]
    found += [f"{one.name} ended at a limit of its range, {one.value:.5g} {one.unit}" for one in values if one.at_limit]
    return found + [
        f"{one.name} is met to {spread:.1f} times its noise only: the model lacks something, and intervals do not guard against that"
        for one, spread in zip(records, how.spread, strict=True)
        if one.noise is not None and spread > _EXCESS
    ]
