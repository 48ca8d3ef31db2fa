"""Unstable feedback is found before anything is marched."""

from __future__ import annotations

import sys

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.stability import unstable_poles, with_gains

ACTIVE = cx.presets.load("active")


def controlled(proportional: float, derivative: float, **changes: object) -> cx.System:
    return ACTIVE.replace(control=cx.PDControl(proportional=proportional, derivative=derivative, **changes))


@pytest.mark.parametrize(
    ("gains", "words"),
    [
        ((2e4, 0.0), ["control.proportional: 20000", "order"]),
        ((0.0, 150.0), ["control.derivative: 150", "order"]),
        ((-2e4, 150.0), ["control.derivative: 150", "order"]),
        ((2e4, -150.0), ["control.proportional: 20000", "order"]),
        ((2e4, 150.0), ["control.proportional and control.derivative", "20000 and 150", "order"]),
    ],
    ids=str,
)
def test_refused_before_any_march(gains: tuple[float, float], words: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    module = sys.modules["coaxshell.solver.solve"]  # the room's own name for it is the function
    monkeypatch.setattr(module, "StructureSpectra", lambda *_, **__: pytest.fail("the work was started"))
    with pytest.raises(InputError, match="makes the closed loop unstable") as raised:
        cx.simulate(controlled(*gains), duration=2, time_step=5e-3, modes=30)
    for word in (*words, "negative gains stiffen and damp"):
        assert word in str(raised.value)


@pytest.mark.parametrize("modes", [10, 150])
@pytest.mark.parametrize("gains", [(-2e4, -150.0), (0.0, -150.0), (-2e4, 0.0), (-2e5, -1500.0), (0.0, 0.0)], ids=str)
def test_the_papers_gains_are_stable(gains: tuple[float, float], modes: int) -> None:
    assert unstable_poles(dimensionless(controlled(*gains)), modes, 5.0).orders.size == 0


@pytest.mark.parametrize("factor", [0.8, 1.5])
def test_static_buckling_under_positive_gain(factor: float) -> None:
    # In vacuo k_p takes away stiffness -p_a k_p phi (per W, V eliminated); order m goes when nothing is left of it.
    wall = ACTIVE.shells[1]
    system = ACTIVE.replace(shells=[wall], fluids=["vacuum", "water-1400"], control=cx.PDControl(proportional=1.0, derivative=0.0))
    problem = dimensionless(system)
    orders = np.arange(2.0, 13.0)
    k = problem.shells[0].stiffness(Modes(orders))
    ratio = -k.vw / k.vv
    sensor = problem.shells[0].sensor_gain(Modes(orders))
    critical = (k.ww + k.vw * ratio) / (problem.shells[0].actuator_pressure * sensor.recovered(ratio))
    gain = factor * float(critical[critical > 0].min())
    expected = orders[(critical > 0) & (critical < gain)]
    found = unstable_poles(with_gains(problem, gain, 0.0), 12, 200.0)
    np.testing.assert_array_equal(found.orders, expected)
    np.testing.assert_array_equal(found.counts, 1.0)  # one real pole each


def test_only_the_controlled_shell_counts() -> None:
    assert unstable_poles(dimensionless(controlled(2e4, 0.0, shells=["inner"])), 30, 5.0).orders.size > 0
    message = "control.derivative"
    with pytest.raises(InputError, match=message):
        cx.simulate(controlled(-2e4, 300.0, shells=["outer"]), duration=2, time_step=5e-3, modes=30)


def test_an_unstable_loop_would_have_grown() -> None:
    # The poles counted are there: slightly unstable over a long duration, still called stable over a short one.
    problem = dimensionless(controlled(0.0, 150.0))
    long, short = (unstable_poles(problem, 30, duration) for duration in (50.0, 1.0))
    assert set(short.orders) <= set(long.orders)
    assert long.orders.size > 0


def test_voltages_of_the_papers_gains() -> None:
    # 4.4 kV and 8.96 kV are asked of actuators that stand 1.77 kV.
    response = cx.simulate(ACTIVE, duration=2.0, time_step=2e-3, modes=150)
    inner, outer = response.summary(segment="point").shells
    assert inner.actuator_voltage.value == pytest.approx(4.4e3, rel=0.01)
    assert outer.actuator_voltage.value == pytest.approx(8.96e3, rel=0.01)
    assert inner.actuator_limit == outer.actuator_limit == pytest.approx(1770.0)
    text = " ".join(response.warnings)
    assert "1.770 kV" in text
    assert "saturation" in text
