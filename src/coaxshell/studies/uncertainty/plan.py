"""A study of uncertain properties with all its parts checked: which systems are run, and what tells it from another."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from coaxshell.errors import InputError
from coaxshell.model.system import System
from coaxshell.numerics.scalars import plain
from coaxshell.solver.settings import Settings
from coaxshell.studies.design import Design
from coaxshell.studies.metrics import Metric
from coaxshell.studies.uncertainty.distributions import Uncertain, coordinates_of, unit_points
from coaxshell.studies.uncertainty.statistics import blocks

FEWEST = 8
MOST_RUNS = 1_000_000


@dataclass(frozen=True)
class Plan:
    """What a study of uncertain properties runs.

    Attributes
    ----------
    system : System
        The nominal one.
    uncertain : Uncertain
        The properties, and the point of every run.
    metrics : tuple of Metric
    resolution : Settings
    samples, seed : int
    confidence : float
        Of the intervals.
    indices : bool
        Whether the points are Saltelli's, from which indices follow, or one sample.
    """

    system: System
    uncertain: Uncertain
    metrics: tuple[Metric, ...]
    resolution: Settings
    samples: int
    seed: int
    confidence: float
    indices: bool

    @property
    def paths(self) -> list[str]:
        """The uncertain fields."""
        return [coordinate.field.path for coordinate in self.uncertain.coordinates]

    @cached_property
    def systems(self) -> list[System | InputError]:
        """The system of every run, or why there is none."""
        return [self.uncertain.sample(self.system, point) for point in self.uncertain.points]

    @property
    def design(self) -> Design:
        """The runs as points of a sweep, for their labels."""
        present = [coordinate.field.present for coordinate in self.uncertain.coordinates]
        columns = [
            tuple(coordinate.quantile(point[i], present[i]) for point in self.uncertain.points)
            for i, coordinate in enumerate(self.uncertain.coordinates)
        ]
        fields = tuple(coordinate.labelled for coordinate in self.uncertain.coordinates)
        return Design(fields, "sobol", tuple(columns), ("linear",) * len(fields))

    @property
    def parts(self) -> dict[str, Any]:
        """What tells this study from another, as plain data by part."""
        return {
            "scenario": self.system.canonical(),
            "kind": "indices" if self.indices else "statistics",
            "uncertain": self.uncertain.identity()[: len(self.uncertain.coordinates)],
            "samples and seed": [self.samples, self.seed],
            "metrics": {metric.name: metric.identity for metric in self.metrics},
            "resolution": self.resolution.arguments(),
        }


def plan_of(
    system: System,
    uncertain: Mapping[str, Any],
    metrics: tuple[Metric, ...],
    resolution: Settings,
    sampling: tuple[int, int, float],
    *,
    indices: bool,
    where: str = "uncertain",
) -> Plan:
    """Return a study with its parts checked; *sampling* is (samples, seed, confidence).

    Raises
    ------
    InputError
        See :func:`coaxshell.studies.uncertainty.distributions.uncertain_of`; too few samples, not a power of two though indices
        are asked for, too many runs, an impossible confidence, indices of a single property.
    """
    samples, seed, confidence = map(plain, sampling)
    if isinstance(confidence, bool) or not isinstance(confidence, int | float) or not 0.5 <= confidence < 1:
        raise InputError("confidence", f"{confidence!r} is not allowed", "give a share from 0.5 to below 1, such as 0.95")
    coordinates = coordinates_of(system, uncertain, where)
    if not isinstance(samples, int) or isinstance(samples, bool) or samples < FEWEST:
        raise InputError("samples", f"{samples!r} is not allowed", f"give a whole number of {FEWEST} or more")
    dimensions = len(coordinates)
    if indices:
        _enough(samples, dimensions, where)
        points = blocks(dimensions, samples, seed).reshape(-1, dimensions)
    else:
        points = unit_points(dimensions, samples, seed)
    chosen = Uncertain(coordinates, tuple(tuple(map(float, point)) for point in points))
    return Plan(system, chosen, metrics, resolution, samples, seed, confidence, indices)


def _enough(samples: int, dimensions: int, where: str) -> None:
    """Refuse what no indices follow from."""
    if samples & (samples - 1):
        near = 2 ** round(math.log2(samples))
        raise InputError("samples", f"{samples} is not a power of two", f"the balance of Sobol points needs one, such as {near}")
    if dimensions < 2:
        remedy = "give two or more, or ask for statistics alone (robustness, indices = false)"
        raise InputError(where, "only one property is uncertain, and all the variance is its own", remedy)
    if samples * (dimensions + 2) > MOST_RUNS:
        raise InputError("samples", f"asks for {samples * (dimensions + 2)} runs", f"at most {MOST_RUNS} are allowed")
