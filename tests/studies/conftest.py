"""A small resolution and a cheap system for studies."""

from __future__ import annotations

import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.solver.settings import Settings
from coaxshell.studies.evaluation import Outcome, failure
from coaxshell.studies.optimisation import optimising
from coaxshell.studies.reading import DesignReading

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
        reading = DesignReading(system)
        return Outcome(tuple(m(reading) if m.of_design else float(self.functions[m.name](system)) for m in metrics))


@pytest.fixture
def analytic(monkeypatch):
    """Replace the runs of optimisations by functions of the system: inner, outer and interior stand for three metrics."""
    names = {"inner": "inner.peak_stress", "outer": "outer.peak_stress", "interior": "interior.rms_pressure"}

    def replaced(**functions):
        crew = AnalyticCrew({names[key]: function for key, function in functions.items()})
        monkeypatch.setattr(optimising, "WorkerPool", crew.pool)
        return crew

    return replaced
