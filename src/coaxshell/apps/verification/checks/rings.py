"""Natural frequencies of rings in vacuo."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.optimize import brentq

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Finding, close
from coaxshell.apps.verification.systems import STEEL, WATER, thin_shell
from coaxshell.model.fluids import VACUUM, Fluid
from coaxshell.model.sources import PlaneShock
from coaxshell.model.system import System
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import Problem, dimensionless

RADIUS, THIN = 0.6, 1e-4
PLATE = STEEL.youngs_modulus / (1 - STEEL.poisson_ratio**2)
HOPPE = "closed form m²(m²-1)²/(m²+1), Hoppe 1871"
SHOCK = PlaneShock(peak_pressure=1.0, decay_time=1.314e-4)


@check("ring-frequencies", "Natural frequencies of a ring in vacuo")
def ring_frequencies(bench: Bench) -> Iterator[Finding]:
    """Compare the zeros of a thin shell's dynamic stiffness with the ring's flexural, breathing and membrane frequencies."""
    problem = dimensionless(System(shells=[thin_shell(RADIUS, THIN)], fluids=[VACUUM, WATER], source=SHOCK))
    per_second = 1 / problem.scales.time
    bending = float(np.sqrt(PLATE * THIN**2 / 12 / STEEL.density)) / RADIUS**2
    for m in (2, 3, 5, 9):
        expected = bending * float(np.sqrt(m**2 * (m**2 - 1) ** 2 / (m**2 + 1)))
        found = _zero(problem, expected / per_second, m) * per_second
        yield close(f"flexural, m = {m}", HOPPE, expected, found, 1e-5, unit="rad/s")
    for m in (0, 1, 4):
        expected = float(np.sqrt(PLATE / STEEL.density * (1 + m**2))) / RADIUS
        found = _zero(problem, expected / per_second, m) * per_second
        name = "breathing" if m == 0 else "membrane"
        yield close(f"{name}, m = {m}", "closed form (1 + m²) Q/(ρR²)", expected, found, 1e-5, unit="rad/s")
    light = Fluid(density=1e-2, sound_speed=1400)
    system = System(shells=[thin_shell()], fluids=[VACUUM, light], source=SHOCK)
    response = bench.simulate(system, duration=60.0, time_step=1e-2, modes=1)
    expected = float(np.sqrt(PLATE / STEEL.density)) / 1400
    yield close(
        "breathing counted in a history in hardly any fluid",
        "closed form",
        expected,
        _counted(response.solution.normal[0, 0, 0], 1e-2),
        1e-4,
    )


def _zero(problem: Problem, guess: float, m: int) -> float:
    """Return the frequency next to a guess at which the dynamic stiffness, real in vacuo, vanishes."""

    def stiffness(omega: float) -> float:
        return float(problem.shells[0].operator(Modes(np.array([float(m)])), np.array([1j * omega])).impedance[0, 0].real)

    return float(brentq(stiffness, 0.99 * guess, 1.01 * guess, xtol=1e-14))


def _counted(history: np.ndarray, step: float) -> float:
    """Return the angular frequency from the upward crossings of the later part of a history."""
    late = history[500:] - history[500:].mean()
    crossings = np.flatnonzero((late[:-1] < 0) & (late[1:] >= 0))
    exact = crossings + late[crossings] / (late[crossings] - late[crossings + 1])
    return float(2 * np.pi / (np.diff(exact).mean() * step))
