"""Walls so light that the fluid stops them within a step: finite kernels, and the right ones."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.kernels import exponential_weights
from coaxshell.solver.settings import Settings
from coaxshell.solver.solve import solve


@pytest.mark.parametrize("decay", [0.0, 1e-12, 1e-3, 1.0, 50.0, 700.0, 7e4, 1e9, 1e200])
def test_weights_of_any_decay(decay: float) -> None:
    """A force that is 1 at all instants rises from 0 within half a hat before t = 0: (1 - e^{-bt})/b and what that half leaves."""
    grid = LaplaceGrid(0.1, 40)
    weights = exponential_weights(np.array([[decay]]), grid)[0]
    assert np.isfinite(weights).all()
    x = decay * grid.time_step
    mean = 1.0 if x == 0.0 else -np.expm1(-x) / x
    total, end = np.cumsum(weights), grid.time
    step = end if decay == 0.0 else -np.expm1(-decay * end) / decay
    start = grid.time_step * (0.5 - x / 6.0 if x < 1e-3 else (1.0 - mean) / x) * np.exp(-decay * end)
    np.testing.assert_allclose(total[1:], (step + start)[1:], rtol=2e-6)


@pytest.mark.parametrize("thickness", ["10 um", "1 um", "10 nm"])
@pytest.mark.parametrize("wall", ["steel", "aluminium"])
def test_a_cubic_absorber_on_a_film(thickness: str, wall: str) -> None:
    """It moves as the fluid does, which halves of the step agree on."""
    layers = [{"material": wall, "thickness": thickness}]
    system = cx.presets.load("bare").replace(
        shells=[cx.Shell(radius=0.5, layers=layers), cx.Shell(radius=1.0, layers=layers)],
        absorbers=cx.absorber_ring(2, mass=10, damping=1e5, linear_stiffness=1e8, cubic_stiffness=1e18),
    )
    found = solve(system, settings=Settings(duration=1.0, time_step=2e-2, modes=8))
    finer = solve(system, settings=Settings(duration=1.0, time_step=2e-2, modes=8, refinement=2))
    assert np.linalg.norm(found.normal - finer.normal) < 0.02 * np.linalg.norm(finer.normal)


@pytest.mark.parametrize(("radius", "gain", "limit"), [(1.0, 1e10, 1e8), (0.005, 2e4, 1e5)])
def test_saturating_actuators_on_a_film(radius: float, gain: float, limit: float) -> None:
    """A tube of 20 um between an unlimited and no actuator at all; the energy balance closes and a finer step agrees."""
    layers = [cx.Layer("pzt-4", 5e-6, role="sensor"), cx.Layer("aluminium", 1e-5), cx.Layer("pzt-4", 5e-6, role="actuator")]
    control = cx.PDControl(proportional=-gain, derivative=-1e-3 * gain, saturation=True, field_limit=limit)
    system = cx.System(
        shells=[cx.Shell(radius=radius, layers=layers)],
        fluids=["freshwater", "freshwater"],
        source=cx.PlaneWave(pulse=cx.Exponential(peak_pressure=1e6, decay_time=radius / 1500)),
        control=control,
    )
    settings = {"duration": 1.5, "time_step": 5e-2, "modes": 8}
    held = cx.simulate(system, **settings)
    assert "was held at" in " ".join(held.warnings)
    found = held.solution.normal
    others = [system.replace(control=control.replace(saturation=False)), system.replace(control=None)]
    linear, free = (cx.simulate(other, **settings).solution.normal for other in others)
    whole = np.linalg.norm(linear - free)
    assert 1e-2 * whole < np.linalg.norm(found - free) < whole
    assert 1e-2 * whole < np.linalg.norm(found - linear) < whole
    finer = cx.simulate(system, **settings, refinement=4).solution.normal
    assert np.linalg.norm(found - finer) < 5e-3 * np.linalg.norm(finer)
    assert float(np.abs(held.energy()["closure_relative"]).max()) < 1e-4
