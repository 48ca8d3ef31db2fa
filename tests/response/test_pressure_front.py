"""Incident fronts that rise as the scattered ones do, for pictures."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx

X = np.linspace(-3.0, -1.01, 400)
TIME = 2.6
BARE = cx.presets.load("bare")
SOURCES = {
    "spherical": BARE.source,
    "plane": cx.PlaneShock(peak_pressure=2.5e4, decay_time=1.314e-4),
    "line": cx.LineShock(distance=5.0, peak_pressure=2.5e4, decay_time=1.314e-4),
    "step": cx.PlaneWave(pulse=cx.Step(pressure=1e4)),
}


@pytest.mark.slow_except("step", "line")
@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
@pytest.mark.parametrize("name", SOURCES)
def test_it_differs_from_the_sharp_one_at_the_front_only(name):
    response = cx.simulate(BARE.replace(source=SOURCES[name]), duration=3.0, time_step=5e-3, modes=40)
    sharp, matched = (response.pressure(x=X, y=[0.0], time=TIME, front=front).values[0] for front in ("sharp", "matched"))
    difference, peak = np.abs(matched - sharp), float(np.abs(sharp).max())
    near = np.abs(X - (1.0 - TIME)) < 0.03
    assert difference[near].max() > 0.02 * peak
    assert difference[~near].max() < 2e-3 * peak


@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
def test_no_line_is_left_in_the_shadow():
    # Behind the shells the wave through them runs ahead: nothing sharp is left where the undisturbed front would be.
    response = cx.simulate(BARE, duration=3.0, time_step=5e-3, modes=100)
    jumps = [np.abs(np.diff(response.pressure(x=X, y=[0.0], time=TIME, front=front).values[0])).max() for front in ("sharp", "matched")]
    assert jumps[1] < 0.8 * jumps[0]
