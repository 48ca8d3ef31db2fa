"""Fourier transforms of histories: a closed form, and the answer without a time step."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.response.history_spectrum import transform

WATER = cx.Fluid(density=1000, sound_speed=1400)
PLASTIC = cx.Elastic(name="plastic", density=1200, youngs_modulus=5e9, poisson_ratio=0.3)
PULSE = cx.Gaussian(peak_pressure=1e5, width=3e-4, centre=2e-3)
FEW = pytest.mark.filterwarnings("ignore:modes:coaxshell.PhysicsWarning")
HERTZ = [100.0, 250.0, 400.0]


@pytest.fixture(scope="module")
def ringing():
    """A shell whose two lowest orders have died away at the end of the run."""
    shell = cx.Shell(radius=1.0, layers=[cx.Layer(PLASTIC, 0.05)])
    system = cx.System(shells=[shell], fluids=[cx.VACUUM, WATER], source=cx.PlaneWave(pulse=PULSE, delay=1e-3, angle=30.0))
    return cx.simulate(system, duration=320.0, time_step=0.04, modes=1)


def test_a_damped_wave_has_its_transform():
    time, decay, tone = np.arange(40_001) * 1e-5, 200.0, 2 * np.pi * 300.0
    wave = np.exp(-decay * time) * np.sin(tone * time)
    found = transform(time, wave[:, None], np.array(HERTZ))[:, 0]
    s = 2j * np.pi * np.array(HERTZ) + decay
    np.testing.assert_allclose(found, tone / (s**2 + tone**2), rtol=1e-4)


@FEW
@pytest.mark.parametrize(("quantity", "tolerance"), [("shell_velocity", 1e-6), ("stress", 5e-5)])
def test_a_history_that_has_died_away_has_the_spectrum_that_needs_no_time_step(ringing, quantity, tolerance):
    for per in ("incident", "absolute"):
        found = ringing.spectrum(quantity, "outer", [0.0, 70.0], HERTZ, per=per)
        expected = cx.frequency_response(ringing.system, HERTZ, quantity, angle=[0.0, 70.0], modes=1, per=per)
        np.testing.assert_allclose(found, expected, rtol=tolerance)
        assert found.dims == expected.dims
        assert found.attrs["units"] == expected.attrs["units"]


@FEW
def test_any_history_has_a_spectrum_such_as_that_of_a_pressure(ringing):
    history = ringing.pressure(radius=[1.3], angle=[10.0, 200.0], time=ringing.time)
    found = ringing.spectrum(history, frequency=HERTZ)
    expected = cx.frequency_response(ringing.system, HERTZ, "pressure", radius=[1.3], angle=[10.0, 200.0], modes=1, per="absolute")
    np.testing.assert_allclose(found.transpose(*expected.dims), expected, rtol=5e-5)


def test_what_is_left_at_the_end_is_told(ringing):
    history = ringing.stress("outer", 0.0).isel(time=slice(0, 500))
    with pytest.warns(cx.PhysicsWarning, match="of the largest mid-surface hoop stress of the core is left in the last 5 %"):
        cut = ringing.spectrum(history, frequency=100.0)
    assert cut.attrs["left_at_the_end"] > 0.01
    assert cut.dims == ()


def test_frequencies_are_chosen_below_the_roll_off(ringing):
    found = ringing.spectrum("shell_velocity")
    step = 0.04 / 1400.0
    assert found.sizes["frequency"] > 1000
    assert found["frequency"][-1] <= 0.4 / step
    some = found.isel(frequency=[3, 700])
    np.testing.assert_allclose(some, ringing.spectrum("shell_velocity", frequency=some["frequency"]), rtol=1e-6, atol=1e-12)
    with pytest.raises(InputError, match="frequency: 20000 Hz is above"):
        ringing.spectrum("stress", frequency=2e4)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"per": "head"}, "per: 'head' is unknown"),
        ({"per": "incident", "source": 4}, "source: 4 is not allowed"),
        ({"quantity": 3.0}, "quantity: is no history"),
        ({"frequency": -1.0}, "frequency: -1 Hz is not allowed"),
    ],
)
def test_bad_arguments_are_refused_by_name(ringing, arguments, told):
    with pytest.raises(InputError, match=told):
        ringing.spectrum(**arguments)


@FEW
def test_an_inclined_wave_has_the_spectrum_of_its_run_at_every_station():
    shell = cx.Shell(radius=1.0, layers=[cx.Layer(PLASTIC, 0.05)])
    pulse = cx.Gaussian(peak_pressure=1e5, width=6e-4, centre=4e-3)
    system = cx.System(shells=[shell], fluids=[cx.VACUUM, WATER], source=cx.PlaneWave(pulse=pulse, inclination=20.0))
    run = cx.simulate(system, duration=800.0, time_step=0.1, modes=1, dimensions=3, stations=[0.0, 0.5])
    hertz = np.array([100.0, 250.0])
    found = run.spectrum("shell_velocity", "outer", [0.0, 70.0], hertz, per="incident")
    expected = cx.frequency_response(system, hertz, "shell_velocity", angle=[0.0, 70.0], modes=1, dimensions=3)
    along = np.exp(-2j * np.pi * hertz / 1400.0 * np.sin(np.radians(20.0)) * 0.5)[:, None]
    np.testing.assert_allclose(found.isel(station=0), expected, rtol=1e-3)
    np.testing.assert_allclose(found.isel(station=1), expected * along, rtol=1e-3)
