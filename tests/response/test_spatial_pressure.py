"""The pressure of three-dimensional runs on cuts: transparent walls, their acceleration, causality, symmetry, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.verification.systems import WATER, thin_shell
from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.spatial import SpatialResponse

TRANSIT = 1.0 / WATER.sound_speed
GAUSS = cx.Gaussian(peak_pressure=1e5, width=0.4 * TRANSIT)
"""Its spectrum ends at waves of order 12; its middle is at the head at t = 2.4."""
SIZE: dict[str, Any] = {"time_step": 2e-2, "modes": 12, "dimensions": 3}
FINE = 0.05
"""Time resolution that the pulse asks for."""


def solved(system: cx.System | str, duration: float = 4.0, **settings: Any) -> SpatialResponse:
    found = cx.simulate(system, duration=duration, **{**SIZE, "stations": [0.0], **settings})
    assert isinstance(found, SpatialResponse)
    return found


def ghosts(source: Any) -> cx.System:
    shells = [thin_shell(radius, 1e-3, density=1e-9, youngs_modulus=1e-3) for radius in (0.5, 1.0)]
    return cx.System(shells=shells, fluids=[WATER] * 3, source=source)


def free(x: FloatArray, y: FloatArray, z: FloatArray, time: float, distance: float) -> FloatArray:
    """Return the spherical wave of GAUSS in closed form."""
    range_ = np.sqrt((x - distance) ** 2 + y**2 + z**2)
    since = (time - (range_ - (distance - 1.0))) - 2.4
    return np.asarray(1e5 * (distance - 1.0) / range_ * np.exp(-0.5 * (since / 0.4) ** 2))


@pytest.fixture(scope="module")
def bare() -> SpatialResponse:
    return solved("bare", duration=2.0)


@pytest.fixture(scope="module")
def smooth() -> SpatialResponse:
    system = cx.presets.load("bare").replace(source=cx.SphericalWave(distance=3.0, pulse=GAUSS))
    return solved(system, stations=[0.0, 0.4])


@pytest.mark.parametrize("z0", [0.0, 0.3])
def test_walls_without_mass_and_stiffness_are_not_there(z0: float) -> None:
    response = solved(ghosts(cx.SphericalWave(distance=3.0, z=z0, pulse=GAUSS)))
    x, z = np.linspace(-1.6, 1.6, 9), np.linspace(-1.0, 1.0, 5)
    across = response.pressure(x=x, y=x, z=0.4, time=[2.0, 3.0], time_resolution=FINE)
    along = response.pressure(x=x, z=z, y=0.2, time=[2.0, 3.0], time_resolution=FINE)
    for i, time in enumerate((2.0, 3.0)):
        expected = free(*np.meshgrid(x, x, indexing="xy"), np.asarray(0.4 - z0), time, 3.0)
        assert float(abs(across[i].to_numpy() - expected).max()) < 2e-4 * 1e5
        expected = free(x[None], np.asarray(0.2), z[:, None] - z0, time, 3.0)
        assert float(abs(along[i].to_numpy() - expected).max()) < 2e-4 * 1e5


@pytest.mark.slow_for("True")
@pytest.mark.parametrize("held", [False, True])
def test_slope_at_the_wall_is_the_fluids_density_times_its_acceleration(smooth: SpatialResponse, *, held: bool) -> None:
    if held:
        absorber = cx.PointAbsorber(angle=50, z=0.3, mass=200, damping=1e5, linear_stiffness=1e9, footprint=0.1)
        smooth = solved(smooth.system.replace(absorbers=[absorber]), stations=[0.4])
    step, time = 0.01, np.array([2.0, 2.6, 3.4])
    radii = {"outside": 1.0 + step * np.arange(4), "inside": 1.0 - 1e-9 - step * np.arange(4)}
    for side, (r, fluid) in zip(radii, ((radii["outside"], 2), (radii["inside"], 1)), strict=True):
        pressure = smooth.pressure(radius=r, angle=[0, 50, 180], z=0.4, time=time, time_resolution=FINE).to_numpy()
        slope = (-11 * pressure[:, 0] + 18 * pressure[:, 1] - 9 * pressure[:, 2] + 2 * pressure[:, 3]) / (6 * step)
        slope *= 1.0 if side == "outside" else -1.0
        moved = smooth.shell_acceleration("outer", angle=[0, 50, 180], station=0.4).sel(time=time, method="nearest")
        density = smooth.system.fluids[fluid].density
        assert float(abs(slope - density * moved.to_numpy()).max()) < 2e-3 * float(abs(slope).max())


def test_parts_add_up_and_cuts_meet(bare: SpatialResponse) -> None:
    x = np.linspace(-2.0, 2.0, 9)
    parts = {
        part: bare.pressure(x=x, z=[0.0, 0.5], y=0.3, time=1.2, part=part)
        for part in ("total", "incident", "diffracted", "radiated", "scattered")
    }
    np.testing.assert_allclose(parts["diffracted"] + parts["radiated"], parts["scattered"], rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(parts["incident"] + parts["scattered"], parts["total"], rtol=1e-9, atol=1e-6)
    across = bare.pressure(x=x, y=[0.3], z=0.5, time=1.2)
    np.testing.assert_allclose(across[0], parts["total"][1], rtol=1e-9, atol=1e-5)
    assert across.dims == ("y", "x")
    assert parts["total"].dims == ("z", "x")
    assert float(across["z"]) == 0.5
    assert float(across["z_metres"]) == 0.5 * bare.system.reference_radius


def test_a_cut_of_many_points_is_interpolated(bare: SpatialResponse) -> None:
    x = np.linspace(-1.5, 1.5, 61)
    whole = bare.pressure(x=x, y=x, z=0.3, time=[0.7, 1.4])
    row = bare.pressure(x=x, y=[float(x[17])], z=0.3, time=[0.7, 1.4])
    assert float(abs(whole.isel(y=17) - row.isel(y=0)).max()) < 2e-3 * float(abs(row).max())


def test_the_field_is_its_mirror_image_in_the_sources_plane(bare: SpatialResponse) -> None:
    found = bare.pressure(x=np.linspace(-2, 2, 7), z=[-0.8, -0.1, 0.1, 0.8], y=0.0, time=[1.0, 2.0])
    np.testing.assert_allclose(found, found.isel(z=slice(None, None, -1)), rtol=1e-12, atol=1e-9)


def test_nothing_is_felt_before_it_arrives(bare: SpatialResponse) -> None:
    x = np.linspace(-3, 3, 13)
    far = bare.pressure(x=x, y=x, z=9.0, time=1.0, part="scattered")
    assert not far.any()
    np.testing.assert_array_equal(bare.pressure(x=x, y=x, z=9.0, time=1.0), bare.pressure(x=x, y=x, z=9.0, time=1.0, part="incident"))
    early = bare.pressure(x=[2.9], z=[0.0, 2.0], y=0.0, time=0.5, part="scattered", time_resolution=FINE)
    assert not early.any()


@pytest.mark.slow
def test_the_axial_period_and_the_contour_do_not_matter(smooth: SpatialResponse) -> None:
    shorter, x = solved(smooth.system, duration=3.0), np.linspace(-1.5, 1.5, 7)
    one, other = (run.pressure(x=x, z=[0.0, 1.0], y=0.2, time=2.5, time_resolution=FINE) for run in (smooth, shorter))
    np.testing.assert_allclose(one, other, rtol=0, atol=1e-4 * float(abs(one).max()))


def test_a_line_source_is_that_of_two_dimensions_at_all_z() -> None:
    system = cx.presets.load("bare").replace(source=cx.LineWave(distance=3.0, pulse=GAUSS))
    flat = cx.simulate(system, duration=3.0, time_step=2e-2, modes=12)
    x = np.linspace(-1.5, 1.5, 7)
    expected = flat.pressure(x=x, y=[0.2], time=2.5, time_resolution=FINE)[0]
    found = solved(system, duration=3.0).pressure(x=x, z=[0.0, 2.0], y=0.2, time=2.5, time_resolution=FINE)
    for row in found:
        np.testing.assert_allclose(row, expected, rtol=1e-9, atol=1e-9 * float(abs(expected).max()))


def test_an_inclined_plane_wave_runs_along_the_axis() -> None:
    system = cx.presets.load("bare").replace(source=cx.PlaneWave(inclination=10.0, pulse=GAUSS))
    response, x = solved(system, time_step=5e-2), np.linspace(-1.5, 1.5, 7)
    later = 0.5 * np.sin(np.radians(10.0))
    along = response.pressure(x=x, z=[0.0, 0.5], y=0.2, time=[2.5, 2.5 + later])
    np.testing.assert_allclose(along[1, 1], along[0, 0], rtol=1e-9, atol=1e-7 * float(abs(along).max()))
    with pytest.raises(InputError, match=r"z: .*passed by the inclined wave"):
        response.pressure(x=x, z=-0.5, time=1.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"x": [0.0], "y": [0.0, 1.0], "z": [0.0, 1.0], "time": 1.0}, "y: is a list, and so is z"),
        ({"x": [0.0], "time": 1.0}, "y: is missing"),
        ({"z": [0.0], "time": 1.0}, "x: is missing"),
        ({"radius": [0.5], "z": [0.0, 1.0], "time": 1.0}, "angle: is missing"),
        ({"x": [0.0], "y": [0.0]}, "time: is missing"),
        ({"x": [0.0], "z": [np.nan], "time": 1.0}, "z: nan is not finite"),
        ({"x": [0.0], "z": ["10 cm"], "time": 1.0}, "z: .* is not real"),
        ({"x": [0.0], "y": [0.0], "time": 3.0}, "time: 3 lies outside the run"),
    ],
)
def test_what_is_no_cut_is_refused(bare: SpatialResponse, arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        bare.pressure(**arguments)


def test_a_thinned_run_has_no_pressure(bare: SpatialResponse) -> None:
    with pytest.raises(InputError, match="needs every one of them"):
        bare.thin(2).pressure(x=[0.0], y=[0.0], time=1.0)


def test_progress_ends_at_one(bare: SpatialResponse) -> None:
    told: list[float] = []
    bare.pressure(x=[0.0, 1.5], z=[0.0], time=1.0, progress=lambda share, _: told.append(share))
    assert told == sorted(told)
    assert told[-1] == 1.0


def test_what_does_not_fit_into_memory_is_refused_beforehand(bare: SpatialResponse, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COAXSHELL_MEMORY", "0.1 MB")
    with pytest.raises(InputError, match=r"^memory: the field at \d+ radii of \d+ axial wavenumbers and 1 instants needs about .*coarser"):
        bare.pressure(x=np.linspace(-2, 2, 21), z=[0.0, 1.0], time=1.0)
