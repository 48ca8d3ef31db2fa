"""Control by electrodes and by any law in three dimensions: two dimensions, its own law, balances, files, stability wave by wave."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.response import load_response
from coaxshell.solver import stability
from coaxshell.solver.axial.stability import doubtful_waves, look_closer, sample, worst_wave
from coaxshell.solver.passivity import passive_orders
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.stability import unstable_poles

BARE = cx.presets.load("bare")
TIME = BARE.transit_time
PAIRS = BARE.with_overrides({f"shells[{i}].layers[{j}].role": "self-sensing" for i in (0, 1) for j in (0, 2)})
SMALL: dict[str, Any] = {"duration": 0.5, "time_step": 1e-2, "modes": 3, "dimensions": 3}
CONTROLS: dict[str, tuple[cx.System, Any]] = {
    "electrodes": (PAIRS, cx.PDControl(proportional=5, derivative=20, transducers="electrodes")),
    "a law": (PAIRS, cx.Feedback(numerator=[2 * TIME, 3.0], amplifier_corner="200 kHz", transducers="electrodes", weights=(1, 1, 0.5))),
    "a law on the paper's": (BARE, cx.Feedback(numerator=[-150 * TIME, -2e4], amplifier_corner="200 kHz")),
}


def system(name: str, **changes: Any) -> cx.System:
    base, control = CONTROLS[name]
    return base.replace(control=control, **changes)


@cache
def run(name: str) -> cx.SpatialResponse:
    return cx.simulate(system(name), stations=[0.0, 0.4], **SMALL)


@pytest.mark.parametrize("name", CONTROLS)
def test_uniform_waves_are_two_dimensions(name):
    plane = cx.PlaneShock(peak_pressure=BARE.source.peak_pressure, decay_time=BARE.source.decay_time)
    described = system(name, source=plane)
    both = [cx.simulate(described, **{**SMALL, "dimensions": 2}), cx.simulate(described, stations=[0.3], **SMALL)]
    for read, where in (("sensor_voltage", {}), ("actuator_voltage", {}), ("stress", {}), ("stress", {"depth": "inner"})):
        flat, space = (np.squeeze(np.asarray(getattr(one, read)("inner", [0.0, 70.0], **where))) for one in both)
        np.testing.assert_allclose(space, flat, rtol=0, atol=1e-10 * np.abs(flat).max())


def test_voltages_follow_the_law_at_every_station():
    response, law = run("electrodes"), system("electrodes").control
    for z in (0.0, 0.4):
        sensed, given = (np.asarray(f("outer", [0.0, 140.0], station=z)) for f in (response.sensor_voltage, response.actuator_voltage))
        rate = (-sensed[4:] + 8.0 * sensed[3:-1] - 8.0 * sensed[1:-3] + sensed[:-4]) / (12.0 * SMALL["time_step"])
        expected = law.proportional * sensed[2:-2] + law.derivative * rate
        late = slice(15, None)  # after the front, which differences blur
        assert np.linalg.norm((given[2:-2] - expected)[late]) < 0.1 * np.linalg.norm(given[2:-2][late])


def test_pd_control_written_as_a_law_is_the_same():
    written = cx.Feedback(numerator=[20 * TIME, 5.0], transducers="electrodes")
    one, other = run("electrodes"), cx.simulate(PAIRS.replace(control=written), stations=[0.0, 0.4], **SMALL)
    for read, what in (("actuator_voltage", {}), ("displacement", {"component": "axial"}), ("stress", {"depth": "outer"})):
        values = [np.asarray(getattr(each, read)("inner", [0.0, 50.0], **what)) for each in (one, other)]
        np.testing.assert_allclose(*values, rtol=0, atol=1e-11 * np.abs(values[0]).max())


@pytest.mark.parametrize("name", ["electrodes", *(pytest.param(name, marks=pytest.mark.slow) for name in CONTROLS if name != "electrodes")])
def test_energies_close_over_the_whole_length(name):
    energy = run(name).energy(every=4)
    assert float(np.abs(energy.closure_relative).max()) < 5e-6
    assert float(energy.actuator_work[-1]) > 1e-3 * float(energy.exterior_work.max())
    if "paper" not in name:
        left = energy.amplifier_work - energy.actuator_field + energy.actuator_work
        assert float(np.abs(left).max()) < 1e-6 * float(np.abs(energy.exterior_work).max())


def test_a_run_is_saved_summed_up_and_measured(tmp_path):
    response = run("a law")
    response.save(tmp_path / "run.nc")
    again = load_response(tmp_path / "run.nc")
    for read in ("sensor_voltage", "actuator_voltage"):
        np.testing.assert_array_equal(np.asarray(getattr(again, read)("outer", 30.0)), np.asarray(getattr(response, read)("outer", 30.0)))
    assert "actuator voltage asked" in str(again.summary())
    (told,) = [text for text in run("electrodes").warnings if text.startswith("control: the loop is ideal")]
    assert "read the run as the limit" in told
    fewer, all_of_it = (np.asarray(one.actuator_voltage("outer", 30.0)) for one in (response.thin(2), response))
    np.testing.assert_array_equal(fewer, all_of_it[::2])


class TestStability:
    def test_usual_laws_are_proven_at_every_wavenumber(self, monkeypatch):
        monkeypatch.setattr(stability, "turned", lambda *_: pytest.fail("poles were counted"))
        waves = [Modes.up_to(8, float(k)) for k in np.linspace(0.0, 20.0, 6)]
        for name in CONTROLS:
            assert not doubtful_waves(dimensionless(system(name), 3), waves, 0.25)
        paper = BARE.replace(control=cx.PDControl(proportional=-2e4, derivative=-150))
        assert not doubtful_waves(dimensionless(paper, 3), waves, 0.25)

    @pytest.mark.parametrize("k", [0.7, 9.0])
    @pytest.mark.parametrize(
        "law",
        [
            {"numerator": [10 * TIME, 100.0]},
            {"numerator": [-TIME, -3.0]},
            {"numerator": [-5.0], "denominator": [2.8e-9, 1e-5, 1.0]},
            {"numerator": [2 * TIME, 300.0], "amplifier_corner": "10 kHz"},
            {"numerator": [10 * TIME, 0.0], "delay": "20 us", "weights": 2},
        ],
        ids=["collocated", "other sign", "resonator", "low corner", "late"],
    )
    def test_no_wave_found_passive_is_unstable(self, law, k, monkeypatch):
        control = cx.Feedback(transducers="electrodes", **law)
        problem, modes = dimensionless(PAIRS.replace(control=control), 3), Modes.up_to(4, k)
        passive = modes.orders[passive_orders(problem, modes, 0.5)]
        monkeypatch.setattr(stability, "passive_orders", lambda problem, modes, least: np.zeros(modes.count, dtype=bool))
        counted = unstable_poles(problem, 4, 2.0, wavenumber=k).orders
        assert not set(passive.tolist()) & set(counted.tolist())
        assert passive.size < modes.count or counted.size == 0
        if law["numerator"] == [10 * TIME, 100.0]:
            assert passive.size == modes.count
        elif "delay" in law or law["numerator"][0] < 0.0:
            assert (counted.size > 0) == (k > 1.0 or "denominator" not in law)

    def test_refused_with_its_wavenumber(self):
        apart = cx.PDControl(proportional=0, derivative=10, transducers="electrodes")
        with pytest.raises(cx.InputError, match=r"derivative: 10 makes the closed loop unstable: orders? .* at the axial wavenumber"):
            cx.simulate(BARE.replace(control=apart), axial_modes=20.0, **{**SMALL, "duration": 2.0})

    def test_the_ends_of_all_wavenumbers_are_looked_at(self):
        waves = [Modes.up_to(2, float(k)) for k in range(40)]
        found = [modes.wavenumber for modes in sample(waves)]
        assert (found[0], found[-1]) == (0.0, 39.0)
        assert len(found) == 16
        assert sample([]) == []

    def test_waves_are_counted_closer_where_a_pole_may_be_near(self):
        falls = np.concatenate([np.linspace(0.9, 0.05, 12), [0.01, 1e-3, 0.02, 0.3]])
        asked = look_closer(lambda j: float(falls[j]), 16)
        assert 13 in asked
        assert len(asked) < 16
        assert list(look_closer(lambda j: 0.8 - 0.01 * j, 16)) == [0, 4, 8, 11, 15]
        assert list(look_closer(lambda j: np.inf, 16)) == [0, 4, 8, 11, 15]
        assert {5, 6, 7} <= set(look_closer(lambda j: abs(j - 6.5) * 0.1, 16))  # as near on both sides of it
        assert look_closer(lambda j: 1.0, 2) == {0: 1.0, 1: 1.0}
        assert look_closer(lambda j: 1.0, 0) == {}

    def test_the_wave_that_grows_fastest_is_told(self):
        rates, asked = np.array([0.1, 3.0, 0.0, 5.0, 2.0, 4.0, 0.1, 0.0]), []

        def growth(place: int, rate: float) -> float:
            asked.append(place)
            return max(rate, float(rates[place]))

        known = look_closer(lambda j: 0.0 if rates[j] > 1.0 else 0.5, 8)
        assert worst_wave(growth, known, 8, 1.0) == 3
        assert len(asked) == len(set(asked)) == 5  # not those known to be stable
        assert list(look_closer(lambda j: 0.1 * (j != 8), 16)) == [0, 4, 8, 11, 15]  # what grows is not looked at closer
