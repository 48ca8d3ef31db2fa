"""Velocity and acceleration of a shell: derivatives of its displacement, and of a plate under a front the closed form."""

from __future__ import annotations

import copy
import csv
import pickle
import weakref
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from coaxshell import InputError, load_response, simulate
from coaxshell.export import export_csv
from coaxshell.model import Fluid, Layer, PDControl, PlaneWave, RigidShell, Shell, System, Vacuum, materials, presets
from coaxshell.model.pulses import Gaussian, Step
from coaxshell.response import Response
from coaxshell.solver import recompute

ANGLES = [0.0, 50.0, 180.0]
WATER = Fluid(density=1000, sound_speed=1400)
SMOOTH = PlaneWave(pulse=Gaussian(peak_pressure=2.5e4, width=4e-5))
COARSE = {"duration": 2.0, "time_step": 0.02, "modes": 12}
RATES = ("shell_velocity", "tangential_shell_velocity", "shell_acceleration", "tangential_shell_acceleration")
SYSTEMS = {
    "bare": presets.load("bare"),
    "linear absorbers": presets.load("absorbers").with_overrides({"absorbers.cubic_stiffness": 0.0, "absorbers.linear_stiffness": 1e9}),
    "cubic absorbers": presets.load("absorbers"),
    "feedback": presets.load("active"),
    "saturation": presets.load("active").replace(control=PDControl(proportional=-2e4, derivative=-150, saturation=True, field_limit=1e3)),
}


def integrals(system, time_step):
    """Return the relative error of integrals of velocity and acceleration by the trapezoidal rule, for both components."""
    response = simulate(system, duration=2.0, time_step=time_step, modes=12)
    seconds, found = response.time_seconds, []
    for component in ("normal", "tangential"):
        w, dw, ddw = (
            np.asarray(read("outer", ANGLES, component))
            for read in (response.displacement, response.shell_velocity, response.shell_acceleration)
        )
        for value, rate in ((w, dw), (dw, ddw)):
            error = cumulative_trapezoid(rate, seconds, axis=0, initial=0.0) - (value - value[0])
            found.append(np.abs(error).max() / np.abs(value).max())
    return np.array(found)


@pytest.mark.parametrize("name", ["bare", "cubic absorbers", "saturation"])
def test_integrals_give_displacement_and_velocity_to_the_order_of_the_rule(name):
    coarse, fine = (integrals(SYSTEMS[name].replace(source=SMOOTH), step) for step in (0.01, 0.005))
    assert fine.max() < 1e-3
    np.testing.assert_allclose(coarse / fine, 4.0, rtol=0.1)


def test_forces_of_a_march_do_not_end_with_the_run():
    """The last instants of a run are those of a longer one; cut off, the forces would leave half their jump there (0.4 of the largest)."""
    short, long = (simulate(SYSTEMS["cubic absorbers"].replace(source=SMOOTH), duration=t, time_step=5e-3, modes=12) for t in (2.0, 3.0))
    ours, theirs = (np.asarray(one.shell_acceleration("outer", 180.0))[:401] for one in (short, long))
    assert np.abs(ours - theirs).max() < 2e-3 * np.abs(theirs).max()


def test_a_plate_under_a_front():
    """At the head w'' = (2 p/m) exp(-rho c t/m) until the curvature is felt, 0.75 per transit; at contact the mean of both sides."""
    steel = materials.STRUCTURAL_STEEL
    system = System(
        shells=[Shell(radius=1.0, layers=[Layer(steel, 0.02)])],
        fluids=[Vacuum(), WATER],
        source=PlaneWave(pulse=Step(pressure=1e5)),
    )
    response = simulate(system, duration=0.06, time_step=1e-3, modes=400)
    mass, pressure = steel.density * 0.02, 1e5
    found = np.asarray(response.shell_acceleration("outer", 0.0)) * mass / (2 * pressure)
    expected = np.exp(-WATER.density * WATER.sound_speed * response.time_seconds / mass)
    window = slice(10, 31)
    curvature = 1.0 - 0.75 * response.time[window]
    np.testing.assert_allclose(found[window], expected[window] * curvature, rtol=0.02)
    assert found[0] == pytest.approx(0.5, abs=0.01)
    assert 1.06 < found.max() < 1.10


@pytest.mark.parametrize(("rise", "most"), [(0.0, 0.09), (2.0, 0.01), (5.0, 0.006)])
def test_overshoot_beside_a_jump(rise, most):
    grid = recompute.LaplaceGrid(1e-3, 2000)
    ramp = (1 - np.exp(-grid.nodes * rise * 1e-3)) / (grid.nodes * rise * 1e-3) if rise else 1.0
    found = grid.invert(np.exp(-0.5 * grid.nodes) / grid.nodes * ramp)
    assert most / 2 < found.max() - 1.0 < most
    if not rise:
        assert found[500] == pytest.approx(0.5, abs=1e-3)
        np.testing.assert_allclose(found[550], 1.0, atol=5e-5)


