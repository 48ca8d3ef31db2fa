"""The largest stress anywhere in a wall: against a search of every depth, angle and instant, margins, summary, metrics, figure."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.plotting import plot_wall_stress
from coaxshell.response.depth_bounds import bounds
from coaxshell.response.wall_stress import WallStress, layer_peaks, of_wall, stress_through, wall_peak
from coaxshell.structure.shell_model import Gain
from coaxshell.studies.metrics import metrics_of, require_readable
from coaxshell.studies.reading import MetricSource

BARE = cx.presets.load("bare")
RUN = {"duration": 3.0, "time_step": 1e-2, "modes": 8}
ANGLES = np.arange(0.0, 180.01, 0.5)


@pytest.fixture(scope="module")
def steel():
    """Return a run of the paper's shells with cores of structural steel and losses in the ceramics."""
    shells = [
        shell.replace(
            layers=[
                layer.replace(material=cx.materials.get("steel"))
                if layer.role == "core"
                else layer.replace(material=layer.material.replace(loss_factor=0.1, strength="50 MPa"))
                for layer in shell.layers
            ]
        )
        for shell in BARE.shells
    ]
    return cx.simulate(BARE.replace(shells=shells), **RUN)


def everywhere(response, shell, component, angles=ANGLES, **station):
    """Return the largest magnitude in each layer over a grid of depths and angles and all instants, through histories alone."""
    found = []
    for depths in stress_through(response.motion, response.system.shell_index(shell)).depths():
        grid = np.linspace(depths[0], depths[-1], 9)
        found.append(max(float(np.abs(response.stress(shell, angles, float(z), component=component, **station)).max()) for z in grid))
    return found


@pytest.mark.slow_for("hoop", "axial")
@pytest.mark.parametrize("component", ["von_mises", "hoop", "axial"])
def test_no_place_has_more(steel, component):
    for shell in ("inner", "outer"):
        layers = steel.layer_peaks(shell, component)
        for peak, most in zip(layers, everywhere(steel, shell, component), strict=True):
            assert 0.999 * most <= peak.value <= 1.001 * most
            at = float(np.squeeze(np.abs(steel.stress(shell, peak.angle, peak.depth, component=component).sel(time=peak.time))))
            assert peak.value == pytest.approx(at, rel=1e-9)
        assert steel.peak_stress(shell, component).value == max(peak.value for peak in layers)


@pytest.mark.parametrize("absorbers", [[], [cx.Absorber(angle=40.0, mass=10, damping=1e6, linear_stiffness=1e9)]])
def test_bounds_leave_out_no_larger_stress(absorbers, monkeypatch):
    response = cx.simulate(BARE.replace(absorbers=absorbers), duration=2.0, time_step=4e-3, modes=12)
    for component in ("von_mises", "hoop"):
        quick = [response.layer_peaks(shell, component) for shell in ("inner", "outer")]
        with monkeypatch.context() as changed:
            changed.setattr(WallStress, "bounded", lambda *_: None)
            assert quick == [response.layer_peaks(shell, component) for shell in ("inner", "outer")]
        made = WallStress(response.solution, 1)
        depths = [float(z) for z in np.concatenate(made.depths())]
        for at, depth in zip(made.at(depths, component), depths, strict=True):
            most = np.abs(response.stress("outer", ANGLES, depth, component=component)).max(axis=-1)
            assert np.all(np.asarray(most) <= at._reach)
            assert np.all(np.abs(np.diff(np.asarray(most))) <= np.diff(at._way))


@pytest.mark.parametrize(("stretch", "bend"), [(1.0, 0.0), (0.0, 1.0)], ids=["stretched alone", "bent alone"])
def test_bounds_are_met_by_one_order_that_only_stretches_or_bends(stretch, bend):
    order, drive = np.arange(6) == 4, np.sin(np.linspace(0.0, 3.0, 40))
    w = bend * order[None, :, None] * drive
    v = (stretch * order[None, :, None] * drive + w) / 4.0  # the membrane strain is m V - W
    gain = Gain(np.linspace(2.0, 3.0, 6), np.linspace(-1.0, 4.0, 6))
    found = bounds(SimpleNamespace(normal=[w], tangential=[v]), 0, [{"hoop": gain}])
    stress = (gain.v[:, None] * v[0] + gain.w[:, None] * w[0])[4]
    np.testing.assert_allclose(found.reach[0], np.abs(stress), rtol=1e-8, atol=1e-12)
    np.testing.assert_allclose(found.change[0, 1:], np.abs(np.diff(stress)), rtol=1e-8, atol=1e-12)


