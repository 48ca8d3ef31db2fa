"""A small resolution and a cheap system for studies."""

from __future__ import annotations

import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.solver.settings import Settings
from coaxshell.studies.evaluation import Outcome, failure
from coaxshell.studies.gradients.slopes import SlopeMetric
from coaxshell.studies.optimisation import optimising
from coaxshell.studies.reading import DesignReading
from coaxshell.studies.varied_fields import field_of, varied

QUICK = {"duration": 1.0, "time_step": 0.02, "modes": 6}


@pytest.fixture(scope="session")
def quick():
    """Settings of a run that takes next to no time."""
    return QUICK


@pytest.fixture(scope="session")
def resolution():
    return Settings(**QUICK)


@pytest.fixture(scope="session")
def hybrid():
    return cx.presets.load("hybrid")


class AnalyticCrew:
    """Answers with functions of the system, by the names of metrics."""

    def __init__(self, functions):
        self.functions = functions
        self.systems = []

    def pool(self, execution, metrics, store):
        self.metrics = metrics
        return self

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        pass

    def __call__(self, systems, resolution):
        self.systems += systems
        return [self._outcome(system, self.metrics) for system in systems]

    def _outcome(self, system, metrics):
        if isinstance(system, InputError):
            return failure(metrics, str(system))
        return Outcome(tuple(self._number(metric, system) for metric in metrics))

    def _number(self, metric, system):
        if isinstance(metric, SlopeMetric):
            return self._slope(metric, system) if metric.fields else self._number(metric.of, system)
        return metric(DesignReading(system)) if metric.of_design else float(self.functions[metric.name](system))

    def _slope(self, metric, system):
        """What a variable changes, by central differences of the function."""
        total = 0.0
        for path, moved in metric.fields:
            present = field_of(system, path).present
            step = 1e-5 * abs(present)
            ends = [self._number(metric.of, varied(system, {path: present + sign * step})) for sign in (1, -1)]
            total += moved * (ends[0] - ends[1]) / (2 * step)
        return total


@pytest.fixture
def analytic(monkeypatch):
    """Replace the runs of optimisations by functions of the system: inner, outer and interior stand for three metrics."""
    names = {"inner": "inner.peak_stress", "outer": "outer.peak_stress", "interior": "interior.rms_pressure"}

    def replaced(**functions):
        crew = AnalyticCrew({names[key]: function for key, function in functions.items()})
        monkeypatch.setattr(optimising, "WorkerPool", crew.pool)
        return crew

    return replaced
