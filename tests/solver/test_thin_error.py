"""The estimated error of thin walls against exact ones: the map, what it says of other runs, its floor, and the warning."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.paper.thickness.compared import compare
from coaxshell.apps.paper.thickness.error_map import RESOLUTION, as_table, error_map, of_thickness, scaled, shocked
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.thin_error import WETTED, from_table, kind_of_wall, thin_errors, thin_map

BARE, TUBE = cx.presets.load("bare"), cx.presets.load("steel-tube")
SHORT = {"duration": 2.0, "time_step": 0.05, "modes": 3}


def warned(system, **settings):
    response = cx.simulate(system, **{**SHORT, **settings})
    return [text for text in response.warnings if "thin-wall theory" in text]


def told(system, **described):
    return system.replace(shells=[shell.replace(**described) for shell in system.shells])


def test_the_map_of_the_package_is_what_its_script_makes():
    made, stored = error_map(RESOLUTION.up_to(1.0), (0.012,), ()), thin_map()
    at = list(stored.thickness[2]).index(0.012)
    for name in ("stress", "displacement", "peaks"):
        np.testing.assert_allclose(getattr(stored, name)[:, :, at, :, 0], getattr(made, name)[:, :, 0, :, 0], rtol=6e-3, atol=1e-4)
    again = from_table(as_table(stored))
    np.testing.assert_array_equal(again.stress, stored.stress)
    np.testing.assert_array_equal(again.spread, stored.spread)


@pytest.mark.slow
def test_all_durations_of_a_thickness_are_those_of_the_script():
    made, stored = error_map(thicknesses=(0.024,), others=()), thin_map()
    at = list(stored.thickness[2]).index(0.024)
    for name in ("stress", "displacement", "peaks"):
        np.testing.assert_allclose(getattr(stored, name)[:, :, at], getattr(made, name)[:, :, 0], rtol=6e-3, atol=1e-4)


@pytest.mark.parametrize("name", ["dry", "pair"])
def test_between_its_nodes_the_map_tells_what_a_run_shows(name):
    system = shocked(of_thickness(TUBE, 0.035) if name == "dry" else scaled(BARE, 1.4), 0.3)
    found, known = compare(system, RESOLUTION.up_to(1.7)), thin_map()
    for wall, shell in enumerate(system.shells):
        for wetted in WETTED:
            estimate = known.estimate(kind_of_wall(system, wall), wetted, shell.thickness / shell.radius, 0.3, 1.7)
            assert estimate == pytest.approx(found.of_walls(wetted)[wall], rel=0.15)


def test_at_its_edges_the_map_goes_on():
    known = thin_map()
    assert known.estimate("inner", "faces", 0.024, 0.2, 4.0) == pytest.approx(known.stress[1, 1, 3, 2, 4], rel=1e-12)
    assert known.estimate("inner", "faces", 1e-4, 0.2, 4.0) == pytest.approx(known.stress[1, 1, 0, 2, 4], rel=1e-12)
    assert known.estimate("outer", "mid-surface", 0.5, np.inf, 50.0) == pytest.approx(known.stress[2, 0, -1, -1, -1], rel=1e-12)
    assert known.estimate("dry", "faces", 0.024, 0.2, 0.5) == pytest.approx(0.5 * known.stress[0, 1, 3, 2, 0], rel=1e-12)


def test_what_the_pressure_across_a_wall_does_stays_however_thin_it_is():
    """Of shells full of water, wetted at their faces: the error goes with the thickness if Poisson's ratio is 0, else it stays."""
    aluminium, errors = BARE.shells[0].layers[1].material, {}
    for poisson in (0.0, 0.33):
        for ratio in (0.002, 0.008):
            layers = {"layers": [cx.Layer(aluminium.replace(poisson_ratio=poisson), ratio)]}
            found = compare(shocked(told(BARE, **layers), 0.2), Settings(duration=2.0, time_step=2e-2, modes=10), ("faces",))
            errors[poisson, ratio] = found.of_walls("faces").max()
    assert errors[0.0, 0.002] < 1.5e-3
    assert errors[0.0, 0.008] / errors[0.0, 0.002] == pytest.approx(4.0, rel=0.25)
    assert 0.02 < errors[0.33, 0.008] < 1.3 * errors[0.33, 0.002]


def test_thin_walls_far_from_exact_ones_are_warned_of():
    inner, outer = thin_errors(dimensionless(BARE), 2.0)
    first, second = warned(BARE)
    assert inner.low < inner.value < inner.high
    assert first.startswith("inner shell: thin-wall theory with fluids at its mid-surface leaves its hoop stress about")
    assert f"about {100 * inner.value:.0f} % from an exact wall's (relative RMS; {100 * inner.low:.0f} to {100 * inner.high:.0f} %" in first
    assert first.endswith(f'more than 5 %; use wetted = "faces" (about {100 * inner.at_faces:.0f} %) or theory = "elastic"')
    assert second.startswith("outer shell")
    assert outer.at_faces == pytest.approx(outer.value, rel=0.1)
    assert second.endswith('more than 5 %; use theory = "elastic"')
    at_faces = warned(told(BARE, wetted="faces"))
    assert at_faces == [text for text in at_faces if "with fluids at its faces" in text and "wetted" not in text]
    active = cx.presets.load("active")
    assert warned(active)[0].endswith('theory = "elastic"')
    assert warned(active.with_overrides({"control.saturation": True}))[0].endswith('theory = "elastic"')
    beside = warned(cx.presets.load("hybrid").with_overrides({"control.saturation": True}))
    assert beside[0].endswith('theory = "elastic"')


def test_what_is_no_thin_wall_or_near_an_exact_one_is_not_warned_of():
    assert warned(TUBE) == []
    assert warned(told(BARE, theory="elastic")) == []
    assert warned(BARE.replace(source=BARE.source.replace(delay=5e-3))) == []  # it comes after the run
    assert warned(BARE, dimensions=3, axial_modes=3) == []
    assert kind_of_wall(TUBE, 0) == "dry"
    assert [kind_of_wall(cx.presets.load("iakovlev-double"), i) for i in (0, 1)] == ["inner", "outer"]
