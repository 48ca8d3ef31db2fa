"""Currents that stop at a limit: a condenser by hand, open circuits as the limit of none, energy, order, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.response.electrical import of_segments
from coaxshell.solver.electrode_patterns import CutPatterns
from coaxshell.solver.limited_voltages import LimitedMarch
from coaxshell.solver.recompute import spectra_of
from coaxshell.structure.segments import Segments

PAIRS = presets.load("electrodes")
PLANE = PAIRS.replace(source=cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4))
RUN = {"duration": 0.6, "time_step": 0.01, "modes": 8}
BRIEF = {**RUN, "time_step": 0.02}


def limited(limit="3 A/m^2", stops: bool = True, **control) -> cx.System:
    given = {"segments": 6, "current_limit": limit, "current_saturation": stops, **control}
    return PLANE.with_overrides({f"control.{name}": value for name, value in given.items()})


@pytest.fixture(scope="module")
def held():
    return cx.simulate(limited(), **RUN)


def test_a_condenser_by_hand():
    # Without an answer of the wall the voltage follows what is asked for by at most the limit a step.
    patterns = CutPatterns((Segments(5, 1.0, ()),), np.arange(4.0), 2)
    asked = np.cumsum(np.random.default_rng(2).normal(size=(1, patterns.numbers.count, 40)), axis=-1)
    march = LimitedMarch(patterns, np.full((1, 5), 0.7), np.zeros((1, 1, patterns.numbers.count, 40)), moving=True)
    lack, _ = march.lack(asked)
    wanted, given = patterns.evaluate @ asked[0], patterns.evaluate @ (asked + lack)[0]
    so_far = np.zeros(5)
    for n in range(40):
        so_far = so_far + np.clip(wanted[:, n] - so_far, -0.7, 0.7)
        assert_allclose(given[:, n], so_far, atol=1e-9)


def test_no_current_is_an_open_circuit():
    # u = -m/C is what pairs of equal layers read, fed back with k_p = 1; the current lets through a thousandth.
    none = cx.simulate(limited("1 mA/m^2"), **RUN).solution
    opened = cx.simulate(PLANE.with_overrides({"control.segments": 6, "control.proportional": 1, "control.derivative": 0}), **RUN).solution
    free = cx.simulate(limited(stops=False), **RUN).solution
    assert np.linalg.norm(none.normal - opened.normal) < 2e-4 * np.linalg.norm(opened.normal)
    assert np.linalg.norm(free.normal - opened.normal) > 5e-3 * np.linalg.norm(opened.normal)


def test_what_reaches_no_limit_is_the_linear_answer():
    free, wide = (cx.simulate(limited("1 kA/m^2", stops), **RUN).solution for stops in (False, True))
    assert_allclose(wide.normal, free.normal, rtol=0, atol=0)


def test_energy_closes_where_currents_are_cut(held, tmp_path):
    energy = held.energy()
    assert np.abs(energy.closure_relative).max() < 2e-5
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-6 * np.abs(energy.actuator_work).max()
    assert held.control_effort().within
    assert held.control_effort()["outer"].current == 3.0
    assert sum("the current was held at 3.000 A/m^2" in text for text in held.warnings) == 2
    assert 0.0 < np.abs(held.solution.estimates.march).max() < 0.02
    kept = cx.load_response(held.save(tmp_path / "run.nc"))
    assert_allclose(spectra_of(kept.solution).voltage, held.solution.spectra.voltage, rtol=1e-9, atol=1e-12)


def test_a_run_ends_as_a_longer_one_goes_on(held):
    # The lack is not cut off while a limit holds: that jumped, and the band limit spread the jump over the last steps.
    short = cx.simulate(limited(), **{**RUN, "duration": 0.55})
    ended, longer = (of_segments(run.motion, 0) for run in (short, held))
    volts, current = longer.voltage[:, :56], longer.current[:, :56]
    assert abs(current[0, -1]) == 3.0
    assert_allclose(ended.voltage, volts, rtol=0, atol=0.01 * np.abs(volts).max())  # 0.09 where it is
    assert_allclose(ended.current, current, rtol=0, atol=0.2)  # 1.25 there
    loud = PLANE.with_overrides({"control.segments": 6, "control.saturation": True, "control.field_limit": "5 V/mm"})
    ended, longer = (of_segments(cx.simulate(loud, **{**RUN, "duration": end}).motion, 0).current for end in (0.6, 0.7))
    assert_allclose(ended, longer[:, :61], rtol=0, atol=0.2 * np.abs(longer[:, :61]).max())  # 4.7 there


def test_steps_converge(held):
    runs = [cx.simulate(limited(), **{**RUN, "time_step": 0.02}).solution.normal, held.solution.normal[..., ::2]]
    runs.append(cx.simulate(limited(), **{**RUN, "time_step": 0.005}).solution.normal[..., ::4])
    first, second = (np.linalg.norm(a - b) / np.linalg.norm(b) for a, b in ((runs[0], runs[1]), (runs[1], runs[2])))
    assert first < 2e-3
    assert first / second > 2.0


def test_a_limit_judges_what_is_asked_for():
    run = cx.simulate(limited("3 A/m^2", stops=False), **RUN)
    effort = run.control_effort()
    assert effort["outer"].limits["current"] == 3.0
    assert not effort.within
    assert any("times the 3.000 A/m^2 of its amplifier; set control.current_saturation = true" in text for text in run.warnings)


def test_a_wall_that_reaches_no_limit_is_not_told_of_one():
    small = {"segments": 4, "derivative": [0.5, 10.0], "proportional": 0.0}
    for where in ({}, {"dimensions": 3, "stations": [0.0]}):
        run = cx.simulate(limited(**small), **{**BRIEF, "modes": 4}, **where)
        assert [text.split(":")[0] for text in run.warnings if "current was held" in text] == ["outer shell"]
    # at 6 A/m^2 means over a step stay within what an instant exceeds: there is nothing to switch on
    brief = cx.simulate(
        PAIRS.with_overrides({"control.segments": 8, "control.current_limit": 6.0, "control.current_saturation": True}), **BRIEF
    )
    told = [text for text in brief.warnings if "A/m^2" in text]
    assert len(told) == 1
    assert "outer shell: the control law asks for 6.589 A/m^2" in told[0]
    assert told[0].endswith("means over a time step stay within it: use a shorter time_step")


def test_no_switch_is_offered_that_would_be_refused():
    for given in ({"segments": None}, {"saturation": True}, {"dead": [1]}):
        told = [
            text for text in cx.simulate(limited("0.1 A/m^2", stops=False, **given), **{**BRIEF, "modes": 6}).warnings if "A/m^2" in text
        ]
        assert len(told) == 2
        assert all(text.endswith("of its amplifier; lower the gains") for text in told)
    both = [limited("0.1 A/m^2", stops=False, field_limit=100.0).control.replace(shells=[name]) for name in ("inner", "outer")]
    told = cx.simulate(PLANE.replace(control=both), **{**BRIEF, "modes": 6}).warnings
    assert sum(text.endswith(("of its amplifier; lower the gains", "its actuator stands; lower the gains")) for text in told) == 4


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"current_limit": "3 A"}, r"current_limit: '3 A' is a current without the area that it serves; divide it by the area"),
        ({"current_limit": None}, r"current_saturation: stops at a current_limit, and none is given"),
        ({"segments": None}, r"current_saturation: is that of an amplifier, .*; give the number of segments"),
        ({"saturation": True}, r"current_saturation: voltage and current are not known to stop together"),
        ({"dead": [1]}, r"dead: segments at ground"),
        ({"segments": None, "transducers": "paper", "current_saturation": False}, r"current_limit: is said of currents"),
    ],
)
def test_what_cannot_be(change, told):
    with pytest.raises(InputError, match=told):
        limited(**{"limit": change.pop("current_limit", "3 A/m^2"), "stops": change.pop("current_saturation", True), **change})
