"""Voltages that stop at their limit in three dimensions: against two dimensions, a dense march of its own, energies, steps, refusals."""

from __future__ import annotations

import numpy as np
import pytest
from dense_limits import DensePoints
from electrode_pairs import pairs
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.solver.axial.lack import Channels, wave_patterns
from coaxshell.solver.axial.limited_surface import SurfaceStep, WallSurface
from coaxshell.solver.axial.limited_wave import axial_parities, even_about
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.solve import forces_of, histories_within, station_spectra
from coaxshell.solver.axial.through import stresses_through
from coaxshell.solver.cost import run_cost
from coaxshell.solver.limited_voltages import limits_of, march_lack
from coaxshell.solver.scaling import dimensionless
from coaxshell.structure.elastic_wall import Asked

PAIRS = presets.load("electrodes")
PLANE = PAIRS.replace(source=cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4))
RUN = {"duration": 0.6, "time_step": 0.02, "modes": 5, "dimensions": 3, "stations": [0.0, 0.3]}
LIMIT = 1e4  # V/m: 30 V


def limited(system: cx.System = PAIRS, **control: object) -> cx.System:
    given = {"saturation": True, "field_limit": LIMIT, **control}
    return system.with_overrides({f"control.{name}": value for name, value in given.items()})


@pytest.fixture(scope="module")
def whole():
    return cx.simulate(limited(), **RUN)


@pytest.mark.parametrize("cut", [{}, {"segments": 8, "dead": [3]}], ids=["whole", "cut"])
def test_uniform_sources_are_cut_as_in_two_dimensions(cut):
    flat = cx.simulate(limited(PLANE, **cut), duration=0.6, time_step=0.02, modes=12)
    found = cx.simulate(limited(PLANE, **cut), **{**RUN, "modes": 12})
    for station, z in enumerate(RUN["stations"]):
        motion = found.spatial.at(station).normal
        assert_allclose(motion, flat.solution.normal, rtol=0, atol=1e-12 * np.abs(motion).max())
        given = found.actuator_voltage("outer", [0, 45, 90], station=z).to_numpy()
        assert_allclose(given, flat.actuator_voltage("outer", [0, 45, 90]).to_numpy(), atol=1e-9)
        assert_allclose(np.abs(given).max(), 30.0, rtol=1e-12)
    there = {"radius": [0.7, 1.3], "angle": [0.0, 60.0], "time": [0.3, 0.5], "time_resolution": 0.1}
    field = flat.pressure(**there).to_numpy()
    assert_allclose(found.pressure(**there, z=0.2).to_numpy(), field, rtol=0, atol=1e-9 * np.abs(field).max())


def test_what_reaches_no_limit_is_the_linear_answer():
    free, wide = (cx.simulate(one, **RUN) for one in (PAIRS, limited(field_limit=1e6)))
    assert_allclose(wide.spatial.fields["w"], free.spatial.fields["w"], rtol=0, atol=0)
    assert_allclose(wide.spatial.fields["potential 3"], free.spatial.fields["potential 3"], rtol=0, atol=0)


def test_waves_agree_with_a_dense_march():
    rng, problem = np.random.default_rng(3), dimensionless(PAIRS.replace(source=PAIRS.source.replace(z=0.2)), dimensions=3)
    sampling = AxialSampling(2.0, 3, 3 * np.pi)
    channels, walls, steps, parities = Channels.of(problem, sampling), 2, 8, 2
    patterns = wave_patterns(problem, sampling.modes[0])
    surface = WallSurface(patterns, channels, parities)
    dense = DensePoints.of(surface, channels, parities)
    points = rng.normal(size=len(dense.evaluate))
    back = surface.amplitudes(points.reshape(surface.series.points, -1), np.arange(surface.series.points))
    assert_allclose(back.ravel(), dense.project @ points, atol=1e-12)
    size, lasting = np.repeat(np.array([3.0, 1.0])[:, None], channels.count, axis=1), np.exp(-0.3 * np.arange(steps))
    weights = 0.2 * rng.normal(size=(walls, walls, channels.count, 1)) * lasting
    weights[0, 0, :, 0], weights[1, 1, :, 0] = -rng.uniform(0.1, 0.95, size=(2, channels.count))
    weights[0, 1, :, 0] = weights[1, 0, :, 0] = 0.01
    asked = rng.normal(size=(walls, parities, channels.count, steps)) * size[:, None, :, None]
    asked[..., :2] *= 0.01
    limits = limits_of(problem, patterns) * 0 + 2.0
    found, _ = march_lack(SurfaceStep(surface, limits, weights[..., 0].copy()).solve, weights, asked)
    assert not found[..., :2].any()
    assert found[..., 5].any()
    dense.require_lack(found, weights, asked, 2.0)


def test_the_voltage_stops_and_energy_closes(whole):
    for shell in ("inner", "outer"):
        assert np.abs(whole.actuator_voltage(shell, [0, 45, 90])).max() <= 30.0 * (1 + 1e-9)
    assert any("the voltage was held at 30.00 V" in told for told in whole.warnings)
    assert 0.0 < whole.spatial.estimates.march.max() < 0.05
    energy = whole.energy()
    assert np.abs(energy.closure_relative).max() < 1e-5
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-9 * np.abs(energy.actuator_work).max()
    effort = whole.control_effort()
    assert effort.at(0.0)["inner"].voltage > 30.0  # what is asked for


