"""The tridiagonal elimination against the dense system written out from shells and fluids: loads on any shell, the determinant."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.special import iv, ivp, kv, kvp

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import Problem, dimensionless

S = np.array([0.3 + 0.2j, 2.0 + 7.0j, 1.0 + 25.0j])
ORDERS = np.arange(9.0)
FLUIDS = [cx.Fluid(density=900, sound_speed=1300), cx.Fluid(density=1100, sound_speed=1600), cx.Fluid(density=800, sound_speed=1200)]


@pytest.fixture(scope="module")
def problem(ring: Callable[..., cx.Shell], water: cx.Fluid, shock: cx.PlaneShock) -> Problem:
    shells = [ring(0.4), ring(0.7, 5e-3), ring(1.2)]
    return dimensionless(cx.System(shells=shells, fluids=[*FLUIDS, water], source=shock))


def dense(problem: Problem, m: int, s: complex) -> np.ndarray:
    """Return the matrix on (V_i, W_i) of all shells: nothing eliminated, Bessel functions as they stand."""
    count = len(problem.shells)
    matrix = np.zeros((2 * count, 2 * count), complex)
    for i, shell in enumerate(problem.shells):
        k = shell.stiffness(Modes(np.array([float(m)])))
        block = slice(2 * i, 2 * i + 2)
        matrix[block, block] = [[k.vv[0], k.vw[0]], [k.vw[0], k.ww[0]]] + shell.mass * s * s * np.eye(2)
    radii = [shell.radius for shell in problem.shells]
    for j, fluid in enumerate(problem.fluids):
        k = fluid.slowness * s
        walls = [i for i in (j - 1, j) if 0 <= i < count]
        basis = [(iv, ivp)] * (j < count) + [(kv, kvp)] * (j > 0)
        slopes = np.array([[k * d(m, k * radii[i]) for _, d in basis] for i in walls])
        values = np.array([[f(m, k * radii[i]) for f, _ in basis] for i in walls])
        pressure = fluid.density * s * s * values @ np.linalg.inv(slopes)
        for a, i in enumerate(walls):
            outside = i == j - 1  # this fluid lies outside shell i: its pressure pushes inward, towards positive w
            for b, other in enumerate(walls):
                matrix[2 * i + 1, 2 * other + 1] += (-1 if outside else 1) * pressure[a, b]
    return matrix


@pytest.mark.parametrize("loaded", [0, 1, 2])
def test_against_the_dense_system(problem: Problem, loaded: int) -> None:
    system = ModalSystem(problem, S, Modes(ORDERS))
    w = system.solve(loaded, np.ones((ORDERS.size, S.size), complex))
    v = system.tangential(w)
    for m in range(ORDERS.size):
        for n, s in enumerate(S):
            matrix = dense(problem, m, s)
            load = np.zeros(6)
            load[2 * loaded + 1] = 1.0
            expected = np.linalg.solve(matrix, load)
            found = [part[m, n] for pair in zip(v, w, strict=True) for part in pair]
            np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-13 * abs(expected).max())


def test_determinant(problem: Problem) -> None:
    # V_i eliminated with its own pivot K_vv + m s^2: the dense determinant is that of what remains times all pivots.
    found = ModalSystem(problem, S, Modes(ORDERS)).determinant()
    for m in range(ORDERS.size):
        pivots = [shell.stiffness(Modes(np.array([float(m)]))).vv[0] + shell.mass * S * S for shell in problem.shells]
        expected = [np.linalg.det(dense(problem, m, s)) for s in S]
        np.testing.assert_allclose(found[m] * np.prod(pivots, axis=0), expected, rtol=1e-11)


def test_maxwell_betti(problem: Problem) -> None:
    # R_i C_ij = R_j C_ji: work is per unit of angle, loads are per unit of area.
    system = ModalSystem(problem, S, Modes(ORDERS))
    radii = [shell.radius for shell in problem.shells]
    answers = [system.solve(j, np.ones((ORDERS.size, S.size), complex)) for j in range(3)]
    for i in range(3):
        for j in range(i):
            np.testing.assert_allclose(radii[i] * answers[j][i], radii[j] * answers[i][j], rtol=1e-12)
