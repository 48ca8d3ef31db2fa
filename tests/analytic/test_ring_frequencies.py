"""A shell's dynamic stiffness vanishes at the ring's natural frequencies in vacuo."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import brentq

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import Problem, dimensionless

THICKNESS = 1e-4


@pytest.fixture(scope="module")
def problem(ring: Callable[..., cx.Shell], water: cx.Fluid, shock: cx.PlaneShock) -> Problem:
    return dimensionless(cx.System(shells=[ring(0.6, THICKNESS)], fluids=[cx.VACUUM, water], source=shock))


def stiffness(problem: Problem, omega: float, m: int) -> float:
    """Return Z(i omega), real in vacuo."""
    return float(problem.shells[0].operator(Modes(np.array([float(m)])), np.array([1j * omega])).impedance[0, 0].real)


def bending_speed(thickness: float) -> float:
    """Return sqrt(d22/I)/(a c_e) for a = 0.6 m."""
    return float(np.sqrt(177.45e9 * thickness**2 / 12 / (1 - 0.3**2) / 7800)) / (0.6 * 1400)


@pytest.mark.parametrize("m", [2, 3, 5, 9])
def test_flexural(problem: Problem, m: int) -> None:
    expected = bending_speed(THICKNESS) * np.sqrt(m**2 * (m**2 - 1) ** 2 / (m**2 + 1))
    found = brentq(lambda omega: stiffness(problem, omega, m), 0.9 * expected, 1.1 * expected, xtol=1e-14)
    np.testing.assert_allclose(found, expected, rtol=1e-7)


@pytest.mark.parametrize("m", [0, 1, 4])
def test_breathing_and_membrane(problem: Problem, m: int) -> None:
    ring_frequency = np.sqrt(177.45e9 / (1 - 0.3**2) / 7800) / 1400
    expected = ring_frequency * np.sqrt(1 + m**2)
    found = brentq(lambda omega: stiffness(problem, omega, m), 0.99 * expected, 1.01 * expected, xtol=1e-14)
    np.testing.assert_allclose(found, expected, rtol=1e-7)


def test_translation_has_only_mass(problem: Problem) -> None:
    # Slowly pushed, order 1 moves as a body: V = W, and twice the mass per normal load (V carries as much as W).
    operator = problem.shells[0].operator(Modes(np.array([1.0])), np.array([1e-3 + 0j]))
    np.testing.assert_allclose(operator.tangential[0, 0], 1.0, rtol=5e-7)
    np.testing.assert_allclose(operator.impedance[0, 0] / 1e-6, 2 * problem.shells[0].mass, rtol=4e-7)


def test_light_fluid_leaves_the_frequency(ring: Callable[..., cx.Shell], shock: cx.PlaneShock) -> None:
    # In a fluid hardly there the shell rings in vacuo: the breathing period counted in its history.
    thin = cx.Fluid(density=1e-2, sound_speed=1400)
    response = cx.simulate(
        cx.System(shells=[ring()], fluids=[cx.VACUUM, thin], source=shock.replace(peak_pressure=1.0)), duration=60, time_step=1e-2, modes=1
    )
    w = response.solution.normal[0, 0, 0]
    late = w[500:] - w[500:].mean()
    crossings = np.flatnonzero((late[:-1] < 0) & (late[1:] >= 0))
    exact = crossings + late[crossings] / (late[crossings] - late[crossings + 1])
    period = np.diff(exact).mean() * 1e-2
    np.testing.assert_allclose(2 * np.pi / period, np.sqrt(177.45e9 / (1 - 0.3**2) / 7800) / 1400, rtol=1e-4)
