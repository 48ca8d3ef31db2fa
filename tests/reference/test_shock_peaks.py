"""Plane exponential shock on one and two steel shells: four digits of displacement and stress."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import coaxshell as cx

MODES = 300  # the membrane wave keeps 1e-4 of the stress peaks in the orders from 150 on
THICKNESS = 1e-2


@pytest.fixture(scope="module")
def single() -> cx.Response:
    return cx.simulate(cx.presets.load("iakovlev-evacuated"), duration=2.5, time_step=1e-3, modes=MODES)


@pytest.fixture(scope="module")
def double() -> cx.Response:
    return cx.simulate(cx.presets.load("iakovlev-double"), duration=2.5, time_step=1e-3, modes=MODES)


def least(response: cx.Response, shell: str, angle: float) -> tuple[float, float]:
    """Return time and value (MPa) of the least stress."""
    stress = np.asarray(response.stress(shell, [angle]))[:, 0] / 1e6
    return float(response.time[stress.argmin()]), float(stress.min())


def test_single_shell_displacement(single: cx.Response, tables: dict[str, Any]) -> None:
    table = tables["evacuated-shock"]
    head = np.asarray(single.displacement("outer", [0]))[:, 0] / THICKNESS
    np.testing.assert_allclose(head[1000], table["w_head_at_1"], rtol=1e-4)
    np.testing.assert_allclose([single.time[head.argmax()], head.max()], table["w_head_peak"], rtol=1.2e-3)
    np.testing.assert_allclose(head.max(), table["w_head_peak"][1], rtol=1e-4)


@pytest.mark.parametrize(("angle", "key"), [(0.0, "stress_head"), (180.0, "stress_tail")])
def test_single_shell_stress(single: cx.Response, tables: dict[str, Any], angle: float, key: str) -> None:
    time, value = least(single, "outer", angle)
    np.testing.assert_allclose(value, tables["evacuated-shock"][key][1], rtol=2.5e-4)
    np.testing.assert_allclose(time, tables["evacuated-shock"][key][0], rtol=0, atol=1.5e-3)


def test_single_shell_comes_to_rest_where_the_impulse_leaves_it(tables: dict[str, Any]) -> None:
    # Translation alone survives: 2/(1 + 2 rho_s h/(rho R)) times the impulse over rho c; order 0 and 2 still decay slowly.
    system = cx.presets.load("iakovlev-evacuated")
    response = cx.simulate(system, duration=60, time_step=1e-2, modes=8)
    head, tail = np.asarray(response.displacement("outer", [0, 180]))[-1] / THICKNESS
    np.testing.assert_allclose((head - tail) / 2, tables["evacuated-shock"]["w_final"], rtol=1e-4)
    np.testing.assert_allclose((head + tail) / 2, 0.0, rtol=0, atol=0.005 * head)


@pytest.mark.parametrize("key", ["outer_head", "outer_tail", "inner_head", "inner_tail"])
def test_double_shell_minima(double: cx.Response, tables: dict[str, Any], key: str) -> None:
    shell, side = key.split("_")
    time, value = least(double, shell, 0.0 if side == "head" else 180.0)
    np.testing.assert_allclose(value, tables["double-shock"][key][1], rtol=3.5e-4)
    np.testing.assert_allclose(time, tables["double-shock"][key][0], rtol=0, atol=1.5e-3)
