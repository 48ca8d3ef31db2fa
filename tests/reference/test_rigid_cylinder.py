"""Rigid cylinder under a plane step: total modal pressure on the surface, against the table to all its digits."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.operators import all_orders
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.scaling import dimensionless

STEP = 1e5


def pressure_spectrum(grid: LaplaceGrid, modes: int, source: object) -> np.ndarray:
    """Return the modal pressure on a rigid cylinder, which is the load on it, in units of the step, at all nodes."""
    water = cx.Fluid(density=1000, sound_speed=1400)
    problem = dimensionless(cx.System(shells=[cx.RigidShell(radius=0.8)], fluids=[cx.VACUUM, water], source=source))
    orders = all_orders(modes)
    load = SurfaceLoads(problem, grid, Modes(orders))(RadialBasis(Modes(orders), grid.nodes), slice(None))
    return load[0] * problem.scales.pressure / STEP


@pytest.mark.parametrize("m", [0, 1, 2])
def test_against_the_table(sharp_inverse: Callable[..., np.ndarray], tables: dict[str, Any], m: int) -> None:
    # The front grows as sqrt(t): the spectrum falls as s^-3/2 and is inverted with its front taken off.
    grid = LaplaceGrid(5e-3, 1200, wrap_around=1e-12)
    spectrum = pressure_spectrum(grid, 2, cx.PlaneWave(pulse=cx.Step(pressure=STEP)))
    history = sharp_inverse(grid, spectrum, lead=1.5)[m]
    at = np.round(np.array(tables["rigid"]["time"]) / grid.time_step).astype(int)
    np.testing.assert_allclose(history[at], tables["rigid"][f"m{m}"], rtol=0, atol=1e-10)


def test_the_plain_inversion_is_good_to_1e_6_behind_the_front() -> None:
    grid = LaplaceGrid(1e-3, 1500)
    source = cx.PlaneWave(pulse=cx.Step(pressure=STEP))
    history = grid.invert(pressure_spectrum(grid, 2, source))
    found = history[:, [500, 1000]]
    expected = [[0.5666883288, 0.7240382276], [0.931771574, 0.9264981469], [0.4519598189, 0.009863995037]]
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6)


def test_late_pressure_is_that_of_the_wave() -> None:
    # The cylinder is forgotten: order 0 tends to 1 and the others to 0, as 1/t or faster.
    grid = LaplaceGrid(0.05, 2000)
    history = grid.invert(pressure_spectrum(grid, 3, cx.PlaneWave(pulse=cx.Step(pressure=STEP))))
    np.testing.assert_allclose(history[:, -1], [1, 0, 0, 0], rtol=0, atol=1e-4)
    assert abs(history[0, 400] - 1) > abs(history[0, 1000] - 1) > abs(history[0, 2000] - 1)


@pytest.mark.parametrize(
    "source",
    [
        cx.PlaneWave(pulse=cx.Step(pressure=STEP)),
        cx.LineWave(distance=4.0, pulse=cx.Step(pressure=STEP)),
        cx.SphericalWave(distance=4.0, pulse=cx.Step(pressure=STEP)),
        cx.SphericalWave(distance=1.5, pulse=cx.Step(pressure=STEP)),
    ],
    ids=lambda source: f"{source.type}-{source.distance}",
)
def test_head_pressure_doubles_at_the_front(source: object) -> None:
    # Initial value theorem: s p(s) -> 2 at the head, with an error falling as 1/s (curvature: about -1/s for a plane wave).
    grid = LaplaceGrid(0.02, 200)
    head = pressure_spectrum(grid, 260, source).sum(axis=0) * grid.nodes
    defect = abs(head - 2) * abs(grid.nodes)
    assert defect[50:].max() < 1.1
    assert abs(head[-1] - 2) < 1e-2
