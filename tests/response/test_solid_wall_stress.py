"""The largest stress anywhere in elastic walls: against a search of every place, a static closed form, thin walls, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.plotting import plot_wall_stress
from coaxshell.response import stations
from coaxshell.response.summary_text import depth_phrase
from coaxshell.response.wall_stress import stress_through
from coaxshell.solver.axial.through import stresses_through
from coaxshell.studies.metrics import metrics_of
from coaxshell.studies.reading import MetricSource

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3, strength="235 MPa")
WATER = cx.Fluid(density=1000, sound_speed=1400)
PZT = cx.materials.PZT4_STANDARD
TRANSIT = 1.0 / 1400.0
COMPONENTS = ("von_mises", "hoop", "axial", "radial", "radial_hoop")


def smooth(width: float, centre: float, angle: float = 0.0) -> cx.PlaneWave:
    pulse = cx.Gaussian(peak_pressure=2.5e4, width=width * TRANSIT, centre=centre * TRANSIT)
    return cx.PlaneWave(pulse=pulse, angle=angle)


def ring(thickness: float, *sources: cx.PlaneWave, **theory) -> cx.System:
    wall = cx.Shell(radius=1.0, layers=[cx.Layer(STEEL, thickness)], **theory)
    return cx.System(shells=[wall], fluids=[cx.VACUUM, WATER], source=list(sources))


@pytest.fixture(scope="module")
def layered():
    """Return a run of a wall of ceramics and steel around a thick one, which nothing is symmetric for."""
    layers = [cx.Layer(PZT, 5e-3, role="sensor"), cx.Layer(STEEL, 2e-2), cx.Layer(PZT, 5e-3, role="actuator")]
    walls = [
        cx.Shell(radius=0.5, layers=[cx.Layer(STEEL, 6e-2)], theory="elastic"),
        cx.Shell(radius=1.0, layers=layers, theory="elastic"),
    ]
    sources = [smooth(0.08, 0.5), smooth(0.1, 0.7, 50.0)]
    system = cx.System(shells=walls, fluids=[cx.VACUUM, WATER, WATER], source=list(sources))
    return cx.simulate(system, duration=1.2, time_step=2e-2, modes=5)


@pytest.mark.parametrize("component", COMPONENTS)
def test_no_place_has_more(layered, component):
    angles = np.arange(-180.0, 180.0, 4.0)
    for shell in ("inner", "outer"):
        through = stress_through(layered.motion, layered.system.shell_index(shell))
        for peak, depths in zip(layered.layer_peaks(shell, component), through.depths(), strict=True):
            grid = np.linspace(depths[0], depths[-1], 5)
            most = max(float(np.abs(layered.stress(shell, angles, float(z), component=component)).max()) for z in grid)
            assert 0.999 * most <= peak.value <= 1.1 * most
            at = float(np.squeeze(np.abs(layered.stress(shell, peak.angle, peak.depth, component=component).sel(time=peak.time))))
            assert peak.value == pytest.approx(at, rel=1e-5)
        assert layered.peak_stress(shell, component).value == max(peak.value for peak in layered.layer_peaks(shell, component))


def test_no_instant_has_more_than_it_can_reach(layered):
    through, every = stress_through(layered.motion, 1), slice(0, layered.time.size)
    for component in COMPONENTS:
        for at in through.at([0.0, 0.01], component):
            reach = at.reach(every)
            assert np.all(at.on_circle(np.arange(layered.time.size)) <= reach)
            assert reach.max() < 4.0 * at.on_circle(np.arange(layered.time.size)).max()


def test_static_pressure_is_worst_at_the_inner_face():
    """Lame: 0.95 to 1.05 m, hoop stress -11.025 at the inner face for a pressure of 1 outside; a pulse of a thousand transits is static."""
    waves = [smooth(1e3, 6e3), smooth(1e3, 6e3, 180.0)]  # order 1 of both is nothing
    slow = cx.simulate(ring(0.1, *waves, theory="elastic"), duration=1.2e4, time_step=50.0, modes=1)
    (peak,) = slow.layer_peaks("shell", "hoop")
    assert peak.value == pytest.approx(11.025 * 5e4, rel=1e-5)
    assert peak.depth == pytest.approx(-0.05)
    whole = slow.peak_stress("shell")
    assert whole.value == pytest.approx(11.025 * 5e4 * np.sqrt(1.0 - 0.3 + 0.09), rel=1e-5)
    assert whole.margin == pytest.approx(235e6 / whole.value)


def test_thin_walls_are_met_as_the_thickness_goes():
    errors = []
    for thickness in (0.02, 0.01):
        peaks = [
            cx.simulate(ring(thickness, smooth(0.4, 2.4), **theory), duration=4.0, time_step=2e-2, modes=4).peak_stress("shell").value
            for theory in ({"wetted": "faces"}, {"theory": "elastic"})
        ]
        errors.append(abs(peaks[1] / peaks[0] - 1.0))
    assert errors[0] < 0.03
    assert errors[1] < 0.6 * errors[0]


def test_margins_summary_metrics_and_window(layered):
    whole, layers = layered.peak_stress("outer"), layered.layer_peaks("outer")
    assert layers[1].margin == pytest.approx(235e6 / layers[1].value)
    assert (whole.margin, whole.weakest) == (layers[1].margin, 1)
    summary = layered.summary()
    assert summary.shells[1].wall_stress == whole
    assert "stress in the wall, outer: von Mises, in layer 1 (steel), " in str(summary)
    assert f" {depth_phrase(whole.depth)}; strength" in str(summary)
    found = [metric(MetricSource(layered)) for metric in metrics_of(["outer.peak_wall_stress", "outer.strength_margin"], layered.system)]
    assert found == [pytest.approx(whole.value), pytest.approx(whole.margin)]
    early = layered.peak_stress("outer", window=(0.0, 0.4))
    assert early.time <= 0.4
    assert early.value < whole.value


def test_what_is_not_known_is_refused(layered):
    with pytest.raises(cx.InputError, match="component"):
        layered.peak_stress("inner", "shear")
    thinned = layered.thin(3)
    with pytest.raises(cx.InputError, match="needs every one of them"):
        thinned.peak_stress("inner")
    assert thinned.summary().shells[0].wall_stress is None


def test_the_map_shows_where(layered):
    ax, peak = plot_wall_stress(layered, "outer", component="radial_hoop"), layered.peak_stress("outer", "radial_hoop")
    (star,) = [line for line in ax.lines if line.get_marker() == "*"]
    assert (star.get_xdata()[0], star.get_ydata()[0]) == pytest.approx((peak.angle, 1e3 * peak.depth))
    drawn = max(float(np.max(mesh.get_array())) for mesh in ax.collections)
    assert drawn == pytest.approx(1e-3 * peak.value, rel=0.03)


# Three dimensions


@pytest.fixture(scope="module")
def space(layered):
    """Return the same walls under spheres off each other's plane."""
    pulse = cx.Gaussian(peak_pressure=2.5e4, width=0.1 * TRANSIT, centre=0.6 * TRANSIT)
    sources = [cx.SphericalWave(distance=3.0, pulse=pulse), cx.SphericalWave(distance=2.0, angle=50.0, z=0.6, pulse=pulse)]
    system = layered.system.replace(source=sources)
    return cx.simulate(system, duration=1.2, time_step=3e-2, modes=4, dimensions=3, stations=[0.0, 0.5])


