"""Runs whose walls are solids with losses: energy, stresses within layers and rubber, the limit of no loss, thin walls, files."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response import Response
from coaxshell.response.spatial import SpatialResponse
from coaxshell.structure import lossy_solid

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
WATER = cx.Fluid(density=1000, sound_speed=1400)
PZT = cx.materials.PZT4_STANDARD
RUBBER = cx.Viscoelastic(density=1100, long_term_modulus="6 MPa", poisson_ratio=0.499, prony=[("30 MPa", "1e-4 s"), ("5 MPa", "2 ms")])
SHOCK = cx.PlaneShock(peak_pressure=2.5e4, decay_time=1.3e-4)
RUN = {"duration": 1.2, "time_step": 6e-3, "modes": 8}


def system(eta: float = 0.1, coat: bool = False, **options) -> cx.System:
    """Return a shell of ceramics and steel with losses around one of steel, with or without a coat of rubber."""
    steel, ceramic = (material.replace(loss_factor=eta, **options) if eta else material for material in (STEEL, PZT))
    layers = [cx.Layer(ceramic, 3e-3, role="sensor"), cx.Layer(steel, 1e-2), cx.Layer(ceramic, 3e-3, role="actuator")]
    inner = [cx.Layer(STEEL, 2e-2), *([cx.Layer(RUBBER, 3e-2)] if coat else [])]
    shells = [cx.Shell(radius=0.5, layers=inner, theory="elastic"), cx.Shell(radius=1.0, layers=layers, theory="elastic")]
    return cx.System(shells=shells, fluids=[WATER] * 3, source=SHOCK)


@lru_cache(maxsize=4)
def run(eta: float = 0.1, coat: bool = False, model: str = "prony") -> Response:
    return cx.simulate(system(eta, coat, loss_model=model), **RUN)


@pytest.mark.parametrize(("coat", "model"), [(False, "prony"), (True, "prony"), (False, "constant-q")])
def test_energy_closes_with_what_the_walls_dissipate(coat, model):
    energy = run(0.1, coat, model).energy(every=40)
    assert float(np.abs(energy["closure_relative"]).max()) < 1e-5
    lossy = ("inner", "outer") if coat else ("outer",)
    for name in lossy:
        lost = energy[f"{name}_dissipation"]
        assert lost.attrs["role"] == "loss"
        assert float(lost[-1]) > 3e-3 * float(np.abs(energy["exterior_work"]).max())
        assert np.all(np.diff(lost) > -1e-9 * float(lost[-1]))
    assert "inner_dissipation" in energy or not coat


def test_small_losses_tend_to_none():
    plain = np.asarray(run(0.0).stress("outer"))
    changes = [np.abs(np.asarray(run(eta).stress("outer")) - plain).max() for eta in (1e-3, 1e-4)]
    assert changes[0] < 0.01 * np.abs(plain).max()
    assert changes[0] / changes[1] == pytest.approx(10.0, rel=0.05)


def test_stresses_meet_at_a_bonded_face_and_end_at_the_water():
    """The radial stress and the shear are the same on both sides of the joint, and minus the pressure and 0 at the outer face."""
    response = run(coat=True)
    joint = response.system.shells[0].thickness / 2 - 3e-2
    for component in ("radial", "radial_hoop"):
        metal, rubber = (np.asarray(response.stress("inner", [0, 50], joint + d, component=component)) for d in (-1e-7, 1e-7))
        np.testing.assert_allclose(metal, rubber, rtol=0, atol=1e-3 * np.abs(rubber).max())
        assert np.abs(rubber).max() > 0
    outer = np.asarray(response.stress("inner", [0, 50], "outer", component="radial_hoop"))
    assert np.abs(outer).max() < 1e-6 * np.abs(np.asarray(response.stress("inner", [0, 50], joint, component="radial_hoop"))).max()
    radial = np.asarray(response.stress("inner", [0], "outer", component="radial"))[:, 0]
    pressure = np.squeeze(response.pressure(radius=response.system.shells[0].outer_radius + 1e-9, angle=0, time=response.time[60::20]))
    np.testing.assert_allclose(radial[60::20], -pressure, rtol=0, atol=0.02 * np.abs(radial).max())


def test_the_kept_stress_is_that_of_its_depth():
    response = run(coat=True)
    for shell in ("inner", "outer"):
        depth = response.solution.problem.shells[0 if shell == "inner" else 1].design_depth
        kept, read = np.asarray(response.stress(shell)), np.asarray(response.stress(shell, depth=depth))
        np.testing.assert_allclose(read, kept, rtol=0, atol=1e-9 * np.abs(kept).max())


def test_thin_and_elastic_walls_with_losses_agree_on_a_thin_shell():
    core = cx.Layer(STEEL.replace(loss_factor=0.1), 4e-3)
    smooth = cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=2.5e4, width=2e-4, centre=1.2e-3))
    thin = cx.System(shells=[cx.Shell(radius=1.0, layers=[core], wetted="faces")], fluids=[cx.VACUUM, WATER], source=smooth)
    solid = thin.replace(shells=[cx.Shell(radius=1.0, layers=[core], theory="elastic")])
    runs = [np.asarray(cx.simulate(each, duration=3.0, time_step=1e-2, modes=6).stress(0)) for each in (thin, solid)]
    assert np.abs(runs[0] - runs[1]).max() < 0.01 * np.abs(runs[1]).max()


def test_files_hold_them(tmp_path):
    response = run(coat=True)
    again = cx.load_response(response.save(tmp_path / "run.nc"))
    np.testing.assert_array_equal(again.stress("outer"), response.stress("outer"))
    np.testing.assert_allclose(again.stress("inner", depth="outer"), response.stress("inner", depth="outer"), rtol=0, atol=1e-9 * 2.5e4)


def test_nearly_incompressible_is_asked_for_in_words():
    with pytest.raises(cx.InputError, match="poisson_ratio"):
        RUBBER.replace(poisson_ratio=0.5)


def test_the_largest_stress_anywhere_is_no_less_than_at_its_depths():
    response = run(coat=True)
    peak = response.peak_stress("inner")
    for depth in ("inner", "outer", 0.0):
        assert peak.value > 0.999 * float(np.abs(response.stress("inner", depth=depth, component="von_mises")).max())


def test_a_soft_layer_without_losses_needs_no_mesh_and_is_remarked_on(monkeypatch):
    """The same to 1e-9 as by shapes of a degree above 64, energies too, and no heat."""
    soft = cx.Elastic(name="gum", density=1100, youngs_modulus=3e6, poisson_ratio=0.45)
    inner = cx.Shell(radius=0.5, layers=[cx.Layer(STEEL, 2e-2), cx.Layer(soft, 3e-2)], theory="elastic")
    walls, runs, told = system(0.0).replace(shells=[inner, system(0.0).shells[1]]), [], []
    for most in (lossy_solid.SOFT_DEGREE, 1000):
        monkeypatch.setattr(lossy_solid, "SOFT_DEGREE", most)
        runs.append(cx.simulate(walls, duration=0.72, time_step=2.4e-2, modes=2))
        told.append([text for text in runs[-1].solution.warnings if "gum" in text])
    pieces, shapes = (np.asarray(found.stress("inner", [20, 90], depth="outer", component="von_mises")) for found in runs)
    np.testing.assert_allclose(pieces, shapes, rtol=0, atol=1e-9 * np.abs(shapes).max())
    assert [len(each) for each in told] == [1, 0]
    assert "inner shell: layer 2, gum, has no losses" in told[0][0]
    assert "30.67 m/s, 1.314 mm long" in told[0][0]  # at 0.8 pi/dt
    energy = runs[0].energy(every=15)
    assert float(np.abs(energy["closure_relative"]).max()) < 1e-5
    assert "inner_dissipation" not in energy


# Three dimensions

SPACE = {**RUN, "duration": 1.0, "time_step": 2e-2, "modes": 4, "dimensions": 3, "stations": [0.0, 0.5]}


def test_a_wave_across_the_axis_is_that_of_two_dimensions():
    smooth = system(coat=True).replace(source=cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=2.5e4, width=3e-4, centre=1.8e-3)))
    plane, space = (cx.simulate(smooth, duration=3.0, time_step=3e-2, modes=4, **more) for more in ({}, {"dimensions": 3}))
    for read in (
        lambda found: found.stress("inner", [20, 90], component="von_mises"),
        lambda found: found.stress("outer", [20, 90], depth="outer", component="hoop"),
        lambda found: found.sensor_voltage("outer", [20, 90]),
    ):
        flat = np.asarray(read(plane))
        np.testing.assert_allclose(np.asarray(read(space)).reshape(flat.shape), flat, rtol=0, atol=1e-12 * np.abs(flat).max())


@lru_cache(maxsize=2)
def sphere(coat: bool = True, model: str = "prony") -> SpatialResponse:
    source = cx.SphericalShock(distance=3.0, peak_pressure=2.5e4, decay_time=1.3e-4)
    found = cx.simulate(system(coat=coat, loss_model=model).replace(source=source), **SPACE)
    assert isinstance(found, SpatialResponse)
    return found


@pytest.mark.slow_for("False-constant-q")
@pytest.mark.parametrize(("coat", "model"), [(True, "prony"), (False, "constant-q")])
def test_energy_over_the_whole_length_closes_with_what_the_walls_dissipate(coat, model):
    energy = sphere(coat, model).energy(every=10)
    assert float(np.abs(energy["closure_relative"]).max()) < 5e-6
    for name in ("inner", "outer") if coat else ("outer",):
        lost = energy[f"{name}_dissipation"]
        assert lost.attrs["role"] == "loss"
        assert float(lost[-1]) > 1e-3 * float(np.abs(energy["exterior_work"]).max())
        assert np.all(np.diff(lost) > 0.0)


def test_stations_keep_the_stress_of_its_depth_and_faces_are_free_of_shear():
    found = sphere()
    for shell, number in (("inner", 0), ("outer", 1)):
        depth = found.spatial.problem.shells[number].design_depth
        kept, read = (np.asarray(found.stress(shell, [20, 90], station=0.5, **at)) for at in ({}, {"depth": depth}))
        np.testing.assert_allclose(read, kept, rtol=0, atol=1e-9 * np.abs(kept).max())
    joint = found.system.shells[0].thickness / 2 - 3e-2
    components = ("radial", "radial_hoop", "radial_axial")
    metal, rubber, face = (
        [np.asarray(found.stress("inner", [20, 90], depth, component=name, station=0.5)) for name in components]
        for depth in (joint - 1e-7, joint + 1e-7, "outer")
    )
    for inside, outside in zip(metal, rubber, strict=True):
        np.testing.assert_allclose(inside, outside, rtol=0, atol=1e-3 * np.abs(outside).max())
    for free, held in zip(face[1:], rubber[1:], strict=True):
        assert np.abs(free).max() < 1e-6 * np.abs(held).max()
