"""The estimated error of a slice through a spherical front: the map, what it says of other runs, and the warning."""

from __future__ import annotations

import math

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.paper.sphere.compared import compare
from coaxshell.apps.paper.sphere.error_map import RESOLUTION, as_table, decayed, error_map, shocked
from coaxshell.model.pulses import Exponential, Gaussian, Sampled, Step
from coaxshell.solver.checks import slice_of_sphere
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.slice_error import equivalent_decay, from_table, slice_error, slice_map

BARE = cx.presets.load("bare")
SHORT = {"duration": 2.0, "time_step": 0.02, "modes": 6}


def warned(system, **settings):
    response = cx.simulate(system, **{**SHORT, **settings})
    return [text for text in response.warnings if "slice" in text]


def test_the_map_of_the_package_is_what_its_script_makes():
    made, stored = error_map(RESOLUTION.up_to(1.0), (5.0,), ()), slice_map()
    at = list(stored.distance).index(5.0)
    for name in ("error", "line", "plane"):
        np.testing.assert_allclose(getattr(stored, name)[at, :, :2], getattr(made, name)[0], rtol=6e-3)
    again = from_table(as_table(stored))
    np.testing.assert_array_equal(again.error, stored.error)
    np.testing.assert_array_equal(again.spread, stored.spread)


@pytest.mark.slow_for("15.0-0.14-3.0")
@pytest.mark.parametrize(("distance", "decay", "duration"), [(4.0, 0.3, 1.5), (15.0, 0.14, 3.0)])
def test_between_its_nodes_the_map_tells_what_a_run_shows(distance, decay, duration):
    found = compare(shocked(BARE, distance, decay), RESOLUTION.up_to(duration), ("slice",))
    assert slice_map().estimate(distance, decay, duration) == pytest.approx(found.overall("slice"), rel=0.12)


def test_beyond_the_map_errors_fall_with_distance_and_in_short_runs():
    stored = slice_map()
    assert stored.estimate(5.0, 0.2, 2.0) == pytest.approx(stored.error[3, 2, 3], rel=1e-12)
    assert stored.estimate(200.0, 0.2, 4.0) == pytest.approx(0.5 * stored.error[-1, 2, 5], rel=1e-12)
    assert stored.estimate(5.0, 0.2, 0.25) == pytest.approx(0.5 * stored.error[3, 2, 0], rel=1e-12)
    assert stored.estimate(5.0, math.inf, 50.0) == pytest.approx(stored.error[3, -1, -1], rel=1e-12)


def test_another_decay_is_a_recursion_over_the_same_histories():
    small = RESOLUTION.up_to(1.0)
    first, second = (compare(shocked(BARE, 3.0, decay), small, ("slice", "plane")) for decay in (0.2, 0.7))
    for kind, values in second.stress.items():
        found = decayed(first.stress[kind], small.time_step, 0.2, 0.7)
        assert np.linalg.norm(found - values) < 1e-3 * np.linalg.norm(values)


def test_pulses_count_with_their_energy():
    times = np.linspace(0.0, 2e-3, 4001)
    record = Sampled(time=tuple(times), pressure=tuple(np.exp(-times / 1e-4)))
    assert equivalent_decay(Exponential(peak_pressure=2.0, decay_time=3e-4)) == 3e-4
    assert equivalent_decay(record) == pytest.approx(1e-4, rel=1e-4)
    assert equivalent_decay(Gaussian(peak_pressure=2.0, width=1e-4)) == pytest.approx(2.0 * math.sqrt(math.pi) * 1e-4, rel=1e-12)
    assert equivalent_decay(Step(pressure=1.0)) == math.inf


def test_a_spherical_source_in_two_dimensions_is_warned_of_once():
    (text,) = warned(BARE)
    found = slice_error(dimensionless(BARE), 2.0)
    assert found.low < found.value < found.high
    assert f"about {100 * found.value:.0f} % (relative RMS; {100 * found.low:.0f} to {100 * found.high:.0f} %" in text
    assert text.endswith("more than 5 %; use dimensions=3")
    held = cx.presets.load("hybrid")
    held = held.replace(control=held.control.replace(saturation=True))
    assert warned(held)[0].endswith("use dimensions=3 without saturation")
    cut = {"control.segments": 4, "control.current_limit": 1.0, "control.current_saturation": True}
    assert slice_of_sphere(dimensionless(cx.presets.load("electrodes").with_overrides(cut)), 2.0)[0].endswith("use dimensions=3")
    exact = held.replace(absorbers=None).with_overrides({"shells.0.theory": "elastic"})
    assert slice_of_sphere(dimensionless(exact), 2.0)[0].endswith("use dimensions=3")  # limits stand there without absorbers
    driven = cx.presets.load("electrodes-hybrid")
    (told,) = slice_of_sphere(dimensionless(driven), 2.0)
    assert told.endswith("use dimensions=3")
    (told,) = slice_of_sphere(dimensionless(driven.with_overrides({"control.segments": 24})), 2.0)
    assert told.endswith("use dimensions=3 without absorbers")  # which are refused beside segments there
    near = BARE.source.replace(distance=3.0, angle=90.0)
    (both,) = warned(BARE.replace(source=[BARE.source, near]))
    assert f"about {100 * slice_error(dimensionless(BARE.replace(source=near)), 2.0).value:.0f} %" in both


def test_what_no_slice_is_or_hardly_differs_is_not_warned_of():
    far, plane = BARE.source.replace(distance=200.0), cx.PlaneShock(peak_pressure=25e3, decay_time=1.3e-4)
    assert warned(BARE, dimensions=3, axial_modes=3) == []
    assert warned(BARE.replace(source=far)) == []
    assert warned(BARE.replace(source=plane)) == []
    assert warned(BARE.replace(source=BARE.source.replace(delay=2e-3))) == []  # it comes after the run
    rigid = BARE.replace(shells=[cx.RigidShell(radius=1.0)], fluids=[cx.VACUUM, BARE.exterior])
    assert slice_error(dimensionless(rigid), 2.0).value == 0.0
