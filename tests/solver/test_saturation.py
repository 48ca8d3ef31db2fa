"""Limited voltages: the circle of points against the modes, clipping against a quadrature of its own, the limit by hand."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.interface import march as marching
from coaxshell.solver.interface.absorbers import absorber_set
from coaxshell.solver.interface.clipping import SHARE, settle
from coaxshell.solver.interface.saturation import CircleSums, LimitedVoltages, circle, voltage_limit
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

MODES = 7


def amplitudes(parities: int) -> np.ndarray:
    """Return amplitudes (parities, MODES) whose sum passes 1 here and there; order 0 has no sine."""
    values = np.random.default_rng(3).normal(size=(parities, MODES))
    values[1:, 0] = 0.0
    return values


@pytest.mark.parametrize("parities", [1, 2])
def test_to_the_circle_and_back(parities: int) -> None:
    evaluate, project = circle(MODES, parities)
    given = amplitudes(parities).ravel()
    np.testing.assert_allclose(project @ (evaluate @ given), given, rtol=0, atol=1e-14)


@pytest.mark.parametrize("parities", [1, 2])
def test_sums_by_symmetries_are_the_same(parities: int) -> None:
    (evaluate, project), fast = circle(MODES, parities), CircleSums(MODES, parities)
    given = np.stack([amplitudes(parities), -2.0 * amplitudes(parities)])
    values = given.reshape(2, -1) @ evaluate.T
    np.testing.assert_allclose(fast.at_points(given), values, rtol=0, atol=1e-13)
    cut = np.clip(values, -1.0, 1.0)
    np.testing.assert_allclose(fast.amplitudes(cut.copy()).reshape(2, -1), cut @ project.T, rtol=0, atol=1e-14)


@pytest.mark.parametrize("parities", [1, 2])
def test_points_that_cannot_be_held_are_left_out(parities: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """u = known + Z clip(u) in the end, by fewer looks at all points than iterations."""
    circle_sums, own = CircleSums(12, parities), -np.linspace(0.5, 6.0, 12)
    known = np.random.default_rng(5).normal(size=(2, parities, 12)) * 0.6
    known[:, 1:, 0] = 0.0
    looks, whole = [], circle_sums.at_points
    monkeypatch.setattr(circle_sums, "at_points", lambda volts: looks.append(1) or whole(volts))
    found = settle(circle_sums, lambda rest: (known + own * rest) / (1.0 - SHARE * own), np.zeros_like(known))
    volts = whole(found.asked)
    assert 0 < np.count_nonzero(np.abs(volts) > 1.0) < 0.3 * volts.size
    np.testing.assert_allclose(found.given, circle_sums.amplitudes(np.clip(volts, -1.0, 1.0)), rtol=0, atol=1e-12)
    np.testing.assert_allclose(found.asked, known + own * found.given, rtol=0, atol=1e-9)
    assert len(looks) < 0.7 * found.iterations


@pytest.mark.parametrize(("angle", "limit", "gains"), [(0.0, 1e5, 1.0), (30.0, 1e4, 1.0), (0.0, 1e5, 300.0)])
def test_actuators_alone_are_marched_as_with_newton_s_method(
    angle: float, limit: float, gains: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By a fixed point, or, where feedback is too strong within a step, by Newton's method itself."""
    control = cx.PDControl(proportional=-2e4 * gains, derivative=-150 * gains, saturation=True, field_limit=limit)
    shock = cx.SphericalShock(distance=5.0, peak_pressure=2.5e5, decay_time=1.314e-4, angle=angle)
    problem = dimensionless(cx.presets.load("active").replace(control=control, source=shock))
    structure = StructureSpectra(problem, LaplaceGrid(1e-2, 130), Modes.up_to(12))
    none = absorber_set(problem, (), 1 if angle == 0.0 else 2)
    found = marching.march(structure, none, saturate=True)
    done = []
    monkeypatch.setattr(marching, "march_actuators", lambda *_: done.append(True))
    expected = marching.march(structure, none, saturate=True)
    assert done
    assert found.saturated
    assert (found.iterations != expected.iterations) == (gains == 1.0)
    np.testing.assert_allclose(found.modal_pressure, expected.modal_pressure, rtol=0, atol=1e-8 * abs(expected.modal_pressure).max())


