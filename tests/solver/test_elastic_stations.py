"""Layers as elastic solids in three dimensions: against two, thin walls, potentials without elements, reciprocity, balances."""

from __future__ import annotations

import pickle
from functools import lru_cache, partial

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.progress import ShareDone
from coaxshell.response.spatial import SpatialResponse
from coaxshell.solver.axial.blocks import Found
from coaxshell.solver.cost import run_cost
from coaxshell.solver.settings import Settings
from coaxshell.structure.elastic_depth import STRESSES
from coaxshell.structure.shell_model import SOLID_STRESSES

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
WATER = cx.Fluid(density=1000, sound_speed=1400)
PZT = cx.materials.PZT4_STANDARD
TRANSIT = 1.0 / 1400.0
SLOW = cx.Gaussian(peak_pressure=2.5e4, width=0.4 * TRANSIT, centre=2.4 * TRANSIT)
BROAD = cx.Gaussian(peak_pressure=2.5e4, width=0.8 * TRANSIT, centre=4.8 * TRANSIT)
"""What waves above 6 leave out of it is 1e-5."""
PLANE = cx.PlaneWave(pulse=SLOW)
SPHERE = cx.SphericalWave(distance=3.0, pulse=SLOW)
QUICK = {"duration": 3.0, "time_step": 2e-2, "modes": 4}
SPACE = {**QUICK, "dimensions": 3, "stations": [0.0, 0.5]}


def system(source, theory: str = "elastic") -> cx.System:
    """Return a rigid core, an outer wall with two ceramics, thin or not, and a thick wall between."""
    layers = [cx.Layer(PZT, 4e-3, role="sensor"), cx.Layer(STEEL, 3e-2), cx.Layer(PZT, 4e-3, role="actuator")]
    walls = [cx.RigidShell(radius=0.3), cx.Shell(radius=0.6, layers=[cx.Layer(STEEL, 0.04)], theory="elastic")]
    outer = cx.Shell(radius=1.0, layers=layers, theory=theory)
    return cx.System(shells=[*walls, outer], fluids=[cx.VACUUM, WATER, WATER, WATER], source=source)


@lru_cache(maxsize=8)
def run(source=SPHERE, theory: str = "elastic", **settings) -> SpatialResponse:
    found = cx.simulate(system(source, theory), **{**SPACE, **settings})
    assert isinstance(found, SpatialResponse)
    return found


def error(found, expected) -> float:
    return float(np.linalg.norm(np.asarray(found) - np.asarray(expected)) / np.linalg.norm(np.asarray(expected)))


def test_stresses_have_one_list_of_names():
    assert tuple(STRESSES) == SOLID_STRESSES


@pytest.mark.parametrize("theory", ["elastic", "thin"])
def test_a_wave_across_the_axis_is_that_of_two_dimensions(theory):
    plane, space = cx.simulate(system(PLANE, theory), **QUICK), run(PLANE, theory)
    for shell in (1, 2):
        solid = shell == 1 or theory == "elastic"
        of_stress = partial(cx.Response.stress, shell=shell, angle=[20, 90])
        of_motion = partial(cx.Response.displacement, shell=shell, angle=[20, 90])
        reads = [of_motion, partial(of_motion, component="tangential")]
        reads += [partial(of_stress, component=name) for name in ("hoop", "axial", "von_mises", *(("radial_hoop",) if solid else ()))]
        reads += [partial(of_stress, depth="outer", component="von_mises")] if solid else []
        reads += [partial(cx.Response.sensor_voltage, shell=2, angle=[20, 90])] if shell == 2 else []
        for read in reads:
            assert error(read(space, station=0.5), read(plane)) < 1e-9
        if solid:
            assert not np.any(space.stress(shell, component="shear"))
            assert not np.any(space.stress(shell, component="radial_axial"))
    assert not np.any(space.displacement(2, component="axial"))


def test_what_is_odd_along_the_axis_vanishes_beside_the_source():
    found = run()
    for shell in (1, 2):
        reads = [partial(found.stress, shell, [20, 90], component=name) for name in ("shear", "radial_axial")]
        reads += [partial(found.displacement, shell, [20, 90], "axial")]
        for read in reads:
            assert np.abs(read(station=0.0)).max() < 1e-12 * np.abs(read(station=0.5)).max()