@pytest.mark.parametrize("name", ["bare", "active"])
@pytest.mark.parametrize("strengths", [(None, None, None), ("50 MPa", None, "20 MPa"), ("1 MPa", "2 MPa", "4 MPa")])
def test_the_largest_of_a_wall_is_that_of_all_its_layers(name, strengths, monkeypatch):
    system = cx.presets.load(name)
    shells = [
        shell.replace(
            layers=[
                layer.replace(material=layer.material.replace(strength=strength))
                for layer, strength in zip(shell.layers, strengths, strict=True)
            ]
        )
        for shell in system.shells
    ]
    response = cx.simulate(system.replace(shells=shells), duration=1.2, time_step=2e-2, modes=10)
    whole = slice(0, response.time.size)
    for shell, component in ((0, "von_mises"), (1, "von_mises"), (1, "hoop")):
        found = wall_peak(response.motion, shell, component, whole)
        assert found == of_wall(layer_peaks([(None, response.motion)], shell, component, whole))
        with monkeypatch.context() as changed:  # with a voltage of the control law: rounding differs
            changed.setattr(WallStress, "bounded", lambda *_: None)
            plain = wall_peak(response.motion, shell, component, whole)
        assert (found.value, found.margin or 0.0) == pytest.approx((plain.value, plain.margin or 0.0), rel=1e-12)
        assert (found.time, found.angle, found.depth, found.weakest) == (plain.time, plain.angle, plain.depth, plain.weakest)


def test_stress_is_linear_through_a_layer_without_a_field(steel):
    # Why faces are enough: in the core, second differences over the depth vanish.
    depths = stress_through(steel.motion, 1).depths()[1]
    below, middle, above = (np.asarray(steel.stress("outer", 40.0, z)) for z in np.linspace(depths[0], depths[-1], 3))
    np.testing.assert_allclose(0.5 * (below + above), middle, rtol=0, atol=1e-6 * np.abs(above).max())


def test_margins_are_those_of_the_weakest_layer(steel):
    layers, whole = steel.layer_peaks("inner"), steel.peak_stress("inner")
    assert [peak.margin for peak in layers] == pytest.approx([s / p.value for s, p in zip((50e6, 235e6, 50e6), layers, strict=True)])
    assert whole.margin == min(peak.margin for peak in layers)
    assert layers[whole.weakest].margin == whole.margin
    told = steel.summary().shells[0].wall_stress
    assert told == whole
    assert f"strength of layer {whole.weakest} over its stress: {whole.margin:.3g}" in str(steel.summary())
    (margin,) = metrics_of(["inner.strength_margin"], steel.system)
    assert margin(MetricSource(steel)) == pytest.approx(whole.margin)
    (peak,) = metrics_of(["inner.peak_wall_stress"], steel.system)
    assert peak(MetricSource(steel)) == pytest.approx(whole.value)
    require_readable([margin, peak], 3)


def test_a_window_and_what_is_not_allowed(steel):
    early = steel.peak_stress("outer", window=(0.0, 0.6))
    assert early.time <= 0.6
    assert early.value < steel.peak_stress("outer").value
    with pytest.raises(cx.InputError, match="component"):
        steel.peak_stress("outer", "shear")
    with pytest.raises(cx.InputError, match="station"):
        steel.peak_stress("outer", station=0.0)
    with pytest.raises(cx.InputError, match="no material has a strength"):
        metrics_of(["inner.strength_margin"], BARE)[0](MetricSource(cx.simulate(BARE, duration=0.5, time_step=2e-2, modes=4)))


def test_strength_is_no_part_of_the_physics():
    core = BARE.shells[0].layers[1]
    stronger = core.replace(material=core.material.replace(strength="300 MPa"))
    shell = BARE.shells[0].replace(layers=[BARE.shells[0].layers[0], stronger, BARE.shells[0].layers[2]])
    other = BARE.replace(shells=[shell, BARE.shells[1]])
    assert other.canonical() == BARE.canonical()
    assert cx.System.from_toml_string(other.to_toml_string()) == other


@pytest.mark.parametrize("saturation", [False, True])
def test_the_actuators_voltage_is_in_it(saturation):
    control = cx.PDControl(proportional=-2e4, derivative=-150, saturation=saturation, field_limit="20 V/mm" if saturation else None)
    response = cx.simulate(BARE.replace(control=control), duration=1.5, time_step=1e-2, modes=6)
    for peak, most in zip(response.layer_peaks("outer", "hoop"), everywhere(response, "outer", "hoop"), strict=True):
        assert 0.999 * most <= peak.value <= 1.002 * most


def test_stations():
    response = cx.simulate(BARE, dimensions=3, duration=1.0, time_step=2e-2, modes=6, stations=[0.0, 0.4])
    peak = response.peak_stress("outer")
    most = max(max(everywhere(response, "outer", "von_mises", station=z)) for z in (0.0, 0.4))
    assert 0.999 * most <= peak.value <= 1.002 * most
    assert peak.station in (0.0, 0.4)
    assert response.peak_stress("outer", "shear", station=0.4).station == 0.4
    assert "stress in the wall" in str(response.summary())


def test_the_map_shows_where(steel):
    ax = plot_wall_stress(steel, "inner")
    peak = steel.peak_stress("inner")
    (star,) = [line for line in ax.lines if line.get_marker() == "*"]
    assert (star.get_xdata()[0], star.get_ydata()[0]) == pytest.approx((peak.angle, 1e3 * peak.depth))
    drawn = max(float(np.max(mesh.get_array())) for mesh in ax.collections)
    assert drawn == pytest.approx(1e-6 * peak.value, rel=0.01)
    assert "mm" in ax.get_ylabel()
    assert "degrees" in ax.get_xlabel()
