"""A small resolution and a cheap system for studies."""

from __future__ import annotations

import pytest

import coaxshell as cx
from coaxshell.studies.resolution import Resolution

QUICK = {"duration": 1.0, "time_step": 0.02, "modes": 6}


@pytest.fixture(scope="session")
def quick():
    """Settings of a run that takes next to no time."""
    return QUICK


@pytest.fixture(scope="session")
def resolution():
    return Resolution(**QUICK)


@pytest.fixture(scope="session")
def hybrid():
    return cx.presets.load("hybrid")