def test_no_place_along_the_axis_has_more(space):
    angles, components = np.arange(-180.0, 180.0, 4.0), ("von_mises", "axial", "radial_axial")
    peaks = {name: space.layer_peaks("outer", name) for name in components}
    for number, points in enumerate(stress_through(space.motion, 1).depths()):
        most = dict.fromkeys(components, 0.0)
        for z in np.linspace(points[0], points[-1], 3):
            for name in components:  # of a depth at a time: it is one pass
                most[name] = max(most[name], float(np.abs(space.stress("outer", angles, float(z), component=name)).max()))
        for name, peak in ((name, peaks[name][number]) for name in components):
            assert 0.999 * most[name] <= peak.value <= 1.1 * most[name]
            if number == 1:
                at = space.stress("outer", peak.angle, peak.depth, component=name, station=peak.station).sel(time=peak.time)
                assert peak.value == pytest.approx(float(np.squeeze(np.abs(at))), rel=4e-4)
    for name in components:
        whole = space.peak_stress("outer", name)
        assert whole.value == max(peak.value for peak in peaks[name])
        alone = [space.peak_stress("outer", name, station=z) for z in (0.0, 0.5)]
        assert whole == max(alone, key=lambda one: one.value)
        assert [one.station for one in alone] == [0.0, 0.5]


def test_little_room_makes_more_passes_and_the_same_peaks(space, monkeypatch):
    """A layer and a station at a time, those kept forgotten."""
    expected, passes = space.layer_peaks("outer"), []
    monkeypatch.setattr(stations, "BYTES", 1)
    monkeypatch.setattr(stations, "stresses_through", lambda *given: passes.append(given) or stresses_through(*given))
    again = space.at([0.0, 0.5]).without_transforms()
    for found, peak in zip(again.layer_peaks("outer"), expected, strict=True):
        assert (found.value, found.angle, found.depth) == pytest.approx((peak.value, peak.angle, peak.depth), rel=1e-9)
    assert len(passes) == 6


def test_studies_and_maps_know_them_along_the_axis(space):
    whole, source = space.peak_stress("outer"), MetricSource(space)
    found = [metric(source) for metric in metrics_of(["outer.peak_wall_stress", "outer.strength_margin"], space.system)]
    assert found == [pytest.approx(whole.value), pytest.approx(whole.margin)]
    ax = plot_wall_stress(space, "outer", station=0.5)
    drawn = max(float(np.max(mesh.get_array())) for mesh in ax.collections)
    assert drawn == pytest.approx(1e-6 * space.peak_stress("outer", station=0.5).value, rel=0.03)
    thinned = space.thin(3)
    with pytest.raises(cx.InputError, match="needs every one of them"):
        thinned.peak_stress("inner")
    assert space.summary().each[0].shells[1].wall_stress is None  # which would take as long as the run
