"""Currents that stop at their limit in three dimensions: against two, a dense march, open circuits, charges at stations, energy, steps."""

from __future__ import annotations

import numpy as np
import pytest
from dense_limits import DensePoints
from electrode_pairs import pairs
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.response.electrical import of_segments
from coaxshell.solver.axial import limited_surface
from coaxshell.solver.axial.lack import Channels, wave_patterns
from coaxshell.solver.axial.limited_surface import SurfaceStep, WallSurface
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.cost import run_cost
from coaxshell.solver.limited_voltages import march_lack
from coaxshell.solver.scaling import dimensionless

PAIRS = presets.load("electrodes")
PLANE = PAIRS.replace(source=cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4))
RUN = {"duration": 0.6, "time_step": 0.02, "modes": 5, "dimensions": 3, "stations": [0.0, 0.3]}


def limited(system: cx.System = PAIRS, limit: str = "1 A/m^2", *, stops: bool = True, **control: object) -> cx.System:
    given = {"segments": 4, "current_limit": limit, "current_saturation": stops, **control}
    return system.with_overrides({f"control.{name}": value for name, value in given.items()})


@pytest.fixture(scope="module")
def held():
    return cx.simulate(limited(), **RUN, axial_modes=12)


def motion(system: cx.System, **other: object) -> np.ndarray:
    return cx.simulate(system, **{**RUN, **other}).spatial.fields["w"]


@pytest.fixture(scope="module")
def cut():
    return motion(limited())


def apart(one: np.ndarray, other: np.ndarray) -> float:
    return float(np.linalg.norm(one - other) / np.linalg.norm(other))


def test_uniform_sources_are_cut_as_in_two_dimensions():
    flat = cx.simulate(limited(PLANE), duration=0.6, time_step=0.02, modes=5)
    found = cx.simulate(limited(PLANE), **RUN)
    size = np.abs(flat.solution.normal).max()
    assert_allclose(found.spatial.fields["w"][1], flat.solution.normal, rtol=0, atol=1e-12 * size)
    volts = found.actuator_voltage("outer", [0, 60], station=0.3).to_numpy()
    assert_allclose(volts, flat.actuator_voltage("outer", [0, 60]).to_numpy(), rtol=0, atol=1e-10 * np.abs(volts).max())


def test_what_reaches_no_limit_is_the_linear_answer():
    free, wide = (motion(limited(limit="1 kA/m^2", stops=stops), duration=0.1, modes=4) for stops in (False, True))
    assert_allclose(wide, free, rtol=0, atol=0)


def test_no_current_is_an_open_circuit(cut):
    # u = -m/C is what pairs of equal layers read, fed back with k_p = 1; the current lets through a thousandth.
    opened = motion(PAIRS.with_overrides({"control.segments": 4, "control.proportional": 1, "control.derivative": 0}))
    assert apart(motion(limited(limit="1 mA/m^2")), opened) < 2e-4
    assert apart(cut, opened) > 5e-3


def test_charges_grow_by_the_limit(held):
    step = RUN["time_step"] * held.spatial.problem.scales.time
    for station in (0, 1):
        rate = np.abs(np.diff(of_segments(held.motions[station], 1).charge)) / step
        steps = rate[rate > 0.9]
        assert steps.size >= 8
        assert_allclose(np.median(steps), 1.0, rtol=0.04)
    effort = held.control_effort()
    assert effort.at(0.0).within
    assert sum("the current was held at 1.000 A/m^2" in told for told in held.warnings) == 2
    assert 0.0 < held.spatial.estimates.march.max() < 0.05


def test_a_run_ends_as_a_longer_one_goes_on(held):
    short = cx.simulate(limited(), **{**RUN, "duration": 0.56}, axial_modes=12)  # with another period, which tells little
    for station in (0, 1):
        ended, longer = (of_segments(run.motions[station], 0) for run in (short, held))
        size = np.abs(longer.voltage).max()
        assert abs(longer.current[0, 28]) == 1.0
        assert_allclose(ended.voltage, longer.voltage[:, :29], rtol=0, atol=0.04 * size)  # 0.19 where the lack is cut off
        assert_allclose(ended.current, longer.current[:, :29], rtol=0, atol=0.35)


@pytest.mark.parametrize("segments", [4, None])
def test_a_limit_judges_what_is_asked_for_at_the_stations(segments):
    run = cx.simulate(limited(stops=False, segments=segments), **{**RUN, "duration": 0.3})
    (told,) = (text for text in run.warnings if "of its amplifier" in text)
    most = max(one["outer"].current for one in run.control_effort().each)
    assert told.startswith(f"outer shell: the control law asks for {most:.3f} A/m^2 (mean over ")
    assert f"{most:.3g} times the 1.000 A/m^2 of its amplifier; " in told
    assert ("set control.current_saturation = true" in told) == (segments is not None)  # whole electrodes know no limit of the current


