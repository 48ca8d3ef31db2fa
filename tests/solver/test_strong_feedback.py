"""Saturation under gains that no step resolves: limits that leave the actuators nothing, or everything, and an engine of its own."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.kernels import trapezoidal_sums
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solve import solve
from coaxshell.solver.structure_spectra import StructureSpectra

ACTIVE = cx.presets.load("active")
ONE = ACTIVE.replace(shells=ACTIVE.shells[1:], fluids=["air", "water-1400"])


def saturating(system: cx.System, proportional: float, derivative: float, field: float | None) -> cx.System:
    """Return the system under saturating control."""
    return system.replace(control=cx.PDControl(proportional=proportional, derivative=derivative, saturation=True, field_limit=field))


def strain(solution: ModalSolution) -> np.ndarray:
    """Return m V - W, which the stress is proportional to."""
    return np.arange(solution.normal.shape[2])[:, None] * solution.tangential - solution.normal


def apart(found: ModalSolution, expected: ModalSolution) -> float:
    """Return the larger relative difference of displacement and strain."""
    pairs = ((found.normal, expected.normal), (strain(found), strain(expected)))
    return max(float(np.linalg.norm(a - b) / np.linalg.norm(b)) for a, b in pairs)


STRONG = [(-2e4, 0.0), (-2e5, 0.0), (-2e6, -150.0), (-2e7, 0.0), (0.0, -1e5), (-2e6, -1.5e4), (2e3, -1.5e4)]


@pytest.mark.parametrize(("proportional", "derivative"), STRONG)
def test_a_limit_near_zero_leaves_the_shell_as_it_is_without_control(proportional: float, derivative: float) -> None:
    settings = Settings(duration=2.0, time_step=0.05, modes=12)
    bare = solve(ONE.replace(control=None), settings=settings)
    assert apart(solve(saturating(ONE, proportional, derivative, 1.0), settings=settings), bare) < 3e-5  # measured 1.4e-5: the limit's own


def test_trapezoidal_sums_are_the_rule_step_by_step() -> None:
    rate, step = np.random.default_rng(1).normal(size=9), 0.25
    sums, before = np.zeros(9), 0.0
    for n, now in enumerate(rate):
        sums[n] = (sums[n - 1] if n else 0.0) + 0.5 * step * (now + before)
        before = now
    np.testing.assert_allclose(trapezoidal_sums(rate, step), sums, rtol=0, atol=1e-14)


@pytest.mark.parametrize("step", [5e-3, 0.05])
def test_the_recursion_of_no_order_grows(step: float) -> None:
    """Where the step does not resolve an order either: (1 - A b_0) u_n = known + A sum b_l u_{n-l} does not grow."""
    problem = dimensionless(saturating(ACTIVE, -2e6, 0.0, 1.0))
    structure = StructureSpectra(problem, LaplaceGrid(step, 100), Modes.up_to(150))
    weights = structure.kernels_with_voltage.kernels[2:]
    for shell in (0, 1):
        own = problem.shells[shell].actuator_pressure * weights[shell, shell]
        u = np.zeros_like(own)
        u[:, 0] = 1.0 / (1.0 - own[:, 0])
        for n in range(1, u.shape[1]):
            u[:, n] = np.einsum("mk,mk->m", own[:, n:0:-1], u[:, :n]) / (1.0 - own[:, 0])
        assert np.abs(u).max() <= 1.0 + 1e-12


@pytest.mark.parametrize("absorbers", [(), cx.absorber_ring(4, mass=10, damping=1e6, linear_stiffness=1e9)], ids=["none", "linear"])
def test_a_limit_out_of_reach_leaves_the_linear_law_exactly(absorbers: object) -> None:
    settings = Settings(duration=1.0, time_step=0.02, modes=10)
    linear = ACTIVE.replace(absorbers=absorbers, control=cx.PDControl(proportional=-2e5, derivative=-150))
    found, expected = solve(saturating(linear, -2e5, -150, 1e12), settings=settings), solve(linear, settings=settings)
    np.testing.assert_array_equal(found.normal, expected.normal)
    assert found.control_correction is not None
    assert not found.control_correction.any()


def test_the_direct_engine_agrees_where_the_loop_is_stiff() -> None:
    stiff = saturating(ONE, -2e5, 0.0, 2e4)
    found = solve(stiff, settings=Settings(duration=1.5, time_step=5e-3, modes=12))
    expected = solve(stiff, settings=Settings(duration=1.5, time_step=5e-3, refinement=2, modes=12, engine="direct"))
    assert apart(found, expected) < 5e-3


@pytest.mark.parametrize(("proportional", "derivative"), [(-2e5, -1.5e4), (-2e6, 0.0)])
def test_steps_that_move_the_voltage_far_converge(proportional: float, derivative: float) -> None:
    coarse, fine = (
        solve(saturating(ONE, proportional, derivative, 2e4), settings=Settings(duration=1.0, time_step=0.04, refinement=r, modes=24))
        for r in (1, 4)
    )
    assert apart(coarse, fine) < 0.05


def test_a_source_off_the_axis_turns_the_answer() -> None:
    settings = Settings(duration=1.0, time_step=0.02, modes=8)
    shock = {"distance": 5.0, "peak_pressure": 2.5e4, "decay_time": 1.314e-4}
    straight, turned = (
        solve(saturating(ACTIVE, -2e5, -150, 2e4).replace(source=cx.SphericalShock(angle=angle, **shock)), settings=settings)
        for angle in (0.0, 90.0)
    )
    size = np.hypot(turned.normal[:, 0], turned.normal[:, 1])
    np.testing.assert_allclose(size, np.abs(straight.normal[:, 0]), rtol=0, atol=1e-8 * size.max())


FOUND_IN_PRACTICE = [(-2e5, 5e-3, 1.0, 2.5e4), (-2e4, 0.05, 1.0, 2.5e4), (-2e6, 1e-3, 5.9e5, 2e6)]
"""Proportional gain, step, field limit, peak pressure: a recursion that grew made 4 times, 1e10 times and 1e6 times the stress of these,
and the run said nothing."""


@pytest.mark.slow_except("-20000.0-0.05-1.0-25000.0", "-200000.0-0.005-1.0-25000.0")
@pytest.mark.filterwarnings("ignore::coaxshell.PhysicsWarning")
@pytest.mark.parametrize(("proportional", "step", "field", "peak"), FOUND_IN_PRACTICE)
def test_no_peak_stress_is_silently_wrong(proportional: float, step: float, field: float, peak: float) -> None:
    """One 12 mm shell with air inside, M = 20: the direct engine, and for limits that leave nothing the shell without control, agree."""
    loud = ONE.replace(source=ONE.source.replace(peak_pressure=peak))
    limited, settings = saturating(loud, proportional, 0.0, field), {"duration": 2.0, "time_step": step, "modes": 20}
    stress = {}
    for name, system, engine in (
        ("march", limited, "spectral"),
        ("direct", limited, "direct"),
        ("none", loud.replace(control=None), "spectral"),
    ):
        steps = max(2, round(step / 2.5e-3)) if engine == "direct" else 1
        response = cx.simulate(system, **settings, engine=engine, refinement=steps)
        stress[name] = response.summary().shells[0].stress.value
    np.testing.assert_allclose(stress["march"], stress["direct"], rtol=2e-3)
    np.testing.assert_allclose(stress["march"], stress["none"], rtol=1e-5 if field == 1.0 else 0.02)
