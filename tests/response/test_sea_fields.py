"""The field near surface and bottom: no pressure on the one, no flow through the other, nothing beyond, in two and three dimensions."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model.sea import ATMOSPHERE, GRAVITY, VAPOUR_PRESSURE

BARE = cx.presets.load("bare")
SMOOTH = cx.Gaussian(peak_pressure=2.5e4, width=8e-5)
TIMES = [1.2, 2.0, 2.5]
JUST_BELOW = 1 - 1e-13
ASIDE = np.linspace(-2.0, 2.0, 5)


@pytest.fixture(scope="module")
def run() -> cx.Response:
    source = cx.LineWave(distance=2.2, angle=20.0, pulse=SMOOTH)
    return cx.simulate(BARE.replace(source=source, sea=cx.Sea(depth=1.8, bottom=1.5)), duration=2.6, time_step=1e-2, modes=12)


def test_nothing_presses_on_the_surface(run: cx.Response) -> None:
    whole = run.pressure(x=ASIDE, y=[1.8 * JUST_BELOW, 0.0], time=TIMES)
    assert np.abs(whole[:, 0]).max() < 2e-5 * np.abs(whole).max()  # lines' wakes are interpolated from tables
    parts = [run.pressure(x=ASIDE, y=[1.8 * JUST_BELOW], time=TIMES, part=part).values for part in ("diffracted", "radiated")]
    assert all(np.abs(part).max() < 1e-9 * np.abs(whole).max() for part in parts)


def test_nothing_flows_through_the_bottom(run: cx.Response) -> None:
    flow = run.velocity(x=ASIDE, y=[-1.5 * JUST_BELOW], time=TIMES).values
    assert np.abs(flow[:, 1]).max() < 1e-9 * np.abs(flow[:, 0]).max()
    circle = run.velocity(radius=[np.hypot(1.5, 1.0) * JUST_BELOW], angle=[-np.degrees(np.arctan2(1.5, 1.0))], time=TIMES).values[
        :, :, 0, 0
    ]
    down = np.array([-1.5, 1.0]) / np.hypot(1.5, 1.0)  # y in its radial and angular components
    assert np.abs(circle @ down).max() < 1e-9 * np.abs(circle).max()


def test_nothing_is_beyond(run: cx.Response) -> None:
    outside = run.pressure(x=ASIDE, y=[1.81, -1.51, 4.0], time=TIMES)
    assert np.abs(outside).max() == 0.0
    grid = run.pressure(x=np.linspace(-2, 2, 40), y=np.linspace(-1.4, 1.7, 30), time=TIMES[:2], time_resolution=0.03)
    few = run.pressure(x=grid.x[::13], y=grid.y[::9], time=TIMES[:2], time_resolution=0.03)
    np.testing.assert_allclose(grid[:, ::9, ::13], few, rtol=0, atol=2e-4 * float(np.abs(few).max()))


def test_the_mean_over_the_water_around_is_that_of_points(run: cx.Response) -> None:
    radii, angles = np.linspace(1.0, 1.5, 41), np.arange(0.0, 360.0, 5.0)
    square = (run.pressure(radius=radii, angle=angles, time=TIMES) ** 2).mean("angle")
    mean = np.sqrt((square * radii).integrate("radius") / np.trapezoid(radii, radii))
    found = run.pressure_rms("exterior", time=TIMES, time_resolution=1e-2)
    assert found.attrs["outer_radius"] == 1.5
    np.testing.assert_allclose(found, mean, rtol=2e-3)
    with pytest.raises(InputError, match="beyond the surface or the bottom"):
        run.pressure_rms("exterior", 2.0)


def test_three_dimensions() -> None:
    """Sources are reflected, and the scattered wave is where it can be seen; what comes back to the shells is not, and is told."""
    source = cx.SphericalWave(distance=2.5, pulse=SMOOTH)
    run = cx.simulate(BARE.replace(source=source, sea=cx.Sea(depth=1.7)), duration=1.4, time_step=2e-2, modes=6, dimensions=3)
    across = run.pressure(x=ASIDE, y=[1.7 * JUST_BELOW, 0.0, 1.8], z=0.3, time=[1.0, 1.3])
    assert np.abs(across[:, 0]).max() < 1e-9 * np.abs(across).max()
    assert np.abs(across[:, 2]).max() == 0.0
    along = run.velocity(x=ASIDE, y=1.7 * JUST_BELOW, z=[0.0, 0.3], time=1.3)
    assert np.abs(along.sel(component=["x", "z"])).max() < 1e-9 * np.abs(along.sel(component="y")).max()
    place = {"radius": [1.6], "angle": [90.0], "time": 1.3}
    np.testing.assert_allclose(run.pressure(z=[0.0, 0.3], **place)[1], run.pressure(z=0.3, **place), rtol=1e-3)
    with pytest.raises(InputError, match="when what the shells scatter is back"):
        run.pressure_rms("exterior", 1.5, time=1.3)


def test_water_at_a_depth_cavitates_where_its_absolute_pressure_is_that_of_vapour() -> None:
    """A smooth wave from below meets the surface: tension below it, sooner and over more of the water the nearer it is."""
    source = cx.PlaneWave(angle=270.0, pulse=cx.Gaussian(peak_pressure="1.5 MPa", width="0.15 ms"))
    system = BARE.replace(source=source, sea=cx.Sea(depth=3.0))
    run = cx.simulate(system, duration=6.0, time_step=2e-2, modes=12)
    x, y = np.linspace(-2.0, 2.0, 9), np.linspace(-2.0, 2.9, 15)
    times = run.time[::4]
    found = run.cavitation(x, y, time=times)
    rest = ATMOSPHERE + 1000.0 * GRAVITY * (3.0 - y[None, :, None])
    absolute = run.pressure(x=x, y=y, time=times) + rest
    outside = np.hypot(x, y[:, None]) >= 1.0
    np.testing.assert_allclose(found.lowest_pressure.values[outside], absolute.min("time").values[outside], rtol=1e-9)
    below = absolute.values < VAPOUR_PRESSURE
    when = np.where(below.any(axis=0), np.asarray(times)[below.argmax(axis=0)] * BARE.transit_time, np.nan)
    np.testing.assert_allclose(found["first"].values[outside], when[outside])
    assert np.isnan(found["first"].values[~outside]).all()
    assert found.attrs["first_time"] == pytest.approx(np.nanmin(when[outside]))
    assert found.attrs["area"] > 1.0
    (text,) = [text for text in run.warnings if "of vapour" in text]
    for words in ("outer shell: the absolute pressure of the fluid outside", "2.339 kPa", "first at t = ", "response.cavitation()"):
        assert words in text
    deep = cx.simulate(system.replace(sea=cx.Sea(depth=900.0)), duration=6.0, time_step=2e-2, modes=12)
    assert not [text for text in deep.warnings if "of vapour" in text]
    nothing = deep.cavitation(radius=[1.5], angle=[0.0, 90.0])
    assert (nothing.attrs["first_time"], nothing.attrs["first_place"]) == ("never", "nowhere")


def test_three_dimensions_map_cavitation_in_a_cross_section() -> None:
    """A wave that is alike along the axis is that of two dimensions, until what the shells scatter is back from the surface."""
    source = cx.PlaneWave(angle=270.0, pulse=cx.Gaussian(peak_pressure="1.5 MPa", width="0.2 ms"))
    system = BARE.replace(source=source, sea=cx.Sea(depth=3.0))
    settings = {"duration": 6.0, "time_step": 4e-2, "modes": 6}
    place = {"x": [-1.8, 0.0, 1.2], "y": [-1.5, 1.5, 2.4, 2.8], "time": np.arange(0.4, 6.0, 0.2)}
    plane = cx.simulate(system, **settings).cavitation(**place)
    space = cx.simulate(system, **settings, dimensions=3, stations=[0.0]).cavitation(**place, z=0.3)
    np.testing.assert_allclose(space.lowest_pressure, plane.lowest_pressure, rtol=0, atol=0.02 * 1.5e6)
    assert np.isfinite(plane["first"]).any()
    np.testing.assert_array_equal(np.isfinite(space["first"]), np.isfinite(plane["first"]))
    assert float(space.z) == 0.3


def test_cavitation_needs_a_depth() -> None:
    run = cx.simulate(BARE, duration=0.5, time_step=2e-2, modes=4)
    with pytest.raises(InputError, match="the pressure at rest is unknown"):
        run.cavitation()


def test_pictures_show_surface_bottom_and_cavitation() -> None:
    from coaxshell.plotting.frames import FieldView
    from coaxshell.plotting.sea import cavitating, draw_cavitation, draw_planes, rim
    from coaxshell.plotting.style import new_figure

    view, system = FieldView(pixels=60), BARE.replace(sea=cx.Sea(depth=2.0, bottom=1.5))
    pressure = np.zeros((60, 60), np.float32)
    pressure[40:50, 5:20] = -3e5
    pressure[30, :] = -3e5  # thin as the rise of a front
    left = cavitating(system, pressure, view)
    torn = left < 0.0
    assert torn.sum() == 10 * 15
    assert torn[40:50, 5:20].all()
    assert rim(left).sum() < torn.sum()
    assert cavitating(BARE, pressure, view) is None
    ax = new_figure(3.0, 3.0).add_subplot()
    draw_planes(ax, system, view)
    draw_cavitation(ax, system, pressure, view)
    assert len(ax.patches) == 2
    assert len(ax.collections) == 1
