"""The cascade of walls with two faces: thin walls dressed as two-ports against the tridiagonal system, others against a dense solve."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.special import iv, ivp, kv, kvp

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.solver.cascade import CascadeSystem
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.structure.rigid import RigidWall
from coaxshell.structure.shell_model import FaceReceptance, ShellModel, WallEnergy, WallOperator

S = np.array([0.3 + 0.2j, 2.0 + 7.0j, 1.0 + 25.0j])
MODES = Modes(np.arange(7.0))
FLUIDS = [cx.Fluid(density=900, sound_speed=1300), cx.Fluid(density=1100, sound_speed=1600), cx.Fluid(density=800, sound_speed=1200)]


@dataclass(frozen=True, kw_only=True)
class Sandwich(ShellModel):
    """Two masses (per area of their own faces) at the radii of the faces with a spring between them and one to the ground."""

    mass: float = 0.0
    faces_at: tuple[float, float]
    masses: tuple[float, float]
    spring: float
    ground: float

    @property
    def wetted(self) -> tuple[float, float]:
        return self.faces_at

    @property
    def faces_move_alike(self) -> bool:
        return False

    def stiffness_at(self, m: float, s: complex) -> np.ndarray:
        """Return the dynamic stiffness on (w_i, w_o) per unit of angle."""
        k = self.spring * (1.0 + m)
        own = [r * mass * s * s + self.ground for r, mass in zip(self.faces_at, self.masses, strict=True)]
        return np.array([[own[0] + k, -k], [-k, own[1] + k]])

    def receptance(self, modes: Modes, s: np.ndarray) -> FaceReceptance:
        h = np.array([[np.linalg.inv(self.stiffness_at(m, x)) for x in s] for m in modes.orders])
        return FaceReceptance(h[..., 0, 0], h[..., 0, 1], h[..., 1, 1])

    def passive(self, modes: Modes, s: np.ndarray) -> WallOperator:
        raise NotImplementedError

    def highest_frequency(self, modes: Modes) -> np.ndarray:
        raise NotImplementedError

    def energy(self, motion: object) -> WallEnergy:
        raise NotImplementedError


@pytest.fixture(scope="module")
def problem(ring: Callable[..., cx.Shell], water: cx.Fluid, shock: cx.PlaneShock) -> Problem:
    shells = [ring(0.4), ring(0.7, 5e-3).replace(wetted="faces"), ring(1.2).replace(wetted="faces")]
    return dimensionless(cx.System(shells=shells, fluids=[*FLUIDS, water], source=shock))


@pytest.mark.parametrize("loaded", [0, 1, 2])
def test_thin_walls_as_two_ports_are_the_tridiagonal_system(problem: Problem, loaded: int) -> None:
    load = np.ones((MODES.count, S.size), complex)
    cascade, tridiagonal = CascadeSystem(problem, S, MODES), ModalSystem(problem, S, MODES)
    for found, expected in zip(cascade.solve(loaded, load), tridiagonal.solve(loaded, load), strict=True):
        np.testing.assert_allclose(found.outer, expected, rtol=1e-12)
        np.testing.assert_allclose(found.inner, expected, rtol=1e-12)
    np.testing.assert_allclose(cascade.determinant(), tridiagonal.determinant(), rtol=1e-12)


def test_a_pressure_outside_loads_the_true_face(problem: Problem) -> None:
    load = np.ones((MODES.count, S.size), complex)
    found, expected = (system(problem, S, MODES).solve_outside(load) for system in (CascadeSystem, ModalSystem))
    for motion, w in zip(found, expected, strict=True):
        np.testing.assert_allclose(motion.outer, w, rtol=1e-12)
    lever = problem.shells[-1].wetted[1] / problem.shells[-1].radius
    assert lever > 1.0
    np.testing.assert_allclose(expected[0], lever * ModalSystem(problem, S, MODES).solve(2, load)[0], rtol=1e-14)


def sandwiches(problem: Problem) -> Problem:
    walls = (
        Sandwich(radius=0.3, faces_at=(0.28, 0.33), masses=(0.05, 0.02), spring=1.4, ground=0.02),
        problem.shells[1],
        Sandwich(radius=1.0, faces_at=(0.95, 1.04), masses=(0.03, 0.08), spring=0.6, ground=0.1),
    )
    return replace(problem, shells=walls)


def dense(problem: Problem, m: int, s: complex) -> np.ndarray:
    """Return the matrix on all faces, thin walls by two faces tied together, loads per unit of angle; Bessel functions as they stand."""
    walls = problem.shells
    faces = [(i, side) for i, wall in enumerate(walls) for side in ((0,) if wall.faces_move_alike else (0, 1))]
    place = {(i, side): faces.index((i, 0 if walls[i].faces_move_alike else side)) for i in range(len(walls)) for side in (0, 1)}
    matrix = np.zeros((len(faces), len(faces)), complex)
    for i, wall in enumerate(walls):
        if wall.faces_move_alike:
            one = wall.operator(Modes(np.array([float(m)])), np.array([s])).impedance[0, 0]
            matrix[place[i, 0], place[i, 0]] += wall.radius * one
        else:
            matrix[np.ix_([place[i, 0], place[i, 1]], [place[i, 0], place[i, 1]])] += wall.stiffness_at(m, s)
    for j, fluid in enumerate(problem.fluids):
        k = fluid.slowness * s
        sides = [(i, int(i < j)) for i in (j - 1, j) if 0 <= i < len(walls)]
        radii = [walls[i].wetted[side] for i, side in sides]
        basis = [(iv, ivp)] * (j < len(walls)) + [(kv, kvp)] * (j > 0)
        slopes = np.array([[k * d(m, k * r) for _, d in basis] for r in radii])
        values = np.array([[f(m, k * r) for f, _ in basis] for r in radii])
        pressure = fluid.density * s * s * values @ np.linalg.inv(slopes)
        for a, one in enumerate(sides):
            for b, other in enumerate(sides):
                matrix[place[one], place[other]] += (-1 if one[1] else 1) * radii[a] * pressure[a, b]
    return matrix


@pytest.mark.parametrize(("loaded", "side", "row"), [(0, 0, 0), (0, 1, 1), (1, None, 2), (2, 0, 3), (2, 1, 4)])
def test_walls_with_two_faces_against_a_dense_solve(problem: Problem, loaded: int, side: int | None, row: int) -> None:
    mixed = sandwiches(problem)
    found = CascadeSystem(mixed, S, MODES).solve(loaded, np.ones((MODES.count, S.size), complex), side)
    rows = [found[0].inner, found[0].outer, found[1].inner, found[2].inner, found[2].outer]
    radius = mixed.shells[loaded].radius if side is None else mixed.shells[loaded].wetted[side]
    for m in range(MODES.count):
        for n, s in enumerate(S):
            load = np.zeros(5)
            load[row] = radius
            expected = np.linalg.solve(dense(mixed, m, s), load)
            np.testing.assert_allclose([w[m, n] for w in rows], expected, rtol=1e-11, atol=1e-13 * abs(expected).max())


def test_loads_and_displacements_of_a_face_belong_together(problem: Problem) -> None:
    mixed = sandwiches(problem)
    system = CascadeSystem(mixed, S, MODES)
    for h, wall, motion in zip(system.walls, mixed.shells, system.solve_outside(np.ones((MODES.count, S.size), complex)), strict=True):
        inner, outer = wall.wetted
        np.testing.assert_allclose(motion.inner, h.inner * inner * motion.load_inner + h.across * outer * motion.load_outer, rtol=1e-10)
        np.testing.assert_allclose(motion.outer, h.across * inner * motion.load_inner + h.outer * outer * motion.load_outer, rtol=1e-10)


def test_faces_answer_each_other_alike(problem: Problem) -> None:
    # Maxwell and Betti: r_a w_a under a pressure at b is r_b w_b under one at a.
    mixed, load = sandwiches(problem), np.ones((MODES.count, S.size), complex)
    system = CascadeSystem(mixed, S, MODES)
    here, there = system.solve(0, load, side=0), system.solve(2, load, side=1)
    (inner, _), (_, outer) = mixed.shells[0].wetted, mixed.shells[2].wetted
    np.testing.assert_allclose(outer * here[2].outer, inner * there[0].inner, rtol=1e-11)


def test_behind_a_rigid_wall_nothing_moves(problem: Problem) -> None:
    still = replace(problem, shells=(problem.shells[0], RigidWall(radius=problem.shells[1].radius), problem.shells[2]))
    load = np.ones((MODES.count, S.size), complex)
    found, expected = CascadeSystem(still, S, MODES).solve_outside(load), ModalSystem(still, S, MODES).solve_outside(load)
    assert not found[0].inner.any()
    assert not found[1].outer.any()
    np.testing.assert_allclose(found[2].outer, expected[2], rtol=1e-12)


def test_a_vacuum_couples_nothing(problem: Problem) -> None:
    empty = replace(problem, fluids=(None, problem.fluids[1], None, problem.fluids[3]))
    load = np.ones((MODES.count, S.size), complex)
    found, expected = CascadeSystem(empty, S, MODES), ModalSystem(empty, S, MODES)
    for motion, w in zip(found.solve(1, load), expected.solve(1, load), strict=True):
        np.testing.assert_allclose(motion.outer, w, rtol=1e-12, atol=0)
    np.testing.assert_allclose(found.determinant(), expected.determinant(), rtol=1e-12)
