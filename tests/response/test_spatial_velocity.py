"""Particle velocity, intensity and mean squares of three-dimensional runs: momentum, walls, transparency, two dimensions, volumes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.special import erf

import coaxshell as cx
from coaxshell.apps.verification.systems import WATER, thin_shell
from coaxshell.errors import InputError
from coaxshell.response.spatial import SpatialResponse
from coaxshell.solver.axial import solve

TRANSIT = 1.0 / WATER.sound_speed
GAUSS = cx.Gaussian(peak_pressure=1e5, width=0.4 * TRANSIT)
"""Its spectrum ends at waves of order 12; its middle is at the head at t = 2.4."""
FINE, ROUGH = 0.02, 0.1
"""Time resolutions: a fine one, and one that will do where both sides of an equation have it."""
DENSITIES = [fluid.density for fluid in cx.presets.load("bare").fluids if isinstance(fluid, cx.Fluid)]
SPHERE = cx.SphericalWave(distance=3.0, angle=20.0, z=0.1, pulse=GAUSS)
POINT = cx.PointAbsorber(angle=50, z=0.3, mass=200, damping=1e5, linear_stiffness=1e9, footprint=0.1)


def solved(system: cx.System | str, duration: float = 2.5, **settings: Any) -> SpatialResponse:
    size: dict[str, Any] = {"time_step": 2e-2, "modes": 8, "dimensions": 3, "stations": [0.4]}
    found = cx.simulate(system, duration=duration, **{**size, **settings})
    assert isinstance(found, SpatialResponse)
    return found


@pytest.fixture(scope="module")
def smooth() -> SpatialResponse:
    """A source beside the middle and off the axis of angles, with a point absorber: three families of waves, both parities."""
    found = solved(cx.presets.load("bare").replace(source=SPHERE, absorbers=[POINT]))
    assert len(found.spatial.forces) == 1  # kept by the run itself, before any field asks for them
    return found


def test_velocities_obey_the_linearised_momentum_equation(smooth: SpatialResponse) -> None:
    """In each of the three fluids, by differences over half a thousandth of a radius and of a transit."""
    step, middle = 5e-4, np.array([0.3, 0.8, 1.4])
    near = step * np.arange(-1.0, 2.0)
    places: dict[str, Any] = {"radius": np.add.outer(middle, near).ravel(), "angle": 50.0 + np.degrees(near), "z": 0.25 + near}
    pressure, velocity = (
        getattr(smooth, name)(**places, time=2.1 + near, time_resolution=ROUGH).to_numpy() for name in ("pressure", "velocity")
    )
    for i, (radius, density) in enumerate(zip(middle, DENSITIES, strict=True)):
        here, fluid = pressure[1, :, 3 * i : 3 * i + 3], density * smooth.system.exterior.sound_speed
        around = (here[1, 1, 2] - here[1, 1, 0]) / radius
        slopes = np.array([here[1, 2, 1] - here[1, 0, 1], around, here[2, 1, 1] - here[0, 1, 1]])
        gained = fluid * (velocity[2] - velocity[0])[:, 1, 3 * i + 1, 1]
        np.testing.assert_allclose(gained, -slopes, rtol=0, atol=1e-5 * float(abs(slopes).max()))


def test_fluids_move_alike_on_both_sides_of_a_wall_and_slide_along_it(smooth: SpatialResponse) -> None:
    """What the walls radiate: the incident wave has more orders than the rigid scattering that stops it at the outer wall."""
    keys: dict[str, Any] = {"angle": [0.0, 50.0, 180.0, 250.0], "z": 0.4, "time": [1.6, 2.4], "time_resolution": ROUGH}
    walls = np.array([0.5, 1.0])
    within, without = (smooth.velocity(radius=walls - gap, part="radiated", **keys).to_numpy() for gap in (1e-12, 0.0))
    largest = float(abs(within).max())
    np.testing.assert_allclose(within[:, 0], without[:, 0], rtol=0, atol=1e-9 * largest)
    for component in (1, 2):
        assert float(abs(within[:, component] - without[:, component]).max()) > 0.02 * largest


def test_fluids_move_with_the_walls() -> None:
    slow = cx.Gaussian(peak_pressure=1e5, width=0.8 * TRANSIT)
    response = solved(cx.presets.load("bare").replace(source=SPHERE.model_copy(update={"pulse": slow})), time_step=4e-2, duration=5.0)
    time, angle = np.array([4.0, 4.8]), [0.0, 50.0, 180.0, 250.0]
    keys: dict[str, Any] = {"angle": angle, "z": 0.4, "time": time, "time_resolution": 4e-2, "part": "radiated"}
    found = response.velocity(radius=[0.5, 1.0], **keys).sel(component="radius")
    moved = [-response.shell_velocity(shell, angle=angle, station=0.4).sel(time=time, method="nearest").to_numpy() for shell in (0, 1)]
    np.testing.assert_allclose(found, np.stack(moved, axis=1), rtol=0, atol=1e-4 * float(np.abs(moved).max()))


def test_the_rigid_scattering_stops_the_incident_wave_at_the_wall(smooth: SpatialResponse) -> None:
    keys: dict[str, Any] = {"radius": [1.0], "angle": [0.0, 50.0, 180.0], "z": 0.4, "time": [1.8, 2.4], "time_resolution": ROUGH}
    rigid, incident = (smooth.velocity(part=part, **keys).sel(component="radius").to_numpy() for part in ("diffracted", "incident"))
    np.testing.assert_allclose(rigid, -incident, rtol=0, atol=2e-2 * float(abs(incident).max()))


def test_walls_without_mass_and_stiffness_are_not_there() -> None:
    shells = [thin_shell(radius, 1e-3, density=1e-9, youngs_modulus=1e-3) for radius in (0.5, 1.0)]
    source = cx.SphericalWave(distance=3.0, z=0.3, pulse=GAUSS)
    response, x = (
        solved(cx.System(shells=shells, fluids=[WATER] * 3, source=source), modes=12, duration=2.6),
        np.array([-1.3, -0.7, -0.3, 0.0, 0.6, 1.2]),
    )
    time, z = 2.6, np.array([-0.5, 0.4])
    places = np.stack(np.broadcast_arrays(x[None] - 3.0, 0.2, z[:, None] - 0.3))
    far = np.sqrt((places**2).sum(axis=0))
    since = time - (far - 2.0) - 2.4
    level = np.exp(-0.5 * (since / 0.4) ** 2)
    impulse = 0.4 * np.sqrt(0.5 * np.pi) * (erf(since / (0.4 * np.sqrt(2.0))) + erf(6.0 / np.sqrt(2.0)))
    expected = 1e5 / (WATER.density * WATER.sound_speed) * 2.0 / far * (level + impulse / far) * places / far
    along = response.velocity(x=x, z=z, y=0.2, time=time, time_resolution=FINE)
    assert along.dims == ("component", "z", "x")
    assert along["component"].to_numpy().tolist() == ["x", "y", "z"]
    np.testing.assert_allclose(along, expected, rtol=0, atol=2e-4 * float(abs(expected).max()))
    across = response.velocity(x=x, y=[0.2], z=-0.5, time=time, time_resolution=FINE)
    np.testing.assert_allclose(across[:, 0], along[:, 0], rtol=0, atol=1e-9 * float(abs(expected).max()))


def test_a_line_source_is_that_of_two_dimensions_at_all_z() -> None:
    system = cx.presets.load("bare").replace(source=cx.LineWave(distance=3.0, angle=30.0, pulse=GAUSS))
    flat, deep = cx.simulate(system, duration=2.0, time_step=2e-2, modes=8), solved(system, duration=2.0, modes=8)
    x, keys = np.linspace(-1.4, 1.4, 5), {"time": [1.7, 2.0], "time_resolution": FINE}
    for name in ("velocity", "intensity"):
        expected = getattr(flat, name)(x=x, y=[0.2], **keys).to_numpy()[:, :, 0]
        found = getattr(deep, name)(x=x, z=[0.0, 2.0], y=0.2, **keys).to_numpy()
        largest = float(abs(expected).max())
        assert not found[:, 2].any()
        for k in (0, 1):
            np.testing.assert_allclose(found[:, :2, k], expected, rtol=0, atol=1e-10 * largest)
        polar = getattr(flat, name)(radius=[0.4, 1.2], angle=[10, 200], **keys)
        np.testing.assert_allclose(
            getattr(deep, name)(radius=[0.4, 1.2], angle=[10, 200], z=0.7, **keys)[:, :2], polar, rtol=0, atol=1e-10 * largest
        )
    for region in ("interior", "exterior"):
        mean = deep.pressure_rms(region, z=0.7, time=[1.0, 2.0], time_resolution=FINE)
        expected = flat.pressure_rms(region, time=[1.0, 2.0], time_resolution=FINE)
        np.testing.assert_allclose(mean, expected, rtol=1e-10)
    assert float(mean["z"]) == 0.7


@pytest.mark.slow
def test_a_volume_is_what_the_cuts_through_it_are(smooth: SpatialResponse) -> None:
    radius, angle, z = np.array([0.2, 0.8, 1.3]), [0.0, 77.0, 180.0], [-0.5, 0.4]
    keys: dict[str, Any] = {"time": [1.5, 2.5], "time_resolution": ROUGH}
    volume, flow = (getattr(smooth, name)(radius=radius, angle=angle, z=z, **keys) for name in ("pressure", "velocity"))
    assert volume.dims == ("time", "z", "radius", "angle")
    assert flow.dims == ("time", "component", "z", "radius", "angle")
    assert float(volume["z_metres"][1]) == 0.4 * smooth.system.reference_radius
    largest, fastest = float(abs(volume).max()), float(abs(flow).max())
    across = smooth.velocity(radius=radius, angle=angle, z=-0.5, **keys)  # of the same axial period
    np.testing.assert_allclose(flow.isel(z=0), across, rtol=0, atol=1e-9 * fastest)
    for number, side in ((0, 1.0), (2, -1.0)):
        along = smooth.pressure(x=side * radius, z=z, y=0.0, **keys)
        np.testing.assert_allclose(volume.isel(angle=number), along, rtol=0, atol=1e-9 * largest)
    moved = smooth.velocity(x=-radius, z=z, y=0.0, **keys) * np.array([-1.0, -1.0, 1.0])[:, None, None]
    np.testing.assert_allclose(flow.isel(angle=2), moved, rtol=0, atol=1e-9 * fastest)


def test_intensity_is_pressure_times_velocity_and_the_rms_that_of_the_pressure(smooth: SpatialResponse) -> None:
    keys: dict[str, Any] = {"time": [2.1], "time_resolution": ROUGH}
    x = np.linspace(-1.3, 1.3, 4)
    product = smooth.pressure(x=x, z=[0.2], y=0.1, **keys) * smooth.velocity(x=x, z=[0.2], y=0.1, **keys)
    found = smooth.intensity(x=x, z=[0.2], y=0.1, **keys)
    np.testing.assert_allclose(found.transpose(*product.dims), product, rtol=1e-9, atol=1e-12 * float(abs(found).max()))
    assert found.attrs["units"] == "W m-2"
    nodes, weights = np.polynomial.legendre.leggauss(12)
    radii = 1.5 + 0.5 * nodes
    squares = (smooth.pressure(radius=radii, angle=np.arange(0, 360, 5), z=0.2, **keys)[0] ** 2).mean("angle").to_numpy()
    expected = np.sqrt(float(squares @ (weights * radii)) / float((weights * radii).sum()))
    np.testing.assert_allclose(smooth.pressure_rms("exterior", 2.0, z=0.2, **keys), expected, rtol=1e-4)
    assert float(smooth.pressure_rms("interior", z=0.2, **keys)[0]) > 0.0


def test_many_points_are_interpolated_in_all_components(smooth: SpatialResponse) -> None:
    x = np.linspace(-1.5, 1.5, 41)
    keys: dict[str, Any] = {"time": 2.2, "z": 0.3, "time_resolution": ROUGH}
    whole, row = smooth.velocity(x=x, y=x, **keys), smooth.velocity(x=x, y=[float(x[11])], **keys)
    np.testing.assert_allclose(whole.isel(y=11), row.isel(y=0), rtol=0, atol=2e-3 * float(abs(row).max()))


def test_an_inclined_plane_wave_carries_along_the_axis() -> None:
    system = cx.presets.load("bare").replace(source=cx.PlaneWave(inclination=10.0, pulse=GAUSS))
    response, x = solved(system, time_step=5e-2, modes=8, duration=4.0), np.array([-0.8, 0.2, 1.4])
    later = 0.5 * np.sin(np.radians(10.0))
    for name in ("velocity", "pressure"):
        along = getattr(response, name)(x=x, z=[0.0, 0.5], y=0.2, time=[2.5, 2.5 + later]).to_numpy()
        np.testing.assert_allclose(along[1][..., 1, :], along[0][..., 0, :], rtol=0, atol=1e-7 * float(abs(along).max()))
    # Everything goes with e^{-s z sin alpha}: rho c v_z = sin alpha p.
    pressure, flow = (getattr(response, name)(x=x, y=[0.2], z=0.3, time=2.4) for name in ("pressure", "velocity"))
    impedance = np.array([DENSITIES[i] for i in (1, 0, 2)]) * response.system.exterior.sound_speed
    np.testing.assert_allclose(flow.sel(component="z")[0], np.sin(np.radians(10.0)) * pressure[0] / impedance, rtol=1e-6)


@pytest.mark.parametrize(
    ("name", "arguments", "message"),
    [
        ("velocity", {"x": [0.0], "y": [0.0, 1.0], "z": [0.0, 1.0], "time": 1.0}, "y: is a list, and so is z"),
        ("velocity", {"x": [0.0], "y": [0.0], "time": 1.0, "part": "loud"}, "part: 'loud'"),
        ("intensity", {"radius": [0.0], "z": [0.0, 1.0], "time": 1.0}, "angle: is missing"),
        ("pressure_rms", {"region": "gap", "radius": 2.0}, "radius: 2.0 is not allowed"),
        ("pressure_rms", {"region": "interior", "z": "here"}, "z: .* is not real"),
    ],
)
def test_what_is_no_field_is_refused(smooth: SpatialResponse, name: str, arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        getattr(smooth, name)(**arguments)


def test_a_run_keeps_the_forces_of_its_absorbers_for_fields(smooth: SpatialResponse, monkeypatch: pytest.MonkeyPatch) -> None:
    again = SpatialResponse(replace(smooth.spatial, forces=[]))
    asked: dict[str, Any] = {"radius": [0.8], "angle": [50.0], "z": 0.4, "time": 2.0, "time_resolution": 0.2}
    expected = again.pressure(**asked)  # as of a run from a file: solved once more, then kept

    def refuse(*_: Any) -> None:
        raise AssertionError("solved again")

    monkeypatch.setattr(solve, "_linked", refuse)
    np.testing.assert_array_equal(smooth.at(0.4).pressure(**asked), expected)
    np.testing.assert_array_equal(again.pressure(**asked), expected)


@pytest.mark.parametrize("name", ["pressure", "velocity", "intensity"])
def test_an_axial_position_is_not_of_two_dimensions(name: str) -> None:
    flat = cx.simulate("bare", duration=0.2, time_step=5e-2, modes=2)
    with pytest.raises(InputError, match=r"^z: 0\.5 belongs to three dimensions; leave it out, or run with dimensions=3"):
        getattr(flat, name)(x=[0.0], y=[0.0], z=0.5, time=0.1)