def test_energy_closes():
    cut = cx.simulate(limited(), **{**RUN, "duration": 0.24, "modes": 4, "stations": [0.0]})
    energy = cut.energy()
    assert np.abs(energy.closure_relative).max() < 5e-5
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-9 * np.abs(energy.actuator_work).max()


def test_steps_converge(cut):
    runs = [cut, *(motion(limited(), refinement=refinement) for refinement in (2, 4))]
    first, second = apart(runs[0], runs[1]), apart(runs[1], runs[2])
    assert first < 3e-4
    assert first / second > 2.0


def test_waves_agree_with_a_dense_march(monkeypatch):
    rng, problem = np.random.default_rng(3), dimensionless(limited(), dimensions=3)
    channels, walls, steps, parities = Channels.of(problem, AxialSampling(2.0, 3, 3 * np.pi)), 2, 5, 2
    surface = WallSurface(wave_patterns(problem, channels.sampling.modes[0]), channels, parities)
    shape = (walls, parities, channels.count)
    weights = 0.2 * rng.normal(size=(walls, walls, channels.count, 1)) * np.exp(-0.3 * np.arange(steps))
    weights[0, 0, :, 0], weights[1, 1, :, 0] = -rng.uniform(-0.2, 0.9, size=(2, channels.count))
    weights[0, 1, :, 0] = weights[1, 0, :, 0] = 0.01
    asked, limits = np.cumsum(rng.normal(size=(*shape, steps)), axis=-1), np.full((walls, surface.evaluate.shape[1]), 1.5)

    def march() -> np.ndarray:
        return march_lack(SurfaceStep(surface, limits, weights[..., 0].copy()).solve, weights, asked, moving=True)[0]

    found = march()
    DensePoints.of(surface, channels, parities).require_lack(found, weights, asked, 1.5, moving=True)
    monkeypatch.setattr(limited_surface, "_MAX_SETS", 1)  # as if the points held turned in circles
    assert_allclose(march(), found, atol=1e-8)
    for name in ("_MOST", "_MOST_TURNS"):  # iterations that do not end are refused
        with monkeypatch.context() as few:
            few.setattr(limited_surface, name, 2)
            with pytest.raises(InputError, match=r"time_step: .* do not settle within a step; use a quarter of it"):
                march()


EXACT = {"segments": 3, "current_limit": 1.0, "current_saturation": True}


@pytest.mark.slow_except("mixed")
@pytest.mark.parametrize(("kinds", "loss"), [(("thin", "elastic"), 0.0), (("elastic", "elastic"), 0.02)], ids=["mixed", "lossy"])
def test_exact_walls_are_cut_as_in_two_dimensions(kinds, loss):
    system = pairs(kinds, loss, **EXACT).replace(source=PLANE.source)
    flat = cx.simulate(system, duration=0.3, time_step=0.02, modes=3).solution.normal
    found = cx.simulate(system, **{**RUN, "duration": 0.3, "modes": 3})
    assert any("current was held" in told for told in found.warnings)
    assert_allclose(found.spatial.fields["w"][1], flat, rtol=0, atol=1e-12 * np.abs(flat).max())


@pytest.mark.slow
def test_exact_walls_under_spherical_fronts():
    few = {**RUN, "modes": 3}
    held, none, opened = (
        cx.simulate(one, **few)
        for one in (
            pairs(**EXACT),
            pairs(**{**EXACT, "current_limit": 1e-3}),
            pairs(segments=3, numerator=[1.0]),  # u = -m/C, but for what orders differ in
        )
    )
    assert np.abs(held.energy().closure_relative).max() < 3e-5
    assert apart(none.spatial.fields["w"], opened.spatial.fields["w"]) < 5e-4
    assert apart(held.spatial.fields["w"], opened.spatial.fields["w"]) > 1e-2


def test_a_limited_run_costs_more(held):
    free, cut = (run_cost(limited(stops=stops), held.spatial.settings) for stops in (False, True))
    assert cut.memory > free.memory
    assert cut.seconds > 2.0 * free.seconds


@pytest.mark.parametrize(
    ("system", "told"),
    [
        (
            PAIRS.replace(absorbers=[cx.PointAbsorber(z=0.0, mass=5.0)]),
            r"control\.current_saturation: beside absorbers currents .*use current_saturation = false",
        ),
        (
            PAIRS.replace(source=cx.PlaneShock(peak_pressure=1e4, decay_time=1e-4, inclination=10.0)),
            r"control\.current_saturation: is not solved under a wave that runs along the axis; .* inclination = 0",
        ),
        (PAIRS.with_overrides({"control.segment_pitch": 0.5}), r"control\.current_saturation: electrodes that are cut .* segment_pitch"),
    ],
    ids=["absorbers", "inclined", "belts"],
)
def test_what_is_not_solved_is_refused_with_a_remedy(system, told):
    with pytest.raises(InputError, match=told):
        cx.simulate(limited(system), **RUN)
