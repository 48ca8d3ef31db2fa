"""Runs with layers as elastic solids: against an independent solution, thin walls, static fields, balances, and what is refused."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.response import Response
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.shells import shell_energy
from coaxshell.response.energy.work import SurfaceWork
from coaxshell.solver.cascade import CascadeSystem
from coaxshell.solver.cost import run_cost
from coaxshell.solver.run_size import size_of
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.structure import elastic_basis as bases
from coaxshell.structure.elastic_basis import PotentialOfLayer, elastic_basis
from coaxshell.structure.elastic_wall import Asked, ElasticWall

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
WATER = cx.Fluid(density=1000, sound_speed=1400)
PZT = cx.materials.PZT4_STANDARD
TRANSIT = 1.0 / 1400.0
SMOOTH = cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=2.5e4, width=0.1 * TRANSIT, centre=0.6 * TRANSIT))
SHOCK = cx.PlaneShock(peak_pressure=2.5e4, decay_time=1.3e-4)


def thick(source=SMOOTH, **theory) -> cx.System:
    walls = [cx.Shell(radius=r, layers=[cx.Layer(STEEL, t)], **theory) for r, t in ((0.5, 0.03), (1.0, 0.05))]
    return cx.System(shells=walls, fluids=[WATER] * 3, source=source)


def layered(**theory) -> cx.System:
    layers = [cx.Layer(PZT, 2e-3, role="sensor"), cx.Layer(STEEL, 2e-2), cx.Layer(PZT, 2e-3, role="actuator")]
    outer = cx.Shell(radius=1.0, layers=layers, **theory)
    return cx.System(shells=[cx.RigidShell(radius=0.3), thick().shells[0], outer], fluids=[cx.VACUUM, WATER, WATER, WATER], source=SHOCK)


@lru_cache(maxsize=4)
def response(modes: int = 12, duration: float = 1.2, time_step: float = 4e-3) -> Response:
    return cx.simulate(thick(theory="elastic"), duration=duration, time_step=time_step, modes=modes)


@lru_cache(maxsize=1)
def of_layers() -> Response:
    return cx.simulate(layered(theory="elastic"), duration=1.0, time_step=4e-3, modes=6)


def test_thick_walls_agree_with_an_independent_solution(quick_rows):
    found = [row for row in quick_rows("exact-walls") if "other method" in row.expected]
    assert len(found) == 6
    assert max(row.error for row in found) < 1e-8


SLOW = cx.Gaussian(peak_pressure=2.5e4, width=0.4 * TRANSIT, centre=2.4 * TRANSIT)


def ring(thickness: float, **theory) -> cx.System:
    wall = cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, thickness)], **theory)
    return cx.System(shells=[wall], fluids=[cx.VACUUM, WATER], source=SMOOTH.replace(pulse=SLOW))


def test_receptances_tend_to_those_of_thin_walls():
    """O(h): what is left at half the thickness is half."""
    modes, s, errors = Modes.up_to(5), np.array([0.5 + 1.0j, 1.0 + 3.0j]), []
    for thickness in (4e-3, 2e-3, 1e-3):
        thin, solid = (
            dimensionless(ring(thickness, **theory)).shells[0].receptance(modes, s)
            for theory in ({"wetted": "faces"}, {"theory": "elastic"})
        )
        errors.append(max(float(np.abs(getattr(solid, name) / getattr(thin, name) - 1.0).max()) for name in ("inner", "across", "outer")))
    assert errors[0] < 0.05
    np.testing.assert_allclose([errors[1] / errors[0], errors[2] / errors[1]], 0.5, atol=0.05)


def test_runs_tend_to_those_of_thin_walls_at_their_faces():
    errors = []
    for thickness in (0.02, 0.01):
        thin, solid = (
            cx.simulate(ring(thickness, **theory), duration=4.0, time_step=1e-2, modes=4).modal(0, "stress").to_numpy()[0, 3]
            for theory in ({"wetted": "faces"}, {"theory": "elastic"})
        )
        errors.append(float(np.linalg.norm(thin - solid) / np.linalg.norm(solid)))
    assert errors[0] < 0.01
    assert errors[1] < 0.5 * errors[0]


def test_faces_carry_the_pressure_of_the_fluids():
    found = response(40, 1.5)
    for shell, face, radius in (("outer", "inner", 0.975), ("inner", "outer", 0.515), ("inner", "inner", 0.485)):
        stress = found.stress(shell, [0, 60, 180], depth=face, component="radial").sel(time=1.5, method="nearest")
        inside = 1e-9 if face == "outer" else -1e-9
        pressure = found.pressure(radius=[radius * (1.0 + inside)], angle=[0, 60, 180], time=1.5)
        np.testing.assert_allclose(stress, -pressure[0], atol=2e-5 * float(np.abs(pressure).max()))


def test_histories_are_those_of_their_depth():
    found = response()
    for shell in ("inner", "outer"):
        np.testing.assert_allclose(
            found.stress(shell, depth=0.0), found.stress(shell), atol=1e-9 * float(np.abs(found.stress(shell)).max())
        )
        for component in ("normal", "tangential"):
            kept = found.displacement(shell, [20, 90], component)
            np.testing.assert_allclose(
                found.displacement(shell, [20, 90], component, depth=0.0), kept, atol=1e-9 * float(np.abs(kept).max())
            )
    inner, outer = (found.displacement("outer", 0, depth=face) for face in ("inner", "outer"))
    assert float(np.abs(outer - inner).max()) > 1e-3 * float(np.abs(outer).max())
    von_mises = found.stress("outer", [0], component="von_mises")
    assert float(von_mises.max()) > 0.5 * float(np.abs(found.stress("outer", [0])).max())


def test_energy_closes():
    found = cx.simulate(thick(SHOCK, theory="elastic"), duration=0.8, time_step=4e-3, modes=5).energy(every=5)
    assert float(np.abs(found["closure_relative"]).max()) < 1e-6


def test_walls_hold_the_work_of_the_loads_on_their_faces():
    """Of every layer, beside a rigid wall: kinetic, strain and piezoelectric energy together, to the rounding of the inverse transform."""
    motion = Motion.of(of_layers().solution, 5)
    for shell in (1, 2):
        wall, (held, _) = motion.problem.shells[shell], shell_energy(motion, shell)
        works = [
            SurfaceWork(motion.grid, wall.wetted[side] * motion.circle, motion.face_velocity(shell, side))(motion.solid.loads[side, shell])
            for side in (0, 1)
        ]
        work = sum(works)[motion.kept]
        np.testing.assert_allclose(held.kinetic + held.strain + held.piezoelectric, work, atol=1e-7 * np.abs(work).max())
    assert held.piezoelectric.max() > 0.0


def test_reciprocity():
    """What a load on one face moves another by is what the other's load moves the first by, radii counted."""
    problem = dimensionless(layered(theory="elastic"))
    modes, s = Modes.up_to(5), np.array([2.0 + 7.0j, 1.0 + 40.0j])
    system, places = CascadeSystem(problem, s, modes), [(1, 0), (1, 1), (2, 0), (2, 1)]
    answers = np.empty((4, 4, modes.count, s.size), complex)
    for j, (shell, side) in enumerate(places):
        moved = system.solve(shell, 1.0 / problem.shells[shell].wetted[side], side)
        answers[:, j] = [(moved[i].inner, moved[i].outer)[face] for i, face in places]
    np.testing.assert_allclose(answers, np.swapaxes(answers, 0, 1), rtol=1e-7)


