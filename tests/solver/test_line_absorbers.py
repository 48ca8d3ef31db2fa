"""Line absorbers of three-dimensional runs: two dimensions as their limit, exact against marched, rows of points, moved sources, limits."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.solver.axial import line_newton
from coaxshell.solver.axial import solve as axial_solve
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.series import AxialSeries
from coaxshell.solver.cost import run_cost

RUN = {"duration": 1.0, "time_step": 4e-2, "modes": 6, "dimensions": 3}
LINKS = {"mass": 20.0, "damping": 1e4, "linear_stiffness": 1e8}
CUBIC = {**LINKS, "cubic_stiffness": 1e21}
FLAT = {name: value for name, value in RUN.items() if name != "dimensions"}
BARE = cx.presets.load("bare")
LINE = BARE.replace(source=cx.LineShock(peak_pressure=2.5e4, decay_time=1.3e-4, distance=5, angle=20.0))
ANGLES = [0, 50, 180, 230]


def off(found, true):
    found, true = np.asarray(found), np.asarray(true)
    return float(np.linalg.norm(found - true) / np.linalg.norm(true))


def run(absorbers, system=BARE, **changes):
    return cx.simulate(system.replace(absorbers=absorbers), **{**RUN, **changes})


def listed(angles, **properties):
    return [cx.Absorber(angle=angle, **properties) for angle in angles]


@pytest.mark.parametrize("links", [LINKS, CUBIC], ids=["linear", "cubic"])
@pytest.mark.parametrize("places", [{"count": 4}, {"count": 5, "offset": 13.0}, {"angles": (0, 33, 127.3)}, {"angles": (90, 180)}], ids=str)
def test_what_is_uniform_along_the_axis_is_two_dimensional(links, places):
    absorbers = listed(**places, **links) if "angles" in places else cx.absorber_ring(**places, **links)
    flat = cx.simulate(LINE.replace(absorbers=absorbers), **FLAT)
    found = run(absorbers, LINE, stations=[0.0, 0.7])
    for station in (0.0, 0.7):
        for shell in ("inner", "outer"):
            assert off(found.stress(shell, ANGLES, station=station), flat.stress(shell, ANGLES)) < 1e-10
        assert off(found.absorber_force(station), flat.absorber_force()) < 1e-10
        assert off(found.absorber_displacement(station), flat.absorber_displacement()) < 1e-10


def test_all_of_the_hybrid_system_under_a_line_source_is_two_dimensional():
    system = cx.presets.load("hybrid").replace(source=LINE.source)
    flat = cx.simulate(system, **{**FLAT, "time_step": 2e-2})
    found = cx.simulate(system, **{**RUN, "time_step": 2e-2}, stations=[0.4])
    assert off(found.stress("inner", ANGLES, station=0.4), flat.stress("inner", ANGLES)) < 1e-10
    assert off(found.absorber_force(0.4), flat.absorber_force()) < 1e-10


def test_marched_forces_tend_to_the_exact_ones_at_second_order():
    almost = {**LINKS, "cubic_stiffness": 1e-3}
    errors = []
    for step in (2e-2, 1e-2):
        exact, marched = (run(cx.absorber_ring(4, **links), stations=[0.0, 0.5], time_step=step) for links in (LINKS, almost))
        errors.append(off(marched.absorber_force(), exact.absorber_force()))
        told = marched.errors().sel(cause="march", quantity="stress").to_numpy()
        assert off(marched.stress("inner"), exact.stress("inner")) < 5 * told.max()
        assert off(marched.absorber_displacement(), exact.absorber_displacement()) < 2e-2 * 4.0 ** (1 - len(errors))
    assert errors[0] < 8e-3
    assert errors[1] < errors[0] / 3


@pytest.mark.parametrize(("mass", "cubic"), [(20.0, 0.0), (0.0, 1e21), (1e9, 1e21)], ids=["linear", "cubic without mass", "cubic, held"])
def test_a_row_of_points_that_resolves_every_product_is_a_line(monkeypatch, mass, cubic):
    # n points in a period see sums along the axis exactly where n > 2J, and their cubes where n > 4J; masses between the walls, or at rest,
    # have no more wavenumbers than the walls, others of a row feel the cubes that lie above
    period, waves = 2.4, 3
    sampling = AxialSampling(period, 6, 2 * np.pi * waves / period)
    monkeypatch.setattr(axial_solve, "require_room", lambda *_, **__: None)
    monkeypatch.setattr(axial_solve, "resolved_sampling", lambda *_: (sampling, []))
    links, spacing = {**LINKS, "mass": mass, "cubic_stiffness": cubic}, period / (4 * waves + 1)
    settings = {"duration": 0.6, "time_step": 3e-2, "modes": 6, "stations": [0.0, spacing]}
    line = run(listed([0, 80], **links), **settings)
    each, places = {name: value * spacing for name, value in links.items()}, np.arange(-2 * waves, 2 * waves + 1) * spacing
    row = run([cx.PointAbsorber(angle=angle, z=z, footprint=1e-9, **each) for angle in (0, 80) for z in places], **settings)
    for shell in ("inner", "outer"):
        assert off(row.stress(shell, ANGLES), line.stress(shell, ANGLES)) < 1e-8
    if not cubic:
        at_origin = [2 * waves, 6 * waves + 1]
        assert off(row.absorber_force()[at_origin] / spacing, line.absorber_force(0.0)) < 1e-8
    bare = run((), **settings)
    assert off(bare.stress("inner", ANGLES), line.stress("inner", ANGLES)) > 1e-3


def test_a_source_that_is_moved_along_the_axis_moves_everything_with_it():
    ring = cx.absorber_ring(4, **CUBIC)
    here = run(ring, stations=[0.0, 0.4, -0.4])
    there = run(ring, BARE.replace(source=BARE.source.model_copy(update={"z": 0.3})), stations=[0.3, 0.7, -0.1])
    for component in ("hoop", "axial", "shear"):
        assert off(there.stress("inner", ANGLES, component=component), here.stress("inner", ANGLES, component=component)) < 1e-10
    assert off(there.absorber_force(), here.absorber_force()) < 1e-10
    assert off(here.absorber_force(-0.4), here.absorber_force(0.4)) < 1e-12


def test_sources_in_two_planes_are_marched_without_symmetry():
    # a faint source at z = 0.2 m makes z = 0 the origin, about which the other one is neither even nor odd
    ring, faint = cx.absorber_ring(4, **CUBIC), BARE.source.model_copy(update={"z": 0.2, "peak_pressure": 1e-6})
    strong = BARE.source.model_copy(update={"z": -0.3})
    both = run(ring, BARE.replace(source=(strong, faint)), stations=[-0.7, 0.1])
    alone = run(ring, BARE.replace(source=strong), stations=[-0.7, 0.1], axial_period=both.settings.axial_period)
    assert off(both.absorber_force(), alone.absorber_force()) < 1e-9
    assert off(both.stress("inner", ANGLES), alone.stress("inner", ANGLES)) < 1e-9


def test_an_empty_oscillator_and_a_rigid_link_are_limits():
    settings = {"stations": [0.3]}
    light = run(listed([40, -40], mass=1e-6, linear_stiffness=1e-3), **settings)
    assert off(light.stress("inner", ANGLES), run((), **settings).stress("inner", ANGLES)) < 1e-9
    stiff = run(listed([40, -40], mass=0.0, linear_stiffness=1e15), **settings)
    inner, outer = (stiff.displacement(shell, angle=40, station=0.3) for shell in ("inner", "outer"))
    assert off(inner, outer) < 1e-4
    force = stiff.absorber_force(0.3)
    np.testing.assert_allclose(force.sel(side="inner"), -force.sel(side="outer"), rtol=1e-6, atol=1e-6 * float(abs(force).max()))


def test_the_wall_at_an_absorber_moves_as_its_links_say():
    # without a damper f = k (q - w): what the forces do at a station is what they do along the absorber's own line
    links = {"mass": 20.0, "linear_stiffness": 1e8}
    found = run(listed([30], **links), stations=[0.3])
    for side in ("inner", "outer"):
        wall = found.absorber_displacement(0.3)[0] - found.absorber_force(0.3)[0].sel(side=side) / links["linear_stiffness"]
        assert off(found.displacement(side, angle=30, station=0.3), wall) < 1e-6


def test_cubes_are_what_the_law_makes_of_the_stretch_at_a_station():
    # once all wavenumbers that matter are there: f = k_l D + k_nl D^3 at every z, D = q - w
    links = {"mass": 20.0, "linear_stiffness": 1e8, "cubic_stiffness": 1e20}
    smooth = BARE.replace(source=BARE.source.model_copy(update={"rise_time": 4e-4}))
    found = run(listed([30], **links), smooth, stations=[0.0, 0.3], axial_modes=24)
    for station in (0.0, 0.3):
        for side in ("inner", "outer"):
            stretch = found.absorber_displacement(station)[0] - found.displacement(side, angle=30, station=station)
            law = links["linear_stiffness"] * stretch + links["cubic_stiffness"] * stretch**3
            assert off(found.absorber_force(station)[0].sel(side=side), law) < 2e-3
            assert off(links["linear_stiffness"] * stretch, law) > 0.02


@pytest.mark.slow
def test_more_axial_wavenumbers_change_no_more_than_is_told():
    ring = cx.absorber_ring(4, **CUBIC)
    few, many = (run(ring, stations=[0.0, 0.3, 0.6, 1.0], axial_modes=top) for top in (8, 24))
    for shell, told in zip(("inner", "outer"), few.errors().sel(cause="axial wavenumbers", quantity="stress").to_numpy(), strict=True):
        change = off(few.stress(shell, ANGLES), many.stress(shell, ANGLES))
        assert change < told < 30 * change


def test_steps_solved_one_by_one_are_those_solved_at_once(monkeypatch):
    ring = cx.absorber_ring(4, **{**CUBIC, "cubic_stiffness": 1e23})
    at_once = run(ring, stations=[0.2])
    monkeypatch.setattr(line_newton, "_SLOWEST", 0.0)
    assert off(run(ring, stations=[0.2]).absorber_force(), at_once.absorber_force()) < 1e-7


def test_products_along_a_period_are_exact():
    rng = np.random.default_rng(1)
    for parities in (1, 2):
        series = AxialSeries(5, parities)
        coefficients = rng.normal(size=(5, 3, parities))
        if parities == 2:
            coefficients[0, :, 1] = 0.0
        z = np.arange(64) / 64
        shapes = np.stack([np.cos(2 * np.pi * np.outer(z, np.arange(5))), np.sin(2 * np.pi * np.outer(z, np.arange(5)))][:parities])
        whole = np.einsum("pzk,knp->zn", shapes, coefficients)
        np.testing.assert_allclose(series.coefficients(series.values(coefficients)), coefficients, atol=1e-13)
        cubes = np.einsum("pzk,zn->knp", shapes, whole**3) * np.where(np.arange(5) == 0, 1 / 64, 2 / 64)[:, None, None]
        np.testing.assert_allclose(series.coefficients(series.values(coefficients) ** 3), cubes, atol=1e-12)
        np.testing.assert_allclose(series.weights @ series.values(coefficients) ** 4, (whole**4).mean(axis=0), rtol=1e-12)


def test_what_is_read_of_them():
    found = run(listed([0, 90], **LINKS), stations=[0.0, 0.2])
    force, moved = found.absorber_force(), found.absorber_displacement()
    assert force.dims == ("absorber", "side", "station", "time")
    assert moved.dims == ("absorber", "station", "time")
    assert force.attrs["units"] == "N/m"
    assert found.absorber_force("20 cm").dims == ("absorber", "side", "time")
    assert found.at(0.2).absorber_force().shape[2] == 1
    told = found.summary().to_dict()
    assert told["absorber_force"] == pytest.approx(float(abs(force).max()))
    assert told["absorber_force_unit"] == "N/m"
    assert "N/m" in str(found.summary())
    np.testing.assert_array_equal(found.to_dataframe()["absorber 1 displacement z = 0.2 m (m)"], moved[1, 1])
    # the mass answers the sum of both links' forces: m q'' = -(f_0 + f_1)
    time = force["time_seconds"].to_numpy()
    acceleration = np.gradient(np.gradient(moved[0, 0], time), time)
    assert off(LINKS["mass"] * acceleration[4:-4], -force[0, :, 0].sum("side")[4:-4]) < 0.1


def test_files_hold_what_they_did(tmp_path):
    found = run(cx.absorber_ring(3, **CUBIC), stations=[0.0, 0.3])
    loaded = cx.load_response(found.save(tmp_path / "run.nc"))
    np.testing.assert_array_equal(loaded.absorber_force(), found.absorber_force())
    np.testing.assert_array_equal(loaded.absorber_displacement(), found.absorber_displacement())
    np.testing.assert_array_equal(loaded.stress("inner"), found.stress("inner"))
    again = loaded.without_transforms().shell_velocity("outer")
    np.testing.assert_allclose(again, found.shell_velocity("outer"), rtol=0, atol=1e-12 * float(abs(again).max()))
    few = found.thin(5)
    np.testing.assert_array_equal(few.absorber_force(), found.absorber_force()[..., ::5])
    assert cx.load_response(few.save(tmp_path / "few.nc")).absorber_force().shape == few.absorber_force().shape


def test_pressure_on_a_cut_knows_them():
    settings = {"stations": [0.3]}
    found, bare = run(cx.absorber_ring(4, **CUBIC), **settings), run((), **settings)
    near, plain = (one.pressure(x=[-0.9], y=[0.1], z=0.3, time=[0.8]) for one in (found, bare))
    assert abs(float(near[0, 0, 0]) / float(plain[0, 0, 0]) - 1.0) > 1e-3
    # a run with a station there has the waves that the cut asks for: forces are those of these, not of the nearest of the run's
    long, there = run(cx.absorber_ring(4, **CUBIC), stations=[0.9]), {"x": [-0.9], "y": [0.1], "z": 0.9, "time": [RUN["duration"]]}
    assert found.spatial.sampling.period < long.spatial.sampling.period
    np.testing.assert_allclose(found.pressure(**there), long.pressure(**there), rtol=1e-9)
    assert [forces.sampling.period for forces in found.spatial.forces] == [one.spatial.sampling.period for one in (found, long)]


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (
            lambda: run([cx.Absorber(mass=1), cx.PointAbsorber(z=0, mass=1)]),
            "absorbers: line absorbers and point absorbers.*a row of them, at most 0.52 m apart",
        ),
        (
            lambda: run([cx.Absorber(mass=1, linear_stiffness=1, cubic_stiffness=1), cx.PointAbsorber(z=0, mass=1)], modes="auto"),
            "closer than half the shortest axial wave",
        ),
        (
            lambda: run(
                cx.absorber_ring(4, **LINKS), BARE.replace(source=cx.PlaneShock(peak_pressure=1e4, decay_time=1e-4, inclination=30))
            ),
            r"source\.inclination: 30 degrees: a wave that runs along line absorbers",
        ),
        (lambda: run(cx.absorber_ring(4, **LINKS), stations=[0.0]).absorber_force(0.3), "none of the run's"),
        (lambda: run((), stations=[0.0]).absorber_force(), "has none"),
    ],
)
def test_what_does_not_fit_is_refused(make, match):
    with pytest.raises(InputError, match=match):
        make()


def test_what_they_cost_is_told():
    settings = cx.Settings(duration=5.0, time_step=4e-3, modes=60, dimensions=3, stations=(0.0,))
    bare, hybrid = (run_cost(cx.presets.load(name), settings) for name in ("bare", "hybrid"))
    assert 0.6e9 < hybrid.memory < 2e9  # 1.0 GB was measured
    assert 3 * bare.seconds < hybrid.seconds < 10 * bare.seconds  # 5.6 was measured


@pytest.mark.parametrize(
    ("cubic", "change", "grows"),
    [
        (0.0, {"time_step": 2e-3}, 2.0),  # nodes
        (0.0, {"modes": 240}, 4.0),  # orders and wavenumbers
        (0.0, {"count": 64}, 8.0),  # matrices of points
        (1e20, {"time_step": 2e-3}, 2.0),  # steps
        (1e20, {"axial_modes": 120.0}, 2.0),  # wavenumbers
        (1e20, {"count": 256}, 4.0),  # what happens between points in a step
    ],
)
def test_what_they_cost_grows_with_what_is_asked(cubic, change, grows):
    base = {"count": 128 if cubic else 32, "time_step": 4e-3, "modes": 60 if cubic else 120}

    def seconds(count, **settings):
        ring = cx.absorber_ring(count, offset=1.0, mass=10.0, linear_stiffness=1e9, cubic_stiffness=cubic)
        space = cx.Settings(duration=5.0, dimensions=3, stations=(0.0,), **settings)
        return run_cost(BARE.replace(absorbers=ring), space).seconds - run_cost(BARE, space).seconds

    ratio = seconds(**{**base, **change}) / seconds(**base)
    assert 0.75 * grows < ratio < 1.35 * grows
