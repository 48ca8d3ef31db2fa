"""Grids, parts, blocks and labels of a pressure field; and means over a region."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response import Response
from coaxshell.response.fields import scattered
from coaxshell.response.fields.inversion import Inversion, band

COARSE = {"duration": 2.0, "time_step": 0.01, "modes": 40}
SHOCK = {"peak_pressure": 2.5e4, "decay_time": 1.314e-4}
AXIS = (np.arange(90) + 0.5 - 45) / 18  # 90 pixels from -2.5 to 2.5


@pytest.fixture(scope="module")
def lopsided(double) -> Response:
    """Return a run without any symmetry: two sources of different kinds off the axis, one of them late."""
    line = cx.LineShock(distance=4.0, angle=200.0, delay=2e-4, **SHOCK)
    return cx.simulate(double.replace(source=[cx.SphericalShock(distance=5.0, angle=31.0, **SHOCK), line]), **COARSE)


@pytest.fixture(scope="module")
def loaded() -> Response:
    """Return the paper's hybrid system, coarse: nonlinear absorbers and feedback."""
    return cx.simulate(cx.presets.load("hybrid"), **COARSE)


@pytest.fixture(params=["lopsided", "loaded"])
def answer(request) -> Response:
    return request.getfixturevalue(request.param)


def test_parts_add_up(answer):
    grid = {"x": np.linspace(-2, 2, 9), "y": np.linspace(-1.5, 2, 8), "time": [0.3, 1.7]}
    part = {name: answer.pressure(part=name, **grid).values for name in ("total", "incident", "diffracted", "radiated", "scattered")}
    scale = abs(part["total"]).max()
    np.testing.assert_allclose(part["diffracted"] + part["radiated"], part["scattered"], atol=1e-10 * scale)
    np.testing.assert_allclose(part["incident"] + part["scattered"], part["total"], atol=1e-10 * scale)
    within = np.hypot(*np.meshgrid(grid["x"], grid["y"])) < 1
    for name in ("incident", "diffracted"):
        assert np.all(part[name][:, within] == 0.0)
        assert np.any(part[name][:, ~within] != 0.0)


def test_cartesian_equals_polar_at_the_same_points(answer):
    x, y = np.array([0.1, -0.7, 1.9]), np.array([0.05, -1.3])
    found = answer.pressure(x, y, time=[0.5, 1.6])
    for i in range(x.size):
        for j in range(y.size):
            angle = np.degrees(np.arctan2(y[j], x[i]))
            polar = answer.pressure(radius=np.hypot(x[i], y[j]), angle=angle, time=[0.5, 1.6]).values[:, 0, 0]
            np.testing.assert_allclose(
                found.values[:, j, i], polar, rtol=0, atol=1e-6 * 2.5e4
            )  # the wake of a line source is a table made for its points


@pytest.mark.slow_except("lopsided-pressure", "loaded-velocity")
@pytest.mark.parametrize("quantity", ["pressure", "velocity"])
def test_interpolated_grids_equal_exact_ones(answer, quantity):
    # Many pixels are interpolated, few are not; the largest error is at fronts that no pixel resolves.
    times = [0.35, 1.2, 2.0]
    read = getattr(answer, quantity)
    whole = read(AXIS, AXIS, time=times).values
    assert scattered.raster_radii(answer.motion.spectra.problem, _Asked, np.linspace(0, 3.5, 9)) < 1000
    for row in (3, 44, 61):
        exact = read(AXIS, AXIS[row], time=times).values[..., 0, :]
        assert abs(whole[..., row, :] - exact).max() < 5e-4 * abs(whole).max()
        assert np.median(abs(whole[..., row, :] - exact)) < 2e-7 * abs(whole).max()


class _Asked:
    resolution = 0.01


@pytest.mark.slow_for("lopsided")
def test_interpolation_does_not_reach_across_a_wall(answer):
    # Pixels next to either face of both shells, by interpolation and one by one.
    whole = answer.pressure(AXIS, AXIS, time=1.1).values
    xs, ys = np.meshgrid(AXIS, AXIS)
    radius = np.hypot(xs, ys)
    near = np.argwhere((abs(radius - 0.5) < 0.02) | (abs(radius - 1.0) < 0.02))[::6]
    assert len(near) > 10
    for row, column in near:
        exact = answer.pressure(AXIS[column], AXIS[row], time=1.1).values[0, 0]
        assert abs(whole[row, column] - exact) < 2e-5 * abs(whole).max()


