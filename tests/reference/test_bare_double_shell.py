"""The paper's bare double shell against spectral elements in r and implicit Gauss integration in time: no Bessel function there."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.verification.bench import bare_double_shell


@pytest.fixture(scope="module")
def reference() -> dict[str, np.ndarray]:
    return bare_double_shell()


@pytest.fixture(scope="module")
def response() -> cx.Response:
    """Return our answer, without piezoelectric stiffening (mass and stiffness of the layers kept)."""
    inert = cx.materials.PZT4.replace(e32=0.0, e33=0.0)
    bare = cx.presets.load("bare")
    shells = [
        shell.replace(layers=[layer.replace(material=inert) if layer.role != "core" else layer for layer in shell.layers])
        for shell in bare.shells
    ]
    return cx.simulate(bare.replace(shells=shells), duration=5.0, time_step=1e-3, modes=150)


@pytest.fixture(scope="module")
def at(reference: dict[str, np.ndarray]) -> np.ndarray:
    return np.round(reference["time"] / 1e-3).astype(int)


def error(found: np.ndarray, expected: np.ndarray) -> float:
    return float(np.linalg.norm(found - expected) / np.linalg.norm(expected))


@pytest.mark.parametrize("side", ["head", "tail"])
@pytest.mark.parametrize("shell", ["inner", "outer"])
def test_displacement(response: cx.Response, reference: dict[str, np.ndarray], at: np.ndarray, shell: str, side: str) -> None:
    found = np.asarray(response.displacement(shell, [0.0 if side == "head" else 180.0]))[at, 0]
    assert error(found, reference[f"displacement_{shell}_{side}"]) < 4e-7


@pytest.mark.parametrize("side", ["head", "tail"])
@pytest.mark.parametrize("shell", ["inner", "outer"])
def test_stress(response: cx.Response, reference: dict[str, np.ndarray], at: np.ndarray, shell: str, side: str) -> None:
    found = np.asarray(response.stress(shell, [0.0 if side == "head" else 180.0]))[at, 0]
    assert error(found, reference[f"stress_{shell}_{side}"]) < 1e-6


@pytest.mark.parametrize("m", [0, 1, 2, 5, 20, 80])
@pytest.mark.parametrize("shell", [0, 1])
@pytest.mark.parametrize("component", ["W", "V"])
def test_modal_amplitudes(
    response: cx.Response, reference: dict[str, np.ndarray], at: np.ndarray, component: str, shell: int, m: int
) -> None:
    name = f"{component}_{('inner', 'outer')[shell]}_{m}"
    histories = response.solution.normal if component == "W" else response.solution.tangential
    found, expected = histories[shell, 0, m, at], reference[name]
    # High orders are small: they are held to 2e-9 of the whole displacement, the others to 5e-7 of themselves.
    whole = np.linalg.norm(reference[f"displacement_{('inner', 'outer')[shell]}_head"])
    assert np.linalg.norm(found - expected) < 5e-7 * np.linalg.norm(expected) + 2e-9 * whole


def test_the_stiffening_left_out_would_show(reference: dict[str, np.ndarray], at: np.ndarray) -> None:
    paper = cx.simulate(cx.presets.load("bare"), duration=5.0, time_step=1e-3, modes=150)
    found = np.asarray(paper.stress("inner", [180.0]))[at, 0]
    assert error(found, reference["stress_inner_tail"]) > 1e-4
