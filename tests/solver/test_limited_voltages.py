"""Voltages of electrodes that stop at a limit: a step by its conditions, order of the march, energy, dead segments, what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.solver.electrode_patterns import CutPatterns, OrderPatterns
from coaxshell.solver.limited_step import LimitedStep
from coaxshell.solver.recompute import spectra_of
from coaxshell.structure.segments import Segments

PLANE = presets.load("electrodes").replace(source=cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4))
RUN = {"duration": 0.6, "time_step": 0.01, "modes": 12}
LIMIT = 1e4  # V/m: 30 V


def limited(**control) -> cx.System:
    return PLANE.with_overrides({f"control.{name}": value for name, value in {"saturation": True, "field_limit": LIMIT, **control}.items()})


@pytest.mark.parametrize(
    "patterns",
    [OrderPatterns(np.arange(9.0), 2), CutPatterns((Segments(7, 0.9, (2,)), Segments(7, 1.0, (2,))), np.arange(9.0), 2)],
    ids=["whole", "cut"],
)
@pytest.mark.parametrize("strength", [0.3, 0.995])
def test_a_step_gives_what_is_cut(patterns, strength):
    rng = np.random.default_rng(1)
    count, points = patterns.numbers.count, len(patterns.evaluate)
    present = np.zeros((2, 2, count))
    present[0, 0], present[1, 1] = -strength * rng.uniform(size=(2, count))
    present[0, 1] = 0.02 * rng.normal(size=count)
    limits = np.full((2, points), 1.0)
    limits[:, list(patterns.dead)] = 0.0
    step = LimitedStep(patterns, limits, present)
    for size in (0.1, 1.0, 5.0, 5.0):
        known = size * rng.normal(size=(2, count))
        known[:, patterns.numbers.orders == 0] *= 0.5
        delta, _ = step.solve(known)
        asked = known + np.einsum("ijq,jq->iq", present, delta)
        volts = asked @ patterns.evaluate.T
        assert_allclose(delta, (np.clip(volts, -limits, limits) - volts) @ patterns.project.T, atol=1e-8)
    b, kappa = known[1], -present[1, 1]
    safely, _ = step._safely(b, kappa, limits[1])
    assert_allclose(safely, delta[1], atol=1e-7)  # the other way to the same answer


def test_what_reaches_no_limit_is_the_linear_answer():
    free = cx.simulate(PLANE, **RUN).solution
    wide = cx.simulate(limited(field_limit=1e6), **RUN).solution
    assert_allclose(wide.normal, free.normal, rtol=0, atol=0)
    assert wide.control_voltage is None or np.abs(wide.control_voltage).max() < 3e3


@pytest.fixture(scope="module")
def cut_run():
    return cx.simulate(limited(segments=8, dead=[3]), **RUN)


def test_segments_stop_at_their_limit(cut_run):
    asked, angles = cut_run.solution.segment_voltage, np.arange(0.0, 360.0, 45.0)
    given = cut_run.actuator_voltage("outer", angles).to_numpy()
    assert np.abs(asked).max() > 35.0
    assert_allclose(np.abs(given).max(), 30.0, rtol=1e-9)
    assert_allclose(given, np.clip(asked[1].T, -30.0, 30.0))
    assert not given[:, 3].any()
    marched = np.abs(cut_run.solution.estimates.march)
    assert 0.0 < marched.max() < 0.1
    assert any("the voltage was held at 30" in text for text in cut_run.warnings)


def test_energy_closes_where_voltages_are_cut(cut_run):
    energy = cut_run.energy()
    assert np.abs(energy.closure_relative).max() < 2e-5
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-6 * np.abs(energy.actuator_work).max()


def test_a_stored_run_marches_again_to_the_same_answer(cut_run, tmp_path):
    kept = cx.load_response(cut_run.save(tmp_path / "run.nc"))
    assert_allclose(spectra_of(kept.solution).voltage, cut_run.solution.spectra.voltage, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("cut", [{}, {"segments": 8}], ids=["whole", "cut"])
def test_the_march_is_of_second_order(cut):
    coarse = {**RUN, "time_step": 0.02}
    runs = [cx.simulate(limited(**cut), **coarse, refinement=refinement).solution.normal for refinement in (1, 2, 4)]
    first, second = (np.linalg.norm(a - b) / np.linalg.norm(b) for a, b in ((runs[0], runs[1]), (runs[1], runs[2])))
    assert first < 2e-3
    assert first / second > 2.5


def test_dead_segments_are_those_without_voltage():
    exact = cx.simulate(PLANE.with_overrides({"control.segments": 8, "control.dead": [3]}), **RUN).solution
    largest = float(np.abs(exact.segment_voltage).max())
    just = cx.simulate(limited(segments=8, dead=[3], field_limit=0.999 * largest / 3e-3), **RUN).solution
    assert np.linalg.norm(just.normal - exact.normal) < 1e-3 * np.linalg.norm(exact.normal)


def test_a_law_of_the_papers_transducers_stops_too():
    time = presets.load("bare").transit_time
    law = {"numerator": [-150 * time, -2e4], "amplifier_corner": 3e5}
    loud = presets.load("bare").replace(control=cx.Feedback(**law, saturation=True, field_limit=1e5))
    run = cx.simulate(loud, **RUN)
    assert np.abs(run.actuator_voltage("inner", 0.0)).max() <= 300.0 * (1 + 1e-9)
    assert run.solution.spectra.iterations > 0


def test_what_is_not_known_is_refused():
    with pytest.raises(InputError, match=r"control\.saturation"):
        cx.gradient(limited(), metric="inner.rms_stress", variables=["control.derivative"], **RUN)
