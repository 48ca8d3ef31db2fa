"""Inclined plane waves: what runs ahead of them is refused, with both numbers and what will do."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.sources import PlaneGeometry
from coaxshell.errors import InputError
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.inclination import bending_ahead
from coaxshell.solver.axial.sampling import axial_sampling
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings


def inclined(degrees: float, gap: cx.Fluid | None = None) -> Problem:
    system = cx.presets.load("bare")
    if gap is not None:
        system = system.model_copy(update={"fluids": (system.fluids[0], gap, system.fluids[2])})
    return replace(dimensionless(system), sources=(PlaneGeometry(degrees),))


COARSE = Settings(duration=4.0, time_step=8e-3, modes=40, dimensions=3)


@pytest.mark.parametrize("degrees", [0.0, 10.0, -12.0])
def test_fast_traces_are_taken(degrees: float) -> None:
    np.testing.assert_array_equal(axial_sampling(inclined(degrees), COARSE).wavenumbers, [0.0])


def test_membrane_waves_ahead_of_the_front() -> None:
    pattern = (
        r"^source\.inclination: 25 degrees: .* at 3313 m/s, and membrane waves in the .*shell run ahead of it at 4012 m/s; give less than "
    )
    with pytest.raises(InputError, match=pattern) as error:
        axial_sampling(inclined(25.0), COARSE)
    most = float(error.value.remedy.split()[3])
    assert 20.0 < most < 21.0
    with pytest.raises(InputError, match="run ahead"):
        axial_sampling(inclined(-most - 1e-3), COARSE)
    axial_sampling(inclined(most - 1e-3), COARSE)


def test_sound_in_a_faster_fluid_ahead_of_the_front() -> None:
    fast = cx.Fluid(density=900.0, sound_speed=5000.0)
    with pytest.raises(InputError, match=r"sound in the fluid in the gap run ahead of it at 5000 m/s; give less than 16\.26"):
        axial_sampling(inclined(17.0, fast), COARSE)
    axial_sampling(inclined(16.0, fast), COARSE)


def test_bending_waves_ahead_of_the_front_must_not_be_resolved() -> None:
    fine = replace(COARSE, time_step=1e-3, modes=150)
    with pytest.raises(
        InputError, match=r"^source\.inclination: 15 degrees: bending waves in the inner shell .* time_step = 0\.001 resolves"
    ) as error:
        axial_sampling(inclined(15.0), fine)
    step = float(re.search(r"time_step = ([\d.e-]+) or more", error.value.remedy)[1])
    axial_sampling(inclined(15.0), replace(fine, time_step=step))
    with pytest.raises(InputError, match="bending"):
        axial_sampling(inclined(15.0), replace(fine, time_step=step, refinement=2))


def test_bending_waves_that_keep_pace_with_the_trace() -> None:
    """Their frequency satisfies the dispersion relation, and their energy is faster than they are."""
    wall, slowness = inclined(0.0).shells[1], np.sin(np.radians(15.0))
    bending, mass = wall.section.bending + sum(layer.coupling**2 / layer.zeta33 for layer in wall.section.piezoelectric), wall.mass
    for order in (0, 40):
        frequency = bending_ahead(wall, slowness, order)
        np.testing.assert_allclose(mass * frequency**2, bending * ((frequency * slowness) ** 2 + order**2) ** 2, rtol=1e-12)
        k = frequency * slowness
        assert 2.0 * k**2 / (k**2 + order**2) > 1.0
    assert bending_ahead(wall, slowness, 10**6) == pytest.approx(0.5 * bending_ahead(wall, slowness, 0))


@pytest.mark.parametrize("order", [0, 20])
@pytest.mark.parametrize("inside", ["vacuum", "water-1400"])
def test_the_coupled_system_has_a_pole_right_of_the_axis_where_bending_waves_run_ahead(order: int, inside: str) -> None:
    """At the frequency foreseen, and about the rate 1/(2 M cos alpha) a wetted face at which a plate loses energy; steel of 12 mm."""
    steel = cx.Layer(cx.Elastic(density=7800, youngs_modulus=210e9, poisson_ratio=0.3), thickness=0.012)
    source = cx.PlaneShock(peak_pressure=1e5, decay_time=1e-4)
    problem = dimensionless(cx.System(shells=[cx.Shell(radius=1.0, layers=[steel])], fluids=[inside, "water-1400"], source=source))
    faces = sum(fluid is not None for fluid in problem.fluids)
    frequency = bending_ahead(problem.shells[0], np.sin(np.radians(10.0)), order)
    rate = faces / (2.0 * problem.shells[0].mass * np.cos(np.radians(10.0)))
    pole = _pole(problem, 10.0, order, complex(rate, frequency))
    np.testing.assert_allclose(pole.imag, frequency, rtol=1e-4)
    np.testing.assert_allclose(pole.real, rate, rtol=0.01)


def test_open_circuit_layers_make_bending_waves_faster_by_no_more_than_foreseen() -> None:
    problem = inclined(10.0)
    wall = problem.shells[1]
    foreseen = bending_ahead(wall, np.sin(np.radians(10.0)), 0)
    without = bending_ahead(replace(wall, section=replace(wall.section, piezoelectric=())), np.sin(np.radians(10.0)), 0)
    assert foreseen < _pole(problem, 10.0, 0, complex(10.0, foreseen)).imag < without


def _pole(problem: Problem, degrees: float, order: int, start: complex) -> complex:
    """Return a zero of the determinant of an order on the trace of an inclined wave, by Newton's method."""
    slowness = np.sin(np.radians(degrees))

    def determinant(s: complex) -> complex:
        nodes = np.array([s])
        return complex(ModalSystem(problem, nodes, Modes.up_to(order, -1j * nodes * slowness)).determinant()[-1, 0])

    s, h = start, 1e-4
    for _ in range(30):
        s -= determinant(s) * 2.0 * h / (determinant(s + h) - determinant(s - h))
    return s
