"""A solution made by hand: smooth in time, every order and both halves present, so that each sign and factor shows."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from coaxshell.model import Absorber, Fluid, Layer, PDControl, RigidShell, Shell, SphericalShock, System, materials
from coaxshell.response import Response
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import Estimates, ModalSolution
from coaxshell.structure.control_law import ControlGains
from coaxshell.structure.section import Section, section

M, STEPS, STEP = 12, 80, 0.025

WATER = Fluid(density=1000, sound_speed=1400)
SOURCE = SphericalShock(distance=5.0, peak_pressure=2.5e4, decay_time=1.314e-4)


def lopsided() -> list[Layer]:
    """Return a layup without any symmetry: three moduli, three thicknesses."""
    return [
        Layer(materials.PZT4_STANDARD, 2e-3, role="sensor"),
        Layer(materials.ALUMINIUM, 6e-3),
        Layer(materials.STRUCTURAL_STEEL, 1e-3, role="passive"),
        Layer(materials.PZT4, 4e-3, role="actuator"),
    ]


def system_of(*, control: bool = True, angle: float = 0.0, saturation: bool = False) -> System:
    """Return two lopsided shells in water with two absorbers and, unless told otherwise, control."""
    return System(
        name="by hand",
        shells=[Shell(radius=0.5, layers=lopsided()), Shell(radius=1.25, layers=lopsided())],
        fluids=[WATER, WATER, WATER],
        source=SOURCE.replace(angle=angle),
        absorbers=[Absorber(angle=angle, mass=10, linear_stiffness=1e9) for angle in (20.0, -70.0)],
        control=PDControl(proportional=-2e4, derivative=-150, saturation=saturation) if control else None,
    )


def rates_of(phase: np.ndarray, frequency: np.ndarray, time: np.ndarray) -> np.ndarray:
    return frequency[..., None] * np.cos(frequency[..., None] * time + phase[..., None])


@pytest.fixture(scope="session")
def make() -> Callable[..., ModalSolution]:
    """Return a maker of solutions: amplitudes 1e-4 sin(omega t + phase)/(1 + m), at random but repeatable."""

    def build(system: System | None = None, *, parities: int = 2, modes: int = M, steps: int = STEPS, rates: bool = False) -> ModalSolution:
        system = system_of() if system is None else system
        problem = dimensionless(system.replace(control=None))
        gains = None if system.control is None else ControlGains(system.control.proportional, system.control.derivative)
        elastic = tuple(wall.with_gains(gains) if wall.moves else wall for wall in problem.shells)
        problem = replace(problem, system=system, shells=elastic)
        random = np.random.default_rng(7)
        time = STEP * np.arange(steps + 1)
        shape = (len(problem.shells), parities, modes + 1)
        scale = 1e-4 / (1 + np.arange(modes + 1.0))[:, None]
        parts = {}
        for name in ("normal", "tangential"):
            phase, frequency = random.uniform(0, 6, shape), random.uniform(1, 3, shape)
            parts[name] = scale * np.sin(frequency[..., None] * time + phase[..., None])
            parts[f"{name}_rate"] = scale * rates_of(phase, frequency, time)
        for part in parts.values():
            part[:, 1:, 0] = 0.0  # order 0 has no sine half
        count = len(system.absorber_list)
        solution = ModalSolution(
            problem=problem,
            settings=Settings(duration=steps * STEP, time_step=STEP, modes=modes),
            time=time,
            normal=parts["normal"],
            tangential=parts["tangential"],
            estimates=Estimates(*random.random((3, shape[0], 2))),
            warnings=("the drive is hot (3 > 2); rest",),
            timings={"solve": 0.1, "load": 1 / 3},
            absorber_displacement=random.random((count, steps + 1)) if count else None,
            absorber_force=random.random((count, 2, steps + 1)) if count else None,
        )
        if rates:
            object.__setattr__(solution, "normal_rate", parts["normal_rate"])
            object.__setattr__(solution, "tangential_rate", parts["tangential_rate"])
        return solution

    return build


@pytest.fixture(scope="session")
def solution(make: Callable[..., ModalSolution]) -> ModalSolution:
    return make()


@pytest.fixture(scope="session")
def response(solution: ModalSolution) -> Response:
    return Response(solution)


@pytest.fixture(scope="session")
def rigid_core(make: Callable[..., ModalSolution]) -> Response:
    system = System(
        shells=[RigidShell(radius=0.3), Shell(radius=1.0, layers=[Layer(materials.ALUMINIUM, 6e-3)])],
        fluids=["vacuum", WATER, WATER],
        source=SOURCE,
    )
    return Response(make(system, parities=1))


@pytest.fixture(scope="session")
def lopsided_section() -> Section:
    return section(Shell(radius=0.5, layers=lopsided()))