def test_a_raster_through_the_centre_and_one_off_it(lopsided):
    for centre in (0.0, 0.3):
        axis = centre + np.linspace(-0.12, 0.12, 61)
        whole = lopsided.velocity(axis, axis, time=1.3, time_resolution=0.02).values
        exact = lopsided.velocity(axis[::15], axis[30], time=1.3, time_resolution=0.02).values[:, 0]
        np.testing.assert_allclose(whole[:, 30, ::15], exact, atol=1e-4 * abs(exact).max())


@pytest.mark.slow_for("lopsided")
def test_blocks_change_nothing(answer):
    told = []
    times = np.linspace(0, 2, 41)
    one = answer.pressure(AXIS, AXIS, time=times, memory=2e9)
    many = answer.pressure(AXIS, AXIS, time=times, memory=64e6, progress=lambda fraction, stage: told.append((fraction, stage)))
    np.testing.assert_allclose(many, one, rtol=0, atol=1e-12 * float(abs(one).max()))
    assert told[-1][0] == pytest.approx(1.0)
    assert all(a[0] <= b[0] for a, b in pairwise(told))


def test_polar_blocks_change_nothing(answer):
    grid = {"radius": np.linspace(0, 3, 60), "angle": [0.0, 77.0], "time": answer.time}
    one, many = (answer.pressure(memory=memory, **grid) for memory in (2e9, 64e6))
    np.testing.assert_allclose(many, one, rtol=0, atol=1e-12 * float(abs(one).max()))


def test_there_is_no_seam(answer):
    angles = np.array([0.0, 360.0, 180.0, -180.0, 1e-7, -1e-7, 180 - 1e-7, 180 + 1e-7])
    p = answer.pressure(radius=[0.3, 0.8, 1.4], angle=angles, time=[0.6, 1.5]).values
    scale = abs(p).max()
    np.testing.assert_allclose(p[..., 0], p[..., 1], rtol=0, atol=1e-12 * scale)
    np.testing.assert_allclose(p[..., 2], p[..., 3], rtol=0, atol=1e-12 * scale)
    np.testing.assert_allclose(p[..., 4], p[..., 5], rtol=0, atol=1e-7 * scale)
    np.testing.assert_allclose(p[..., 6], p[..., 7], rtol=0, atol=1e-7 * scale)


def test_a_turned_source_turns_the_field(double):
    places = np.array([0.0, 40.0, 133.0, 250.0])
    fields = []
    for turn in (0.0, 71.0):
        system = double.replace(source=cx.LineShock(distance=4.0, angle=turn, **SHOCK))
        answer = cx.simulate(system, **COARSE)
        grid = {"radius": [0.3, 0.8, 1.7], "angle": places + turn, "time": [0.7, 1.6]}
        fields.append((answer.pressure(**grid).values, answer.velocity(**grid).values))
    for one, other in zip(*fields, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-10 * abs(one).max())


def test_a_late_source_comes_late(double):
    fields = []
    for delay in (0.0, 0.4 / 1400):
        system = double.replace(source=cx.PlaneShock(delay=delay, **SHOCK))
        answer = cx.simulate(system, **COARSE)
        fields.append(answer.pressure(radius=[0.3, 0.8, 1.7], angle=[0, 60, 170], time=1.2 + delay * 1400).values)
    np.testing.assert_allclose(fields[0], fields[1], rtol=0, atol=1e-12 * abs(fields[0]).max())


def test_the_two_inversions_agree(lopsided):
    grid = band(lopsided.motion.spectra.grid, 0.01)
    times = grid.time[3] + grid.time_step * np.concatenate([np.arange(150), 0.37 + np.arange(150)])
    fast, slow = Inversion(grid, times), Inversion(grid, times[::7])
    assert fast.by_fft
    assert not slow.by_fft
    spectra = lopsided.motion.spectra.normal[1, :, :5, : grid.nodes.size] * grid.nodes
    one, other = fast(spectra * fast.weight)[..., ::7], slow(spectra * slow.weight)
    np.testing.assert_allclose(one, other, atol=1e-11 * abs(one).max())


def test_a_vacuum_and_a_rigid_core_are_silent(ring, water, shock):
    hollow = cx.System(shells=[ring(0.5), ring(1.0)], fluids=["vacuum", water, water], source=shock)
    core = cx.System(shells=[cx.RigidShell(radius=0.4), ring(1.0)], fluids=["vacuum", water, water], source=shock)
    for system in (hollow, core):
        answer = cx.simulate(system, **COARSE)
        p = answer.pressure(AXIS, AXIS, time=[0.9, 1.8]).values
        assert np.isfinite(p).all()
        radius = np.hypot(*np.meshgrid(AXIS, AXIS))
        assert np.all(p[:, radius < system.shells[0].radius] == 0.0)
        assert np.any(p[:, (radius > 0.55) & (radius < 1)] != 0.0)
        assert np.all(answer.pressure_rms("interior").values == 0.0)
    velocity = answer.velocity(radius=0.4, angle=[0.0, 90.0], time=[0.9, 1.8])
    assert abs(velocity.sel(component="radius")).max() < 1e-9 * abs(velocity).max()