def test_integrals_along_the_axis_are_those_of_the_longest_wave():
    """The trapezoidal rule over a period leaves k = 0 alone, two of it: the wave that nothing changes along the axis of."""
    period, half = 16.0, 6  # more than k_max L/(4 pi)
    z = np.arange(half + 1) * period / (2 * half)
    weights = np.where((z == 0) | (z == z[-1]), 1.0, 2.0) * z[1]
    found = run(stations=tuple(z), axial_period=period, duration=1.2)
    alone = {**SPACE, "duration": 1.2, "stations": [0.0], "axial_period": period, "axial_modes": 0.2}
    one = cx.simulate(found.system, **alone)
    for component in ("hoop", "axial", "radial"):
        added = np.einsum("tza,z->ta", np.asarray(found.stress("outer", [0, 60], component=component)), weights)
        assert error(added, period * np.asarray(one.stress("outer", [0, 60], component=component, station=0.0))) < 1e-9
    assert found.spatial.sampling.wavenumbers.size > one.spatial.sampling.wavenumbers.size == 1


def ring(thickness: float, **theory) -> cx.System:
    wall = cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, thickness)], **theory)
    return cx.System(shells=[wall], fluids=[cx.VACUUM, WATER], source=SPHERE)


def test_thin_walls_are_the_limit():
    """O(h): half the thickness, half the difference or less, in all that a station tells of the motion and of the stress along the wall."""
    reads = {
        "w": lambda found: found.displacement(0, [30, 150]),
        "u": lambda found: found.displacement(0, [30, 150], "axial"),
        "hoop": lambda found: found.stress(0, [30, 150]),
        "axial": lambda found: found.stress(0, [30, 150], component="axial"),
        "shear": lambda found: found.stress(0, [30, 150], component="shear"),
    }
    errors = []
    for thickness in (0.02, 0.01):
        alike = {**SPACE, "axial_period": 16.0}
        thin, solid = (cx.simulate(ring(thickness, **kind), **alike).at(0.5) for kind in ({"wetted": "faces"}, {"theory": "elastic"}))
        errors.append({name: error(read(thin), read(solid)) for name, read in reads.items()})
    for name, most in (("w", 3e-3), ("hoop", 3e-3), ("u", 0.03), ("axial", 0.01), ("shear", 3e-3)):
        assert errors[0][name] < most, name
    assert max(errors[1][name] / errors[0][name] for name in ("u", "axial", "shear")) < 0.6


def test_faces_carry_the_pressure_of_the_fluids_at_every_station():
    """What is read within the walls, in a second pass, against the field in the fluids, in a third."""
    found = run(SPHERE.replace(pulse=BROAD), duration=6.0, time_step=4e-2, modes=6)
    for shell, face, beside in ((2, "outer", 1.019 + 1e-9), (2, "inner", 0.981 - 1e-9), (1, "outer", 0.62 + 1e-9)):
        stress = found.stress(shell, [0, 60, 180], depth=face, component="radial", station=0.5).sel(time=5.6, method="nearest")
        pressure = found.pressure(radius=[beside], angle=[0, 60, 180], z=0.5, time=5.6, time_resolution=4e-2)
        left_out = 2e-3 if (shell, face) == (2, "outer") else 5e-5  # there the incident wave is whole, the others end at order 6
        np.testing.assert_allclose(stress, -np.asarray(pressure).squeeze(), atol=left_out * float(np.abs(pressure).max()))


def test_histories_are_those_of_their_depth():
    found = run()
    wall = found.spatial.problem.shells[2]
    for component in SOLID_STRESSES:
        kept = found.stress(2, [20, 90], component=component, station=0.5)
        assert error(found.stress(2, [20, 90], wall.design_depth, component=component, station=0.5), kept) < 1e-9
    for component in ("normal", "tangential", "axial"):
        kept = found.displacement(2, [20, 90], component, station=0.5)
        assert error(found.displacement(2, [20, 90], component, depth=0.0, station=0.5), kept) < 1e-9
    outer, inner = (found.displacement(2, 30, "axial", depth=face, station=0.5) for face in ("outer", "inner"))
    assert error(outer, inner) > 1e-3
    summary = found.summary()
    largest = max(float(found.stress(2, np.arange(0, 181), component="von_mises").max()), 1.0)
    assert summary.largest[1]["von_mises_stress"]["value"] == pytest.approx(largest, rel=1e-3)


