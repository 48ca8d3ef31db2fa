"""Several steps at once against one step at a time."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from coaxshell.model import presets
from coaxshell.response import prepare
from coaxshell.solver import estimates
from coaxshell.solver.interface import relaxation, ring_march
from coaxshell.solver.interface.laws import CubicSprings
from coaxshell.solver.interface.relaxation import Relaxation


@pytest.mark.parametrize(("cubic", "together"), [(1e19, True), (1e20, True), (1e23, False)])
def test_the_march_is_the_same_whether_steps_are_taken_together(monkeypatch, cubic, together):
    """Springs from barely to strongly cubic; the strongest make it go back to single steps within the run."""
    system = presets.load("absorbers").with_overrides({"absorbers.cubic_stiffness": cubic, "absorbers.count": 24})
    prepared = prepare(system.replace(absorbers=()), duration=3.0, time_step=1e-2, modes=16)
    found = []
    original = Relaxation.solve
    monkeypatch.setattr(ring_march, "LINKS", 10**6)  # rings are marched by classes
    monkeypatch.setattr(Relaxation, "solve", lambda self, known: found.append(original(self, known)) or found[-1])
    monkeypatch.setattr(estimates, "march_error", lambda *run: np.zeros_like(run[-1]))  # it marches too
    several = prepared.simulate(system.absorbers)
    assert found
    assert (found[-1] is not None) == together
    monkeypatch.setattr(relaxation, "UNKNOWNS", 1)
    alone = prepared.simulate(system.absorbers)
    force = np.asarray(alone.absorber_force())
    assert_allclose(np.asarray(several.absorber_force()), force, rtol=0, atol=1e-11 * np.abs(force).max())
    assert several.warnings == alone.warnings


def test_it_solves_its_equation_or_says_that_it_cannot():
    random = np.random.default_rng(5)
    size, steps = 6, 4
    rows = np.tril(random.normal(size=(steps * size, steps * size))) * 1e-5
    springs = CubicSprings(random.uniform(0.5, 2.0, size), np.zeros(size))
    known = random.normal(size=(steps, size))
    solved = Relaxation(rows, size, springs).solve(known)
    assert solved is not None
    z = known + (rows @ solved.nonlinear_part.ravel()).reshape(known.shape)
    assert_allclose(springs.nonlinear_part(z), solved.nonlinear_part, rtol=1e-10)
    assert_allclose(solved.z, z, rtol=1e-10)
    assert Relaxation(1e4 * rows, size, springs).solve(known) is None