@pytest.mark.parametrize(("angle", "limit"), [(0.0, 2e5), (30.0, 2e5), (0.0, 1e3)])
def test_actuators_beside_absorbers_are_marched_as_with_newton_s_method(
    angle: float, limit: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By the points held and the springs, or, where most points are held, by Newton's method of all unknowns itself."""
    control = cx.PDControl(proportional=-2e4, derivative=-150, saturation=True, field_limit=limit)
    shock = cx.SphericalShock(distance=5.0, peak_pressure=2.5e4, decay_time=1.314e-4, angle=angle)
    system = cx.presets.load("hybrid").replace(control=control, source=shock).with_overrides({"absorbers.count": 5})
    problem = dimensionless(system)
    structure = StructureSpectra(problem, LaplaceGrid(1e-2, 110), Modes.up_to(12))
    links = absorber_set(problem, system.absorber_list, 1 if angle == 0.0 else 2)
    found = marching.march(structure, links, saturate=True)
    done = []
    monkeypatch.setattr(marching, "march_beside", lambda *_: done.append(True))
    expected = marching.march(structure, links, saturate=True)
    assert done
    assert found.saturated
    assert (found.iterations < 0.5 * expected.iterations) == (limit == 2e5)
    for name in ("force", "mass_displacement", "modal_pressure", "actuation"):
        other = getattr(expected, name)
        np.testing.assert_allclose(getattr(found, name), other, rtol=0, atol=1e-8 * np.abs(other).max())


@pytest.mark.parametrize("parities", [1, 2])
def test_what_limited_voltages_give(parities: int) -> None:
    given = amplitudes(parities)
    theta = np.linspace(0.0, 2.0 * np.pi, 20_001)
    shapes = np.stack([np.cos, np.sin][:parities], dtype=object)
    basis = np.array([[shape(m * theta) for m in range(MODES)] for shape in shapes])
    volts = np.einsum("hm,hmt->t", given, basis)
    assert volts.max() > 1.5
    assert volts.min() < -1.5
    cut = np.where(volts > 1.0, 1.0, np.where(volts < -1.0, -1.0, volts))
    expected = np.trapezoid(cut * basis, theta, axis=-1) / np.pi
    expected[:, 0] /= 2.0
    law = LimitedVoltages(1, parities, MODES)
    found = law.nonlinear_part(given.ravel()).reshape(parities, MODES)
    assert law.saturates(np.stack([np.zeros(given.size), given.ravel()]))
    # Corners of the clipped voltage lie between the points of the circle: second order in their distance, 2 degrees or less.
    np.testing.assert_allclose(found, expected, rtol=0, atol=6e-4 * np.abs(expected).max())


def test_voltages_within_the_limit_are_given() -> None:
    law, volts = LimitedVoltages(1, 1, MODES), np.full(MODES, 0.99 / MODES)
    np.testing.assert_array_equal(law.nonlinear_part(volts), volts)
    assert not law.saturates(volts)


def test_the_limit_is_field_times_thickness() -> None:
    hybrid = cx.presets.load("hybrid")
    thickness = hybrid.shells[0].layers[-1].thickness
    np.testing.assert_allclose(voltage_limit(dimensionless(hybrid), 0), 590e3 * thickness, rtol=1e-14)  # Table 1: 590 V/mm
    lowered = hybrid.replace(control=hybrid.control.replace(field_limit=1e5))
    np.testing.assert_allclose(voltage_limit(dimensionless(lowered), 1), 1e5 * thickness, rtol=1e-14)
