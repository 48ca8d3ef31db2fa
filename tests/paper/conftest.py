"""A resolution at which a figure takes a moment, and the curve of a system solved on its own."""

from __future__ import annotations

from dataclasses import asdict, replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.paper import Runs, figure_recipe
from coaxshell.apps.paper.known_runs import CORRECTED
from coaxshell.solver.settings import Settings
from coaxshell.studies.store import Store

TINY = Settings(duration=2.5, time_step=1e-2, modes=16)
SMALL = Settings(duration=2.5, time_step=1e-2, modes=16)
"""For the claims, whose numbers need some time and some orders."""

PER_UNIT = {"stress": 1e-6, "displacement": 1e6}


@pytest.fixture(scope="session")
def drawn():
    """Return a function from the number of a figure to its figure at the tiny resolution."""
    return lambda number: figure_recipe(number).draw([cx.presets.load(name) for name in figure_recipe(number).presets], Runs(TINY), None)


@pytest.fixture(scope="session")
def direct():
    """Return a function from a system to its history at a point, in drawn units, solved by itself."""

    def solve(system, shell, angle, quantity="stress", **changes):
        response = cx.simulate(system, **{**asdict(TINY), **changes})
        return PER_UNIT[quantity] * np.asarray(getattr(response, quantity)(shell, angle=[angle]))[:, 0]

    return solve


@pytest.fixture(scope="session")
def line():
    """Return a function that gives the values of the curve of a name in a panel."""

    def find(ax, name):
        (found,) = (curve for curve in ax.lines if curve.get_label() == name)
        return np.asarray(found.get_ydata(), dtype=float)

    return find


@pytest.fixture(scope="session")
def tiny():
    return TINY


@pytest.fixture(scope="session")
def runs(tmp_path_factory):
    """Return runs at a coarse resolution that all tests of claims share."""
    return Runs(SMALL, store=Store(tmp_path_factory.mktemp("runs")))


class Changed:
    """Runs of which some are changed: *how* gets (name, run) and returns the run that is told instead."""

    def __init__(self, runs, how):
        self.runs, self.how, self.resolution, self.variant = runs, how, runs.resolution, CORRECTED
        self.fields = runs.fields

    def __call__(self, system, resolution=None):
        return self.how(system.name, self.runs(system, resolution))

    def each(self, systems, progress=None, **options):
        for name, run in self.runs.each(systems, progress, **options):
            yield name, self.how(name, run)


@pytest.fixture(scope="session")
def changed(runs):
    """Return a function that gives the shared runs, changed."""
    return lambda how: Changed(runs, how)


@pytest.fixture(scope="session")
def scaled():
    """Return a function that scales the histories of a run, on one shell or on both."""

    def scale(run, factor, shell=None):
        histories = {key: values * (factor if shell in (None, key[1]) else 1.0) for key, values in run.histories.items()}
        return replace(run, histories=histories)

    return scale
