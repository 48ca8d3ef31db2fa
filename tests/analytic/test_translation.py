"""A shell that moves as a body has no strain, no stress and no sensor voltage."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx


@pytest.fixture(scope="module")
def translated() -> cx.Response:
    """Return the bare double shell's response with everything but a common V_1 = W_1 taken out."""
    solution = cx.simulate(cx.presets.load("bare"), duration=1.5, time_step=1e-2, modes=4).solution
    w = np.zeros_like(solution.normal)
    w[:, :, 1] = np.linspace(0, 1e-6, w.shape[-1])
    return cx.Response(replace(solution, normal=w, tangential=w.copy()))


@pytest.mark.parametrize("shell", ["inner", "outer"])
def test_no_strain(translated: cx.Response, shell: str) -> None:
    angles = [0, 30, 90, 180]
    assert abs(np.asarray(translated.displacement(shell, angles))).max() > 4e-7
    breathing = 70e9 / (1 - 0.33**2) * 1e-6  # Pa, the stress of as large a breathing
    for depth in (None, "inner", "outer"):
        assert abs(np.asarray(translated.stress(shell, angles, depth=depth))).max() < 1e-12 * breathing
    assert abs(np.asarray(translated.sensor_voltage(shell, angles))).max() < 1e-12


def test_every_point_moves_alike(translated: cx.Response) -> None:
    # w inward and v along theta of one vector: (-w cos - v sin, -w sin + v cos) is the same at every angle.
    theta = np.radians([0, 40, 100, 180])
    w = np.asarray(translated.displacement("outer", np.degrees(theta)))
    v = np.asarray(translated.displacement("outer", np.degrees(theta), component="tangential"))
    x = -w * np.cos(theta) - v * np.sin(theta)
    y = -w * np.sin(theta) + v * np.cos(theta)
    np.testing.assert_allclose(x, np.broadcast_to(x[:, :1], x.shape), rtol=1e-12)
    np.testing.assert_allclose(y, 0.0, rtol=0, atol=1e-18)
