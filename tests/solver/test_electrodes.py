"""Voltages as means over a segment of the wall: the segment, its mean, and that it converges with the orders."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

import coaxshell as cx
from coaxshell.acoustics.pulse_band import pulse_band
from coaxshell.errors import InputError
from coaxshell.model import Exponential, Gaussian, Sampled, Step
from coaxshell.solver.electrodes import segment_length, segment_mean
from coaxshell.solver.scaling import dimensionless

BARE = cx.presets.load("bare")


@pytest.mark.parametrize(
    ("pulse", "spectrum"),
    [
        (Exponential(peak_pressure=1e4, decay_time=2e-4), lambda f: 1 / (1 + (2 * math.pi * f * 2e-4) ** 2)),
        (Gaussian(peak_pressure=-1e4, width=3e-5), lambda f: math.exp(-((2 * math.pi * f * 3e-5) ** 2))),
        (Sampled(time=[0, 1e-9, 1e-3, 1e-3 + 1e-9], pressure=[0, 1e4, 1e4, 0]), lambda f: float(np.sinc(f * 1e-3)) ** 2),
    ],
    ids=["exponential", "gaussian", "rectangle"],
)
def test_nine_tenths_of_the_energy_lie_in_the_band(pulse, spectrum) -> None:
    band = pulse_band(pulse)
    below = quad(spectrum, 0, band, limit=200)[0]
    above = sum(quad(spectrum, band * a, band * b, limit=500)[0] for a, b in pairwise([1, 2, 4, 8, 16, 32, 64]))
    assert below / (below + above) == pytest.approx(0.9, abs=5e-3)


def test_a_sampled_history_has_the_band_of_what_it_samples() -> None:
    time = np.linspace(0, 3e-3, 4000)
    assert pulse_band(Sampled(time=time, pressure=1e4 * np.exp(-time / 2e-4))) == pytest.approx(
        pulse_band(Exponential(peak_pressure=1.0, decay_time=2e-4)), rel=0.02
    )
    assert pulse_band(Step(pressure=1e4)) == 0.0
    assert pulse_band(Sampled(time=[0, 1], pressure=[0, 0])) == 0.0


def test_default_segment() -> None:
    problem = dimensionless(BARE)
    decay = BARE.sources[0].decay_time
    assert segment_length(problem, 0) == pytest.approx(2 * math.pi / math.tan(0.45 * math.pi) * 1400 * decay, rel=1e-12)
    slow = dimensionless(BARE.with_overrides({"source.decay_time": "50 ms"}))
    assert segment_length(slow, 1) == pytest.approx(2 * math.pi * BARE.shells[1].radius / 16)
    fast = dimensionless(BARE.with_overrides({"source.decay_time": "1 us"}))
    assert segment_length(fast, 1) == pytest.approx(2 * math.pi * BARE.shells[1].thickness)


@pytest.mark.parametrize("given", [0.05, "50 mm", "5 cm"])
def test_a_segment_of_ones_own(given: float | str) -> None:
    assert segment_length(dimensionless(BARE), 0, given) == 0.05
    assert segment_length(dimensionless(BARE), 0, "Point ") == 0.0


@pytest.mark.parametrize("given", [0, -1.0, "7 m", "3 kg", "electrode", True, math.nan])
def test_bad_segments(given: object) -> None:
    with pytest.raises(InputError, match=r"^segment: .*point"):
        segment_length(dimensionless(BARE), 0, given)  # type: ignore[arg-type]


def test_mean_over_a_segment() -> None:
    angle = 0.4
    around = np.linspace(0.7 - angle / 2, 0.7 + angle / 2, 20001)
    for order in (0.0, 1.0, 7.0, 30.0):
        mean = np.trapezoid(np.cos(order * around), around) / angle
        assert segment_mean(np.array([order]), angle)[0] * math.cos(0.7 * order) == pytest.approx(mean, abs=1e-7)


def largest(modes: int, duration: float, time_step: float, name: str) -> np.ndarray:
    """Return (mean over the segment, value at a point) of the voltage asked for on each shell, kV."""
    response = cx.simulate(cx.presets.load(name), modes=modes, duration=duration, time_step=time_step)
    found = (response.summary(segment=segment).shells for segment in (None, "point"))
    return np.array([[shell.actuator_voltage.value / 1e3 for shell in shells] for shells in found])


def test_means_converge_where_points_do_not() -> None:
    coarse, fine = (largest(modes, 0.5, 0.01, "active") for modes in (60, 120))
    assert abs(fine[0] / coarse[0] - 1).max() < 0.03
    assert (fine[1] / coarse[1]).max() > 1.25


@pytest.mark.slow
def test_table_of_the_hybrid_preset() -> None:
    # docs/theory.md, "Voltages of electrodes": 75, 150, 300 and 600 orders
    found = np.array([largest(modes, 2.5, 2e-3, "hybrid") for modes in (75, 150, 300, 600)])
    change = abs(found[:-1] / found[-1] - 1)
    assert (change[:, 0] < [[0.01, 0.06], [0.01, 0.02], [0.002, 0.008]]).all(), change[:, 0]
    assert (change[0, 1] > 0.5).all()


def test_warning_and_summary_name_one_voltage() -> None:
    response = cx.simulate(cx.presets.load("hybrid"), modes=40, duration=0.5, time_step=0.01)
    outer = response.summary().shells[1]
    text = next(text for text in response.warnings if "asks for" in text and text.startswith("outer"))
    assert f"asks for {outer.actuator_voltage.value / 1e3:#.4g} kV (mean over 183.1 mm of the wall" in text
    assert "1.770 kV" in text


def test_histories_over_a_segment() -> None:
    response = cx.simulate(cx.presets.load("active"), modes=30, duration=0.5, time_step=0.01)
    around = np.linspace(-6.0, 6.0, 4001)
    for read in (response.sensor_voltage, response.actuator_voltage):
        mean = read("outer", 40, segment=math.radians(12.0) * response.system.shells[1].radius)
        values = read("outer", 40 + around).values
        assert mean.attrs["segment"] == pytest.approx(math.radians(12.0) * response.system.shells[1].radius)
        np.testing.assert_allclose(mean, np.trapezoid(values, around, axis=1) / 12.0, rtol=0, atol=1e-6 * abs(values).max())
    cut = cx.simulate(
        cx.presets.load("active").with_overrides({"control.saturation": True, "control.field_limit": 1e5}),
        modes=30,
        duration=0.5,
        time_step=0.01,
    )
    values = cut.actuator_voltage("outer", 10 + around).values
    mean = cut.actuator_voltage("outer", 10, segment=math.radians(12.0) * cut.system.shells[1].radius)
    assert abs(values).max() == pytest.approx(float(mean.attrs["limit"]))
    np.testing.assert_allclose(mean, np.trapezoid(values, around, axis=1) / 12.0, rtol=0, atol=2e-3 * abs(values).max())