def test_the_direct_engine_agrees():
    system = presets.load("bare").replace(source=SMOOTH)
    spectral, direct = (simulate(system, duration=2.0, time_step=2e-3, modes=8, engine=engine) for engine in ("spectral", "direct"))
    for name, limit in (
        ("displacement", 3e-3),
        ("shell_velocity", 3e-3),
        ("shell_acceleration", 5e-3),
        ("tangential_shell_velocity", 5e-3),
    ):
        ours, theirs = (np.asarray(response.history("inner", ANGLES, name)) for response in (spectral, direct))
        assert np.linalg.norm(ours - theirs) < limit * np.linalg.norm(ours), name


def test_rates_of_the_direct_engine_are_its_own():
    response = simulate(presets.load("active"), duration=1.0, time_step=2e-3, modes=4, engine="direct")
    scale = response.solution.problem.scales.length / response.solution.problem.scales.time
    expected = scale * response.solution.normal_rate[0]
    np.testing.assert_allclose(response.modal("inner", "shell_velocity"), expected, rtol=0, atol=1e-9 * np.abs(expected).max())
    w = response.modal("inner").to_numpy()
    step = response.time_seconds[1]
    middle = (w[..., 2:] - 2 * w[..., 1:-1] + w[..., :-2]) / step**2
    acceleration = response.modal("inner", "shell_acceleration").to_numpy()
    np.testing.assert_allclose(acceleration[..., 1:-1], middle, rtol=0, atol=1e-9 * np.abs(middle).max())
    assert np.abs(acceleration[..., -1] - acceleration[..., -2]).max() < 0.05 * np.abs(acceleration).max()


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_saved_run_gives_the_same_bits(name, tmp_path):
    response = simulate(SYSTEMS[name], **COARSE)
    assert name != "saturation" or response.solution.control_correction.any()
    again = load_response(response.save(tmp_path / "run.nc"))
    for quantity in RATES:
        np.testing.assert_array_equal(again.history("inner", ANGLES, quantity), response.history("inner", ANGLES, quantity))
    fields = [one.pressure(x=[0.3, 1.5], y=[0.2], time=[1.0, 2.0]) for one in (response, again)]
    np.testing.assert_array_equal(*fields)


def test_refinement_keeps_the_runs_instants(tmp_path):
    response = simulate(SYSTEMS["cubic absorbers"], refinement=2, **COARSE)
    assert response.shell_acceleration("outer").shape == (101, 2)
    again = load_response(response.save(tmp_path / "run.nc"))
    np.testing.assert_array_equal(again.shell_velocity("outer"), response.shell_velocity("outer"))
    fine = simulate(SYSTEMS["cubic absorbers"], **{**COARSE, "time_step": 0.01})
    np.testing.assert_allclose(response.shell_velocity("outer"), fine.shell_velocity("outer")[::2], rtol=0, atol=1e-12)


def test_what_a_run_was_made_from_goes_with_its_solution():
    solution = simulate(SYSTEMS["bare"], **COARSE).solution
    assert solution.spectra.normal.nbytes
    assert "SolvedSpectra" not in repr(solution)
    for other in (replace(solution), copy.copy(solution), pickle.loads(pickle.dumps(solution))):
        assert other.spectra is None
    kept = weakref.ref(solution.spectra)
    del solution
    assert kept() is None


def test_more_than_half_a_gigabyte_is_not_kept(monkeypatch):
    monkeypatch.setattr("coaxshell.solver.solution.KEPT_BYTES", 1000)
    assert simulate(SYSTEMS["bare"], **COARSE).solution.spectra is None


def test_files_of_the_version_before_have_velocities():
    response = load_response(Path(__file__).parent / "data" / "format-1.netcdf")
    speed, shift = (np.asarray(read("outer", 0.0)) for read in (response.shell_velocity, response.displacement))
    difference = np.gradient(shift, response.time_seconds, edge_order=2)
    assert np.linalg.norm(difference - speed) < 0.2 * np.linalg.norm(speed)


def test_a_part_of_a_run_has_none_and_says_so(tmp_path):
    part = simulate(SYSTEMS["bare"], **COARSE).thin(every=2)
    with pytest.raises(InputError, match="velocity and acceleration of shells"):
        part.shell_velocity("inner")
    assert part.summary().shells[0].shell_velocity is None
    with export_csv(part, tmp_path / "part.csv").open(encoding="utf-8") as file:
        assert not [name for name in next(csv.reader(file)) if "velocity" in name or "acceleration" in name]


def test_rigid_shells_do_not_move():
    system = System(
        shells=[RigidShell(radius=0.5), Shell(radius=1.0, layers=[Layer(materials.ALUMINIUM, 0.01)])],
        fluids=[WATER, WATER, WATER],
        source=SMOOTH,
    )
    response = simulate(system, **COARSE)
    for read in (response.displacement, response.shell_velocity, response.shell_acceleration):
        assert not np.asarray(read("inner", ANGLES)).any()
        assert not np.asarray(read("inner", ANGLES, "tangential")).any()


def test_labels_and_refusals():
    response = simulate(SYSTEMS["bare"], **COARSE)
    found = response.shell_acceleration("inner", 30.0, component="tangential")
    assert (found.name, found.attrs["units"], found.attrs["sign"]) == (
        "tangential_shell_acceleration",
        "m/s^2",
        "positive towards increasing angle",
    )
    with pytest.raises(InputError, match="'axial' is unknown; allowed: normal, tangential"):
        response.shell_velocity("inner", component="axial")
    assert isinstance(response, Response)
