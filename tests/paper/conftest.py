"""A resolution at which a figure takes a moment, and the curve of a system solved on its own."""

from __future__ import annotations

from dataclasses import asdict

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.paper import Resolution, Runs, figure_recipe

TINY = Resolution(duration=2.5, time_step=1e-2, modes=16)
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