# Within the wall


def wall_of(system: cx.System, shell: int = -1) -> ElasticWall:
    wall = dimensionless(system).shells[shell]
    assert isinstance(wall, ElasticWall)
    return wall


def test_static_stresses_through_the_thickness_are_lame_s():
    wall, s = wall_of(thick(theory="elastic")), np.array([1e-5 + 0j])
    a, b = wall.wetted
    for depth in (-0.025, -0.01, 0.0, 0.02, 0.025):
        r = wall.radius + depth
        names = ("hoop", "radial", "axial", "radial_hoop")
        per_load = wall.transfer(Modes.up_to(0), s, [Asked(name, depth) for name in names])[:, :, 0, 0].real
        inside, outside = -1.0 * per_load[:, 0], per_load[:, 1]  # under a pressure of 1 on either face
        for found, (p_in, p_out) in ((inside, (1.0, 0.0)), (outside, (0.0, 1.0))):
            mean = (p_in * a**2 - p_out * b**2) / (b**2 - a**2)
            apart = (p_in - p_out) * a**2 * b**2 / (b**2 - a**2) / r**2
            np.testing.assert_allclose(found, [mean + apart, mean - apart, 0.6 * mean, 0.0], rtol=1e-8, atol=1e-8 * abs(mean))


@pytest.mark.parametrize("wavenumber", [0.0, 1.5])
def test_loads_meet_their_faces_and_shears_vanish_there(wavenumber):
    wall = wall_of(layered(theory="elastic"))
    modes, s = Modes.up_to(4, wavenumber), np.array([2.0 + 9.0j])
    for side, depth in enumerate(wall.faces):
        asked = [Asked(name, depth) for name in ("radial", "radial_hoop", "radial_axial", "hoop")]
        radial, *shears, hoop = wall.transfer(modes, s, asked)[..., 0]
        sign = 1.0 if side == 0 else -1.0  # an inward load pulls at the inner face
        np.testing.assert_allclose(radial[side], sign, rtol=1e-5)
        assert np.abs(radial[1 - side]).max() < 1e-5 * np.abs(hoop).max()
        assert np.abs(shears).max() < 1e-5 * np.abs(hoop).max()


