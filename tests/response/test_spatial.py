"""Three-dimensional runs as a user reads them: stations, components, peaks, and what is refused by name."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import integrate

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.response.spatial import SpatialResponse

STATIONS = [0.0, 0.7, -0.7]


@pytest.fixture(scope="module")
def response() -> SpatialResponse:
    found = cx.simulate("bare", duration=2.0, time_step=2e-2, modes=12, dimensions=3, stations=STATIONS)
    assert isinstance(found, SpatialResponse)
    return found


def test_histories_have_a_dimension_of_stations(response: SpatialResponse) -> None:
    stress = response.stress("inner", angle=[0, 60, 180], station=[0.0, "70 cm"])
    assert stress.dims == ("time", "station", "angle")
    assert stress["station"].to_numpy().tolist() == [0.0, 0.7]
    alone = response.stress("inner", angle=[0, 60, 180], station=0.7)
    assert alone.dims == ("time", "angle")
    np.testing.assert_array_equal(alone, stress.isel(station=1))
    assert response.displacement("outer").dims == ("time", "station", "angle")
    assert response.displacement("outer", angle=0, station=0.0).dims == ("time",)


def test_stations_mirrored_in_the_plane_of_the_source_do_the_same(response: SpatialResponse) -> None:
    for read in (
        lambda z: response.stress("outer", angle=[0, 40, 180], station=z),
        lambda z: response.stress("outer", angle=[0, 40, 180], station=z, component="axial"),
        lambda z: response.stress("outer", angle=[0, 40, 180], station=z, component="von_mises"),
        lambda z: response.displacement("inner", angle=[10, 90], component="tangential", station=z),
    ):
        np.testing.assert_allclose(read(0.7), read(-0.7), rtol=1e-12, atol=1e-12 * float(abs(read(0.7)).max()))
    for read in (
        lambda z: response.displacement("inner", angle=[10, 90], component="axial", station=z),
        lambda z: response.stress("outer", angle=[40, 100], station=z, component="shear"),
    ):
        assert float(abs(read(0.7)).max()) > 0
        np.testing.assert_allclose(read(0.7), -read(-0.7), rtol=1e-12, atol=1e-12 * float(abs(read(0.7)).max()))
        assert not read(0.0).any()


def test_von_mises_is_made_of_the_three_components(response: SpatialResponse) -> None:
    hoop, axial, shear = (response.stress("inner", [0, 30], depth="outer", component=name) for name in ("hoop", "axial", "shear"))
    whole = response.stress("inner", [0, 30], depth="outer", component="von_mises")
    np.testing.assert_allclose(whole, np.sqrt(hoop**2 + axial**2 - hoop * axial + 3 * shear**2), rtol=1e-12)


def test_summary_tells_the_largest_of_all_stations(response: SpatialResponse) -> None:
    found = response.summary().to_dict()
    angles = np.linspace(0, 180, 721)
    for shell, name in enumerate(("inner", "outer")):
        for key, component in (("stress", "hoop"), ("von_mises_stress", "von_mises"), ("axial_stress", "axial")):
            true = float(abs(response.stress(name, angles, component=component)).max())
            assert found["largest"][shell][key]["value"] == pytest.approx(true, rel=2e-4)
            assert found["largest"][shell][key]["station"] in STATIONS
    assert [one["station"] for one in found["stations"]] == STATIONS
    assert "z [m]" in str(response.summary())


def test_velocity_is_the_derivative_of_the_displacement(response: SpatialResponse) -> None:
    moved = response.displacement("outer", angle=0, station=0.7)
    velocity = response.shell_velocity("outer", angle=0, station=0.7)
    integral = integrate.cumulative_simpson(velocity, x=moved["time_seconds"].to_numpy(), initial=0.0)
    assert float(np.linalg.norm(integral - moved) / np.linalg.norm(moved)) < 2e-3


def test_errors_are_told_with_the_axial_wavenumbers(response: SpatialResponse) -> None:
    errors = response.errors()
    assert list(errors["cause"].to_numpy()) == ["orders", "time step", "march", "axial wavenumbers", "combined"]
    finer = cx.simulate("bare", duration=2.0, time_step=1e-2, modes=40, dimensions=3, stations=[0.0])
    angles = np.linspace(0, 180, 91)
    for name in ("inner", "outer"):
        true = finer.stress(name, angles, station=0.0)[::2]
        off = float(np.linalg.norm(response.stress(name, angles, station=0.0) - true) / np.linalg.norm(true))
        told = float(errors.sel(shell=name, quantity="stress", cause="combined"))
        assert off / 3 < told < 30 * off


@pytest.mark.parametrize(
    ("read", "where"),
    [
        (lambda r: r.stress("inner", station=0.3), "station"),
        (lambda r: r.stress("inner", station="3 kg"), "station"),
        (lambda r: r.stress("inner", station=[]), "station"),
        (lambda r: r.stress("inner", component="radial"), "component"),
        (lambda r: r.displacement("inner", component="radial"), "component"),
    ],
)
def test_what_is_not_there_is_refused_by_name(response: SpatialResponse, read: object, where: str) -> None:
    with pytest.raises(InputError) as caught:
        read(response)  # type: ignore[operator]
    assert caught.value.where == where


def test_two_dimensions_have_no_stations_and_no_axial_stress() -> None:
    flat = cx.simulate("bare", duration=1.0, time_step=5e-2, modes=4)
    for read in (
        lambda: flat.stress("inner", station=0.0),
        lambda: flat.stress("inner", component="shear"),
        lambda: flat.displacement("inner", component="axial"),
        lambda: flat.history("inner", quantity="von_mises_stress"),
        lambda: flat.pressure(x=0.0, y=0.0, z=0.0, time=0.5),
    ):
        with pytest.raises(InputError, match="three dimensions"):
            read()
    for draw in (lambda: cx.plotting.figure_cuts(flat, 0.5), lambda: cx.plotting.plot_unrolled(flat, "outer", 0.5)):
        with pytest.raises(InputError, match="response: is of a run in two dimensions"):
            draw()


def test_auto_chooses_orders_and_wavenumbers() -> None:
    found = cx.simulate("bare", duration=1.0, time_step=2e-2, modes="auto", tolerance=0.05, dimensions=3)
    assert found.settings.axial_modes == found.modes
    assert 8 <= found.modes <= 200
    assert float(found.errors().sel(quantity="stress", cause="combined").max()) < 0.2


def test_voltages_above_the_limit_are_told() -> None:
    strong = cx.presets.load("active").with_overrides({"control.proportional": -2e10})
    run = cx.simulate(strong, duration=1.0, time_step=2e-2, modes=6, dimensions=3, stations=[0.3, 0.0])
    (told,) = run.warnings
    asked = float(told.partition("asks for ")[2].partition(" kV")[0])
    assert asked == pytest.approx(float(abs(run.actuator_voltage("outer", [0.0], segment=None)).max()) / 1e3, rel=1e-3)
    assert "set control.saturation = true to see what it can really do" in told


def test_saturation_beside_absorbers_is_refused() -> None:
    with pytest.raises(InputError, match=r"control\.saturation: beside absorbers .* which warns"):
        cx.simulate(cx.presets.load("hybrid").replace_path("control.saturation", True), duration=1.0, time_step=2e-2, modes=8, dimensions=3)


def test_a_line_source_is_as_in_two_dimensions_at_every_station() -> None:
    system = cx.presets.load("active").replace(source=cx.LineShock(peak_pressure=2.5e4, decay_time=1.3e-4, distance=5))
    settings = {"duration": 1.5, "time_step": 2e-2, "modes": 8}
    flat, found = cx.simulate(system, **settings), cx.simulate(system, dimensions=3, stations=[-0.3, 0.7], **settings)

    def same(read: object) -> None:
        true = read(flat, {})  # type: ignore[operator]
        for z in (-0.3, 0.7):
            np.testing.assert_allclose(read(found, {"station": z}), true, rtol=0, atol=1e-12 * float(abs(true).max()))  # type: ignore[operator]

    for shell in ("inner", "outer"):
        same(lambda r, at, shell=shell: r.displacement(shell, [0, 40], "tangential", **at))
        for depth in (None, "inner", "outer"):
            same(lambda r, at, shell=shell, depth=depth: r.stress(shell, [0, 40], depth, **at))
        same(lambda r, at, shell=shell: r.sensor_voltage(shell, [0, 40], **at))
        same(lambda r, at, shell=shell: r.actuator_voltage(shell, [0, 40], **at))
        same(lambda r, at, shell=shell: r.shell_acceleration(shell, [0, 40], **at))