def test_the_march_is_of_second_order():
    runs = [cx.simulate(limited(), **RUN, refinement=refinement).spatial.fields["w"] for refinement in (1, 2, 4)]
    first, second = (np.linalg.norm(a - b) / np.linalg.norm(b) for a, b in ((runs[0], runs[1]), (runs[1], runs[2])))
    assert first < 3e-3
    assert first / second > 2.5


def test_a_place_of_the_source_along_the_axis_does_not_matter(whole):
    moved = cx.simulate(limited(PAIRS.replace(source=PAIRS.source.replace(z=0.5))), **{**RUN, "stations": [0.5, 0.8]})
    assert forces_of(moved.spatial).axial_parities == 1
    assert_allclose(moved.spatial.fields["w"], whole.spatial.fields["w"], rtol=0, atol=1e-10 * np.abs(whole.spatial.fields["w"]).max())
    other = PAIRS.replace(source=(PAIRS.source, PAIRS.source.replace(z=0.5, peak_pressure=1e-6)))
    both = dimensionless(limited(other), dimensions=3)
    assert (even_about(both), axial_parities(both, 0.0)) == (0.0, 2)
    one, two = (cx.simulate(limited(system), **RUN, axial_period=9.0).spatial.fields["w"] for system in (PAIRS, other))
    assert_allclose(two, one, rtol=0, atol=1e-9 * np.abs(one).max())


def test_the_papers_law_stops_too_and_is_kept(tmp_path):
    system = limited(presets.load("active"), field_limit=1e5)
    run = cx.simulate(system, **RUN)
    assert_allclose(np.abs(run.actuator_voltage("outer", 0.0, station=0.0)).max(), 300.0, rtol=1e-9)
    kept = cx.load_response(run.save(tmp_path / "run.nc"))
    assert_allclose(forces_of(kept.spatial).lack, forces_of(run.spatial).lack, rtol=1e-9, atol=1e-12)
    again, before = (station_spectra(one.spatial).normal for one in (kept, run))
    assert_allclose(again, before, rtol=0, atol=1e-12 * np.abs(before).max())


EXACT = {
    "whole": pairs(("elastic", "thin"), saturation=True, field_limit=LIMIT),
    "cut": pairs(loss_factor=0.02, saturation=True, field_limit=LIMIT, segments=3, dead=[2]),
    "paper": limited(presets.load("active"), field_limit=1e4).with_overrides({f"shells[{i}].theory": "elastic" for i in (0, 1)}),
}


@pytest.mark.slow_except("whole")
@pytest.mark.parametrize("system", EXACT.values(), ids=EXACT.keys())
def test_exact_walls_are_cut_as_in_two_dimensions(system):
    system, free = (one.replace(source=PLANE.source) for one in (system, system.with_overrides({"control.saturation": False})))
    few = {**RUN, "modes": 4}
    flat = cx.simulate(system, duration=0.6, time_step=0.02, modes=4)
    motion, linear = (cx.simulate(one, **few).spatial.fields["w"] for one in (system, free))
    size = np.abs(linear).max()
    assert np.abs(motion - linear).max() > 1e-4 * size
    assert_allclose(motion[1], flat.solution.normal, rtol=0, atol=1e-12 * size)


def test_exact_walls_under_spherical_fronts():
    few = {**RUN, "modes": 3}
    others = ({"control.field_limit": 1e8}, {"control.saturation": False})
    wide, free = (cx.simulate(EXACT["whole"].with_overrides(one), **few) for one in others)
    assert_allclose(wide.spatial.fields["w"], free.spatial.fields["w"], rtol=0, atol=0)
    run = cx.simulate(EXACT["whole"], **few)
    assert_allclose(np.abs(run.actuator_voltage("outer", [0.0, 40.0], station=0.0)).max(), 30.0, rtol=1e-9)
    assert np.abs(run.energy().closure_relative).max() < 5e-5
    wall = run.spatial.problem.shells[0]
    depth = wall.layers[0].inner - wall.radius + 1e-3
    through = stresses_through(run.spatial, 0, [Asked("hoop", depth)], [0])[0, 0]
    within = histories_within(run.spatial, 0, depth)["hoop"][0] * run.spatial.problem.scales.pressure
    assert_allclose(through, within, rtol=0, atol=1e-9 * np.abs(within).max())


def test_a_limited_run_costs_more(whole):
    settings = whole.spatial.settings
    free, cut = (run_cost(system, settings) for system in (PAIRS, limited()))
    assert cut.memory > free.memory
    assert cut.seconds > 2.0 * free.seconds


@pytest.mark.parametrize(
    ("system", "told"),
    [
        (presets.load("electrodes-hybrid"), r"control\.saturation: beside absorbers .*use saturation = false"),
        (
            PAIRS.replace(source=cx.PlaneShock(peak_pressure=1e4, decay_time=1e-4, inclination=10.0)),
            r"control\.saturation: is not solved under a wave that runs along the axis; .* inclination = 0",
        ),
        (PAIRS.with_overrides({"control.segment_pitch": 0.5}), r"control\.saturation: electrodes that are cut along .* segment_pitch"),
    ],
    ids=["absorbers", "inclined", "belts"],
)
def test_what_is_not_solved_is_refused_with_a_remedy(system, told):
    with pytest.raises(InputError, match=told):
        cx.simulate(limited(system), **RUN)