@pytest.mark.parametrize("depth", [-0.0113, -0.006, 0.0108])
def test_stresses_balance_the_motion(depth):
    """div sigma = rho s^2 u at points of both ceramics and of the core, all six stresses and three displacements of a mode."""
    m, k, step, s = 4.0, 1.5, 4e-6, np.array([2.0 + 30.0j])
    wall = wall_of(layered(theory="elastic")).resolving(3e4)
    r, density = wall.radius + depth, wall.layers[wall.layer_at(depth)].density
    names = ("radial", "hoop", "axial", "shear", "radial_axial", "radial_hoop", "normal", "tangential", "along_axis")
    asked = [Asked(name, depth + shift) for name in names for shift in (-step, 0.0, step)]
    found = wall.transfer(Modes(np.array([m]), k), s, asked)[:, 1, 0, 0].reshape(-1, 3)
    rr, tt, zz, tz, rz, rt, normal, around, along = found[:, 1]
    slope = (found[:, 2] - found[:, 0]) / (2.0 * step)
    for balance, moved, largest in (
        (slope[0] + (rr - tt + m * rt) / r + k * rz, -normal, tt / r),
        (slope[5] + (2.0 * rt - m * tt) / r + k * tz, around, m * tt / r),
        (slope[4] + (rz + m * tz) / r - k * zz, along, k * zz),
    ):
        assert abs(balance - density * s[0] ** 2 * moved) < 2e-5 * abs(largest)


def test_potential_between_grounded_faces():
    """Under u_r = r^2: mu Phi = (2 e33 + e32) ((r^2 - a^2)/2 - (b^2 - a^2)/2 ln(r/a)/ln(b/a))."""
    wall = wall_of(layered(theory="elastic"))
    (part,) = elastic_basis(wall.layers, Modes.up_to(0), 300.0)
    mesh = part.mesh.layers[0]
    e, mu, r, a, b = mesh.layer.coupling, mesh.layer.permittivity[0], mesh.radius, mesh.layer.inner, mesh.layer.outer
    found = PotentialOfLayer(mesh, np.zeros(1), 0.0).values[0][:, 0] @ r**2
    share = 0.5 * (r**2 - a**2) - 0.5 * (b**2 - a**2) * np.log(r / a) / np.log(b / a)
    expected = (2.0 * e[0][0] + e[0][1]) * share / mu
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


def test_sensors_read_the_potential_in_the_middle_of_their_layers():
    """As the sensor equation has it, up to what stretching does through the curvature, which it leaves out: 1/m^2."""
    thin, solid = (cx.simulate(_sensing(**theory), duration=4.0, time_step=2e-2, modes=9) for theory in ({}, {"theory": "elastic"}))
    thin, solid = (each.modal("outer", "sensor_voltage").to_numpy()[0] for each in (thin, solid))
    correlation = np.sum(thin * solid, axis=-1)[5:] / np.sum(solid**2, axis=-1)[5:]
    np.testing.assert_allclose(correlation, 1.0, atol=0.1)