@pytest.mark.parametrize(("modes", "limit"), [(4, 2e-4), pytest.param(8, 2e-7, marks=pytest.mark.slow)], ids=["few", "many"])
def test_reciprocity_of_two_points_off_each_other_s_plane(modes, limit):
    """A source at one point gives another what a source there gives the first, distances of their fronts counted.

    To what orders and wavenumbers leave out, whatever the time step and the axial period: 1e-4 up to order 4, 2e-6 up to 6, 5e-8 up to 8,
    1e-10 up to 10.
    """
    places, times = ((3.0, 0.0, 0.0), (2.0, 50.0, 0.6)), np.array([7.0, 7.5])
    answers = []
    for (r, angle, z), (far, around, along) in (places, places[::-1]):
        walls = system(cx.SphericalWave(distance=r, angle=angle, z=z, pulse=BROAD))
        start = r - walls.head_radius
        found = cx.simulate(walls, **{**SPACE, "duration": 6.6, "time_step": 4e-2, "modes": modes})
        asked = times - start
        at = found.pressure(radius=[far], angle=[around], z=along, time=asked, part="scattered", time_resolution=4e-2)
        answers.append(np.asarray(at).squeeze() / start)
    assert np.abs(answers[0]).max() > 1.0
    np.testing.assert_allclose(answers[0], answers[1], rtol=limit)


def test_energy_over_the_whole_length_closes():
    """To rounding where no fluid is enclosed; with gaps to what the fluids' fields lose at this step (1e-5 of thin walls too)."""
    shock = cx.SphericalShock(distance=3.0, peak_pressure=2.5e4, decay_time=1.3e-4)
    dry = system(shock).replace(fluids=[cx.VACUUM, cx.VACUUM, cx.VACUUM, WATER])
    for walls, limit in ((dry, 1e-12), (system(shock), 1e-5)):
        found = cx.simulate(walls, duration=1.0, time_step=2e-2, modes=3, dimensions=3).energy(every=10)
        assert float(np.abs(found["closure_relative"]).max()) < limit
        assert float(found["outer_piezoelectric"].max()) > 0.0


def test_saved_runs_are_read_alike(tmp_path):
    found = run()
    again = cx.load_response(found.save(tmp_path / "run.nc"))
    for read in (
        lambda run: run.stress(2, component="radial_axial"),
        lambda run: run.stress(1, component="von_mises"),
        lambda run: run.sensor_voltage(2),
        lambda run: run.stress(2, depth="outer", component="shear"),
    ):
        np.testing.assert_array_equal(read(again), read(found))
    fewer = found.thin(5)
    np.testing.assert_array_equal(fewer.stress(2, component="axial"), found.stress(2, component="axial")[::5])
    with pytest.raises(cx.InputError, match="every one of them"):
        fewer.stress(2, depth="outer")


def test_blocks_elsewhere_find_the_same(monkeypatch):
    """Blocks that know of nothing but what is sent to them, each making its own shapes."""
    expected = run()

    def sent(work: partial[Found], parts: list[slice], tell: ShareDone | None = None):
        for part in parts:
            yield pickle.loads(pickle.dumps(work))(part)

    monkeypatch.setattr("coaxshell.solver.axial.solve.on_threads", sent)
    found = cx.simulate(expected.system, **SPACE)
    np.testing.assert_allclose(found.stress(2), expected.stress(2), rtol=1e-9, atol=1e-9 * float(np.abs(expected.stress(2)).max()))


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"source": cx.PlaneWave(pulse=SLOW, inclination=20.0)}, r"source\.inclination: 20 degrees: .* pressure waves in the .* run ahead"),
    ],
)
def test_what_is_not_solved_is_refused(changed, message):
    with pytest.raises(cx.InputError, match=message):
        cx.simulate(system(PLANE).replace(**changed), **SPACE)


def test_components_are_refused_by_name():
    with pytest.raises(cx.InputError, match="allowed: radial, hoop, axial, shear, radial_axial, radial_hoop, von_mises"):
        run().stress(2, component="hop")
    with pytest.raises(cx.InputError, match="allowed: normal, tangential, axial"):
        run().displacement(2, component="radial", depth=0.0)


def test_the_memory_of_a_run_counts_what_elastic_walls_keep():
    settings = Settings(duration=4.0, time_step=4e-3, modes=60, dimensions=3)
    thin, solid = (run_cost(ring(0.05, **theory), settings) for theory in ({}, {"theory": "elastic"}))
    assert 1.5 * thin.memory < solid.memory < 20.0 * thin.memory
    assert 1.2 * thin.seconds < solid.seconds < 5.0 * thin.seconds
