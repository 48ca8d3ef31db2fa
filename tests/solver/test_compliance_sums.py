"""Sums over orders of what surfaces yield, from few orders, against the sums over all."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.solver.compliance_sums import ComplianceSums
from coaxshell.solver.faced_forces import surface_compliance
from coaxshell.solver.scaling import Problem, dimensionless

STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)
RUBBER = cx.Viscoelastic(density=1100, long_term_modulus="6 MPa", poisson_ratio=0.499, prony=[("30 MPa", "1e-4 s")])
WATER = cx.Fluid(density=1000, sound_speed=1400)
MODES = Modes.up_to(40)
SHARES = {(0, 0): np.random.default_rng(1).random((3, 41)), (0, 1): np.ones((1, 41))}


def problem(kind: str) -> Problem:
    """Return two walls: of steel, beside a thin one, or with losses, one of them under a coat."""
    steel = STEEL.replace(loss_factor=0.02) if kind == "losses" else STEEL
    layers = [cx.Layer(steel, 0.02), *([cx.Layer(RUBBER, 0.02)] if kind == "losses" else [])]
    shells = [cx.Shell(radius=0.5, layers=layers, theory="elastic"), cx.Shell(radius=1.0, layers=[cx.Layer(steel, 0.02)])]
    if kind != "thin":
        shells[1] = shells[1].replace(theory="elastic")
    described = cx.System(shells=shells, fluids=[WATER] * 3, source=cx.PlaneShock(peak_pressure=25e3, decay_time=0.13e-3))
    return dimensionless(described).resolving(500.0)


@pytest.mark.parametrize("kind", ["steel", "thin", "losses"])
def test_sums_are_those_of_all_orders(kind: str) -> None:
    """To 1e-11 of the largest order, though most orders are solved at few of the nodes only."""
    walls, solved = problem(kind), []

    def compliance(structure: Problem, s: np.ndarray, modes: Modes) -> np.ndarray:
        solved.append(modes.count * s.size)
        return surface_compliance(structure, s, modes)

    sums = ComplianceSums(walls, MODES, SHARES, compliance)
    s = np.r_[3.0 + 2.0j, 4.0 + 1j * np.linspace(1800.0, 6000.0, 40), 9e4]
    sums.prepare(s)
    low, high = sums.at(s[:1]), sums.at(s[1:])
    found = {pair: np.concatenate([low[pair], high[pair]], axis=1) for pair in SHARES}
    every = surface_compliance(walls, s, MODES)
    for pair, rows in SHARES.items():
        error, largest = np.abs(found[pair] - rows @ every[pair]), np.abs(every).max(axis=(0, 1, 2))
        np.testing.assert_array_less(error, 1e-11 * rows.sum(axis=1)[:, None] * largest)
    assert sum(solved) < 0.8 * 41 * s.size


def test_feedback_may_choose_among_orders_so_that_all_are_solved() -> None:
    described = cx.presets.load("electrodes")
    exact = described.replace(shells=[shell.replace(theory="elastic") for shell in described.shells])
    counts = []

    def compliance(structure: Problem, s: np.ndarray, modes: Modes) -> np.ndarray:
        counts.append(modes.count)
        return np.ones((2, 2, modes.count, s.size), complex)

    ComplianceSums(dimensionless(exact), MODES, SHARES, compliance).at(np.array([4.0 + 6e3j]))
    assert counts == [41]
