"""A pulse that goes on when the run ends is remarked with both times."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.model import Exponential, Gaussian, Sampled, Step
from coaxshell.solver.checks import cut
from coaxshell.solver.scaling import dimensionless

TUBE = cx.System(
    shells=[cx.Shell(radius=0.3, layers=[cx.Layer("structural-steel", "6 mm")])],
    fluids=["air", "freshwater"],
    source=cx.PlaneWave(pulse=Step(pressure=1e5)),
)
RECORD = Sampled(time=np.linspace(0, 20e-3, 50), pressure=1e5 * np.cos(np.linspace(0, 9, 50)))


def told(pulse: object, duration: float, delay: float = 0.0) -> list[str]:
    return cut(dimensionless(TUBE.replace(source=cx.PlaneWave(pulse=pulse, delay=delay))), duration)  # type: ignore[arg-type]


def test_a_record_cut_by_the_window() -> None:
    (text,) = told(RECORD, 5.0)
    for words in ("5 transits (1.012 ms)", "98.82 (20.00 ms)", "duration=99", "of its peak"):
        assert words in text
    response = cx.simulate(TUBE.replace(source=cx.PlaneWave(pulse=RECORD)), duration=2.0, time_step=0.02, modes=4)
    assert any("20.00 ms" in text for text in response.warnings)


@pytest.mark.parametrize(
    ("pulse", "long_enough"),
    [
        (RECORD, 99.0),
        (Exponential(peak_pressure=1e5, decay_time=1e-3), 12.0),
        (Gaussian(peak_pressure=-1e5, width=1e-3), 42.0),
        (Step(pressure=1e5, rise_time=1e-3), 5.0),
        (Step(pressure=1e5), 0.1),
        (Sampled(time=[0, 1e-3, 20e-3], pressure=[1e5, 5e3, 0]), 5.0),  # what comes after is a twentieth
    ],
)
def test_whole_pulses_are_no_matter_and_late_ones_are(pulse: object, long_enough: float) -> None:
    assert told(pulse, long_enough) == []
    if getattr(pulse, "rise_time", 1.0):
        assert len(told(pulse, 0.2 * long_enough)) == 1
        assert len(told(pulse, long_enough, delay=100.0)) == 1