def test_a_filter_acts_on_the_scattered_part_alone_and_says_so(lopsided):
    grid = {"radius": [0.4, 1.2], "angle": np.arange(0, 360, 30.0), "time": [1.0]}
    raw = lopsided.pressure(**grid)
    assert raw.attrs["filter"] == "none"
    for name in ("lanczos", "exponential"):
        smooth = lopsided.pressure(filter=name, **grid)
        assert smooth.attrs["filter"] == name
        assert 0 < abs(smooth - raw).max() < 0.2 * abs(raw).max()
        np.testing.assert_array_equal(
            lopsided.pressure(filter=name, part="incident", **grid).values, lopsided.pressure(part="incident", **grid).values
        )


def test_labels(loaded):
    p = loaded.pressure([0.0, 1.0, 2.0], [0.5], time=[0.5, 1.0])
    assert p.dims == ("time", "y", "x")
    assert p.attrs["units"] == "Pa"
    assert p.attrs["part"] == "total"
    np.testing.assert_allclose(p.x_metres, [0.0, 1.0, 2.0])
    np.testing.assert_allclose(p.time_seconds, np.array([0.5, 1.0]) / 1400)
    assert loaded.pressure([0.0], [0.5], time=0.5).dims == ("y", "x")
    assert loaded.pressure(radius=1.5, angle=[0, 90], time=[0.5]).dims == ("time", "radius", "angle")
    velocity = loaded.velocity([0.0, 1.0], [0.5], time=[0.5, 1.0])
    assert velocity.dims == ("time", "component", "y", "x")
    assert list(velocity.component.values) == ["x", "y"]
    intensity = loaded.intensity([0.0, 1.0], [0.5], time=[0.5, 1.0])
    np.testing.assert_allclose(intensity, velocity * loaded.pressure([0.0, 1.0], [0.5], time=[0.5, 1.0]), rtol=1e-12)


def test_polar_and_cartesian_velocities_are_one_vector(answer):
    polar = answer.velocity(radius=1.5, angle=60.0, time=1.4).values[:, 0, 0]
    cartesian = answer.velocity(x=0.75, y=1.5 * np.sin(np.pi / 3), time=1.4).values[:, 0, 0]
    turn = np.array([[0.5, -np.sqrt(0.75)], [np.sqrt(0.75), 0.5]])
    np.testing.assert_allclose(cartesian, turn @ polar, rtol=1e-12)


@pytest.mark.slow_except("lopsided-exterior-1.0-2.0", "loaded-interior-0.0-0.5")
@pytest.mark.parametrize(("region", "inner", "outer"), [("interior", 0.0, 0.5), ("gap", 0.5, 1.0), ("exterior", 1.0, 2.0)])
def test_the_rms_is_that_of_fine_pixels(answer, region, inner, outer):
    # Midpoints of equal areas; incident fronts limit what pixels can tell.
    times = [0.4, 1.3, 2.0]
    radii = np.sqrt(inner**2 + (outer**2 - inner**2) * (np.arange(300) + 0.5) / 300)
    pixels = np.sqrt((answer.pressure(radius=radii, angle=np.arange(0, 360, 0.5), time=times) ** 2).mean(("radius", "angle")))
    found = answer.pressure_rms(region, radius=outer if region == "exterior" else None, time=times)
    np.testing.assert_allclose(found, pixels, rtol=2e-3, atol=1e-3 * float(pixels.max()))


def test_the_rms_of_the_scattered_part_is_exact(lopsided):
    radii, weights = np.polynomial.legendre.leggauss(140)
    radii = 1.5 + 0.5 * radii
    p = lopsided.pressure(radius=radii, angle=np.arange(0, 360, 2.5), time=[0.8, 1.9], part="scattered").values
    wanted = np.sqrt((p**2).mean(axis=2) @ (weights * radii / 3.0))
    found = lopsided.pressure_rms("exterior", radius=2.0, time=[0.8, 1.9], part="scattered")
    np.testing.assert_allclose(found, wanted, rtol=1e-12)


def test_default_instants_of_the_rms(loaded):
    rms = loaded.pressure_rms("gap")
    assert rms.dims == ("time",)
    assert rms.attrs["units"] == "Pa"
    assert set(np.round(rms.time.values / 0.01, 6)) <= set(np.arange(201.0))
