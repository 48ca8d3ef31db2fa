"""Sensor and actuator voltages."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from coaxshell.errors import InputError
from coaxshell.model import PDControl
from coaxshell.numerics.differences import time_derivative
from coaxshell.response import Response
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.section import Section
from coaxshell.structure.thin import potential_gain


def test_sensor_voltage_is_eq_20(response: Response, lopsided_section: Section) -> None:
    m = np.arange(response.modes + 1.0)
    of_v, of_w, _ = potential_gain(lopsided_section.layer("sensor"), m, 0.5)
    modal = 1.25 * (of_v[:, None] * response.solution.tangential[0] + of_w[:, None] * response.solution.normal[0])
    phase = np.radians(33 * m)
    expected = np.cos(phase) @ modal[0] + np.sin(phase) @ modal[1]
    found = response.sensor_voltage("inner", 33)
    assert found.attrs["units"] == "V"
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * abs(expected).max())


@pytest.mark.parametrize("degree", range(5))
def test_derivative_is_exact_for_quartics(degree: int) -> None:
    t = 0.1 * np.arange(9)
    np.testing.assert_allclose(time_derivative(np.array([t**degree]), 0.1)[0], degree * t ** max(degree - 1, 0), rtol=0, atol=1e-12)


@pytest.mark.parametrize("steps", [4, 7])
def test_derivative_needs_only_five_instants(steps: int) -> None:
    t = np.arange(steps + 1.0)
    np.testing.assert_allclose(time_derivative(t**3, 1.0), 3 * t**2, rtol=0, atol=1e-11)


def test_derivative_converges_at_fourth_order() -> None:
    def error(n: int) -> float:
        t = np.linspace(0, 1, n + 1)
        return float(abs(time_derivative(np.sin(5 * t), 1 / n) - 5 * np.cos(5 * t)).max())

    assert np.log2(error(80) / error(160)) == pytest.approx(4.0, abs=0.03)


def test_actuator_voltage_is_the_law_on_the_sensor(response: Response) -> None:
    sensor = response.sensor_voltage("outer", [0, 50])
    rate = time_derivative(sensor.values.T, response.settings.time_step).T
    found = response.actuator_voltage("outer", [0, 50])
    np.testing.assert_allclose(found, -2e4 * sensor - 150 * rate, rtol=0, atol=1e-12 * float(abs(found).max()))
    assert found.attrs["limit"] == pytest.approx(590e3 * 4e-3)


def test_rates_of_the_engine_are_used_when_there_are_any(make: Callable[..., ModalSolution]) -> None:
    exact, differenced = (Response(make(rates=rates)).actuator_voltage(0, [10, 100]) for rates in (True, False))
    # The hand-made amplitudes are sines, so differences of fourth order come close but not equal.
    assert 1e-9 < float(abs(exact - differenced).max() / abs(exact).max()) < 1e-6


def test_saturation_cuts_at_the_limit(make: Callable[..., ModalSolution], response: Response) -> None:
    system = response.system
    limit = 0.5 * float(abs(response.actuator_voltage(0, 0)).max())
    law = {"proportional": -2e4, "derivative": -150, "field_limit": limit / 4e-3}
    cut = Response(make(system.replace(control=PDControl(saturation=True, **law)))).actuator_voltage(0, 0)
    asked = Response(make(system.replace(control=PDControl(**law)))).actuator_voltage(0, 0)
    np.testing.assert_allclose(cut, np.clip(asked, -limit, limit), rtol=1e-12)
    assert float(abs(asked).max()) > limit * 1.9


def test_bad_input(make: Callable[..., ModalSolution], response: Response, rigid_core: Response) -> None:
    free = Response(make(response.system.replace(control=None)))
    with pytest.raises(InputError, match="control: the inner shell is not controlled"):
        free.actuator_voltage(0)
    for call, role in ((rigid_core.sensor_voltage, "sensor"), (rigid_core.actuator_voltage, "actuator")):
        with pytest.raises(InputError, match=rf"shells\[1\].layers: there is no {role}"):
            call("outer")
