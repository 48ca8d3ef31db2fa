"""A wall that the house does not know, put into a problem: the whole solver runs on what it tells, against closed forms.

Locally reacting: every point is a mass on a spring and a damper of its own, Z = M s^2 + c s + k, and nothing moves along the wall. With
vacuum inside, the inner wall answers alike at every order, and the outer one feels the exterior fluid alone.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.special import kv, kvp

import coaxshell as cx
from coaxshell.acoustics.operators import all_orders
from coaxshell.numerics.modes import Modes
from coaxshell.response import PreparedSystem, Response
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.structure.shell_model import Gain, ShellModel, WallEnergy, WallOperator, square

M = 10
LINEAR = {"mass": 8.0, "damping": 2e5, "linear_stiffness": 1e9}


@dataclass(frozen=True, kw_only=True)
class SprungWall(ShellModel):
    """Z = M s^2 + c s + k."""

    spring: float
    damper: float

    def passive(self, modes, s):
        nothing = np.zeros((modes.count, s.size), complex)
        return WallOperator(nothing + self.mass * s * s + self.damper * s + self.spring, nothing)

    def highest_frequency(self, modes):
        return np.full_like(modes.orders, np.sqrt(self.spring / self.mass))

    @property
    def damping(self):
        return self.damper

    def stress_gain(self, modes, depth=None, component="hoop"):
        return Gain(np.zeros_like(modes.orders), np.full_like(modes.orders, self.spring))

    def energy(self, motion):
        weight = 0.5 * self.radius * motion.circle
        kinetic = self.mass * square(weight, motion.w_rate, motion.w_rate)
        held = self.spring * square(weight, motion.w, motion.w)
        return WallEnergy(kinetic, held, np.zeros_like(kinetic))

    @property
    def dissipates(self):
        return self.damper > 0.0

    def dissipated_power(self, motion):
        return self.damper * square(self.radius * motion.circle, motion.w_rate, motion.w_rate)


WALLS = (
    SprungWall(radius=0.5, mass=0.05, spring=0.3, damper=0.02),
    SprungWall(radius=1.0, mass=0.06, spring=0.5, damper=0.1),
)


def sprung() -> Problem:
    bare = cx.presets.load("bare")
    plain = [
        cx.Shell(radius=shell.radius, layers=[shell.core]) for shell in bare.shells
    ]  # described without transducers, as they have none
    return replace(dimensionless(bare.replace(shells=plain, fluids=[cx.VACUUM, cx.VACUUM, bare.exterior])), shells=WALLS)


def solved(time_step: float, absorbers) -> tuple[PreparedSystem, Response]:
    prepared = PreparedSystem(sprung(), Settings(duration=2.0, time_step=time_step, modes=M))
    return prepared, prepared.simulate(absorbers)


def answers(prepared: PreparedSystem) -> tuple[np.ndarray, np.ndarray]:
    """Return C_m of the inner and the outer wall, shape (2, M + 1, nodes), and W of the outer under the shock, by hand."""
    s, m = prepared.structure.grid.nodes, all_orders(M)[:, None]
    inner, outer = (wall.mass * s**2 + wall.damper * s + wall.spring for wall in WALLS)
    outside = 1.0 / (outer - s * kv(m, s) / kvp(m, s))
    rigid = replace(prepared.problem, shells=tuple(replace(wall, spring=1e15) for wall in WALLS))
    load = 1e15 * PreparedSystem(rigid, prepared.settings).structure.normal[1, 0]  # on a wall that hardly gives way
    return np.stack([np.broadcast_to(1.0 / inner, outside.shape), outside]), outside * load


def same(actual: np.ndarray, expected: np.ndarray, rtol: float) -> None:
    np.testing.assert_allclose(actual, expected, rtol=0, atol=rtol * np.abs(expected).max())


def by_hand(prepared: PreparedSystem) -> np.ndarray:
    """Return W of both walls with one linear absorber at the head, shape (2, M + 1, T)."""
    (compliance, alone), s, scales = answers(prepared), prepared.structure.grid.nodes, prepared.problem.scales
    mass = LINEAR["mass"] * scales.velocity**2 / scales.pressure / scales.length**2 * s**2
    link = (LINEAR["linear_stiffness"] + LINEAR["damping"] / scales.time * s) / scales.pressure
    per_force = 1.0 / (np.pi * np.where(all_orders(M) == 0, 2.0, 1.0)[None, :, None] * np.array([0.5, 1.0])[:, None, None])
    here = (compliance * per_force).sum(axis=1)
    own, other = link - link**2 / (mass + 2 * link), -(link**2) / (mass + 2 * link)
    free = np.stack([np.zeros_like(s), alone.sum(axis=0)])
    law = np.moveaxis(np.array([[own, other], [other, own]]), -1, 0)
    walls = np.linalg.solve(np.eye(2) + here.T[:, :, None] * law, free.T[:, :, None])
    force = -(law @ walls)[:, :, 0].T
    w = compliance * per_force * force[:, None]
    w[1] += alone
    return prepared.structure.grid.invert(w)


def test_under_the_shock_it_moves_as_its_closed_form_says():
    prepared, response = solved(5e-3, ())
    same(response.solution.normal[1, 0], prepared.structure.grid.invert(answers(prepared)[1]), 1e-6)
    assert not response.solution.tangential.any()
    assert not response.solution.normal[0].any()


def test_with_a_linear_absorber_it_moves_as_its_closed_form_says():
    prepared, response = solved(5e-3, [cx.Absorber(angle=0, **LINEAR)])
    same(response.solution.normal[:, 0], by_hand(prepared), 1e-6)


def test_the_march_converges_to_it_at_second_order():
    errors = []
    for step in (1e-2, 5e-3):
        prepared, response = solved(step, [cx.Absorber(angle=0, **LINEAR, cubic_stiffness=1.0)])  # negligible, but it is marched
        expected = by_hand(prepared)
        errors.append(np.abs(response.solution.normal[:, 0] - expected).max() / np.abs(expected).max())
    assert errors[1] < 2e-4
    assert 3.0 < errors[0] / errors[1] < 5.0


def test_its_energy_closes_with_what_it_dissipates():
    _, response = solved(5e-3, [cx.Absorber(angle=0, **LINEAR)])
    energy = response.energy()
    assert float(np.abs(energy["closure_relative"]).max()) < 1e-5
    assert energy["outer_dissipation"].attrs["role"] == "loss"
    assert float(energy["outer_dissipation"][-1]) > 0.1 * float(np.abs(energy["exterior_work"]).max())
    assert "inner_dissipation" in energy


def test_summary_and_fields_ask_for_nothing_else():
    _, response = solved(1e-2, [cx.Absorber(angle=0, **LINEAR)])
    assert "outer" in str(response.summary())
    scales = response.solution.problem.scales
    expected = WALLS[1].spring * scales.pressure / scales.length * response.displacement("outer", angle=0)
    np.testing.assert_allclose(response.stress("outer", angle=0), expected, rtol=1e-12)
    assert np.isfinite(response.pressure(x=[1.5, 2.0], y=[0.0], time=1.0)).all()


def test_the_direct_engine_refuses_what_it_cannot_step():
    with pytest.raises(cx.InputError, match="direct"):
        WALLS[0].stiffness(Modes.up_to(M))