def _sensing(**theory) -> cx.System:
    layers = [cx.Layer(PZT, 1e-3, role="sensor"), cx.Layer(STEEL, 8e-3), cx.Layer(PZT, 1e-3, role="actuator")]
    wall = cx.Shell(radius=1.0, layers=layers, wetted="faces", **theory)
    return cx.System(shells=[wall], fluids=[cx.VACUUM, WATER], source=SMOOTH.replace(pulse=SLOW))


# Saved, thinned, described


def test_saved_runs_are_read_alike(tmp_path):
    found = of_layers()
    again = cx.load_response(found.save(tmp_path / "run.nc"))
    for read in (
        lambda run: run.stress("outer"),
        lambda run: run.sensor_voltage("outer"),
        lambda run: run.stress("outer", depth="outer", component="von_mises"),
    ):
        np.testing.assert_array_equal(read(again), read(found))
    fewer = found.thin(5)
    np.testing.assert_array_equal(fewer.stress("outer"), found.stress("outer")[::5])
    with pytest.raises(cx.InputError, match="every one of them"):
        fewer.stress("outer", depth="outer")


def test_the_theory_stands_in_descriptions():
    system = thick(theory="elastic")
    text = system.to_toml_string()
    assert text.count('theory = "elastic"') == 2
    assert cx.System.from_toml_string(text) == system
    assert "theory" not in thick().to_toml_string()
    assert system.head_radius == pytest.approx(1.025)


def test_orders_left_out_are_estimated():
    """The estimate is of the size of what more orders change."""
    few, many = (response(modes) for modes in (12, 40))
    change = np.linalg.norm(few.stress("outer", range(0, 181, 5)) - many.stress("outer", range(0, 181, 5)))
    true = float(change / np.linalg.norm(many.stress("outer", range(0, 181, 5))))
    printed = float(few.estimates.orders[1, 1])
    assert 0.5 * true < printed < 10.0 * true


# Refused


def test_the_direct_engine_refuses():
    with pytest.raises(cx.InputError, match=r"shells\[0\]\.theory: 'elastic' is not known to the direct engine"):
        cx.simulate(thick(theory="elastic"), duration=0.5, time_step=1e-2, modes=4, engine="direct")


def test_missing_constants_are_refused():
    lacking = [cx.Layer(PZT.replace(c44=None), 1e-2, role="passive")]
    with pytest.raises(cx.InputError, match=r"shells\[0\]\.layers\[0\]\.material\.c44"):
        cx.simulate(thick().replace(shells=[cx.Shell(radius=1.0, layers=lacking, theory="elastic")], fluids=[WATER] * 2), modes=4)


def test_components_and_depths_are_refused_by_name():
    with pytest.raises(cx.InputError, match="'shear' vanishes"):
        response().stress("inner", component="shear")
    with pytest.raises(cx.InputError, match="allowed: hoop, axial, radial, radial_hoop, von_mises"):
        response().stress("inner", component="hop")
    thin = cx.simulate(thick(), duration=0.3, time_step=1e-2, modes=4)
    with pytest.raises(cx.InputError, match="moves as its mid-surface does"):
        thin.displacement("inner", depth=0.0)
    with pytest.raises(cx.InputError, match="belongs to three dimensions"):
        thin.stress("inner", component="shear")


def test_the_memory_of_a_run_counts_what_elastic_walls_keep():
    settings = Settings(duration=4.0, time_step=1e-3, modes=100)
    thin, solid = (run_cost(thick(**theory), settings).memory for theory in ({}, {"theory": "elastic"}))
    assert 1.5 * thin < solid < 4.0 * thin


def test_the_memory_of_a_run_counts_the_shapes_that_outlast_it():
    bases._known.clear()
    cx.simulate(thick(theory="elastic"), duration=0.3, time_step=1e-2, modes=12)
    kept = bases._known.bytes
    assert kept > 0
    size = size_of(dimensionless(thick(theory="elastic")), Settings(duration=0.3, time_step=1e-2, modes=12))
    assert size.shapes == kept
    finer = size_of(dimensionless(thick(theory="elastic")), Settings(duration=0.3, time_step=5e-3, modes=12))
    assert size.shapes < finer.shapes < 6 * size.shapes
