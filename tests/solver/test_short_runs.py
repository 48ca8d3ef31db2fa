"""A short run is the beginning of a long one, whichever the source: also where the wave takes longer to pass than the period."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx

PULSE = {"peak_pressure": 2.5e4, "decay_time": 1.314e-4}


@pytest.mark.parametrize(
    "source", [cx.SphericalShock(distance=5.0, **PULSE), cx.LineShock(distance=5.0, **PULSE), cx.PlaneShock(**PULSE)], ids=lambda s: s.type
)
@pytest.mark.parametrize("duration", [0.2, 0.5, 0.8])
def test_a_short_run_is_the_beginning_of_a_long_one(source: object, duration: float) -> None:
    system = cx.presets.load("bare").replace(source=source)
    long = cx.simulate(system, duration=2.0, time_step=2e-3, modes=20).solution.normal
    short = cx.simulate(system, duration=duration, time_step=2e-3, modes=20).solution.normal
    begin = long[..., : short.shape[-1]]
    np.testing.assert_allclose(short, begin, rtol=0, atol=1e-6 * abs(long).max())


@pytest.mark.parametrize(("steps", "tolerance"), [(5, 5e-5), (30, 1e-6), (120, 1e-7), (250, 2e-7)])
def test_a_run_of_few_steps_is_as_good_at_its_end(steps: int, tolerance: float) -> None:
    # With no more padding than its own length, a run of 30 steps is off by 5e-4 in its last points, one of 5 steps altogether.
    long = cx.simulate(cx.presets.load("bare"), duration=2.0, time_step=2e-3, modes=20).solution.normal
    short = cx.simulate(cx.presets.load("bare"), duration=2e-3 * steps, time_step=2e-3, modes=20).solution.normal
    begin = long[..., : short.shape[-1]]
    assert begin.shape[-1] == steps + 1
    np.testing.assert_allclose(short, begin, rtol=0, atol=tolerance * abs(begin).max())
