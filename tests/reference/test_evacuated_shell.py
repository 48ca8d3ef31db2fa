"""Evacuated steel shell under a plane step: modal velocities against the table, and the translation it ends with."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.scaling import dimensionless

STEP = 1e5


def velocities(system: cx.System, grid: LaplaceGrid, spectra: Callable[..., Any]) -> np.ndarray:
    """Return dW_m/dt of the outermost shell over p0/(rho c), m = 0, 1, 2."""
    factor = dimensionless(system).scales.pressure / STEP
    return grid.invert(spectra(system, grid, 2).normal[-1, 0] * grid.nodes * factor)


@pytest.fixture(scope="module")
def evacuated(ring: Callable[..., cx.Shell], water: cx.Fluid) -> cx.System:
    return cx.System(shells=[ring()], fluids=[cx.VACUUM, water], source=cx.PlaneWave(pulse=cx.Step(pressure=STEP)))


@pytest.mark.parametrize("m", [0, 1, 2])
def test_against_the_table(evacuated: cx.System, spectra: Callable[..., Any], tables: dict[str, Any], m: int) -> None:
    grid = LaplaceGrid(1e-3, 5200)
    history = velocities(evacuated, grid, spectra)[m]
    at = np.round(np.array(tables["evacuated"]["time"]) / grid.time_step).astype(int)
    np.testing.assert_allclose(history[at], tables["evacuated"][f"m{m}"], rtol=0, atol=1e-9)


def test_translation_tends_to_its_limit(evacuated: cx.System, spectra: Callable[..., Any]) -> None:
    limit = 2 / (1 + 2 * 7800 * 1e-2 / 1000)
    np.testing.assert_allclose(limit, 1.73010, rtol=1e-5)
    velocity = velocities(evacuated, LaplaceGrid(0.05, 2000), spectra)[1]
    np.testing.assert_allclose(velocity[-1], limit, rtol=1e-4)


def test_water_inside_counts_as_mass(ring: Callable[..., cx.Shell], water: cx.Fluid, spectra: Callable[..., Any]) -> None:
    # 2/(1 + M/M_d): M is all that lies within the outer surface, M_d the displaced fluid.
    source = cx.PlaneWave(pulse=cx.Step(pressure=STEP))
    single = cx.System(shells=[ring()], fluids=[water, water], source=source)
    both = cx.System(shells=[ring(0.5), ring()], fluids=[cx.VACUUM, water, water], source=source)
    grid = LaplaceGrid(0.05, 4000)
    shell = 2 * 7800 * 1e-2 / 1000
    late = slice(-1000, None)  # sloshing inside rings on slowly: the mean over many of its periods
    mean = velocities(single, grid, spectra)[1, late].mean()
    np.testing.assert_allclose(mean, 2 / (1 + 1 + shell), rtol=1e-5)
    # The gap's water does not move rigidly with both shells, so only the inside of the outer shell as a whole is weighed.
    mean = velocities(both, grid, spectra)[1, late].mean()
    assert 2 / (1 + 0.75 + 1.5 * shell) * 0.9 < mean < 2 / (1 + 0.75 + 1.5 * shell) * 1.1
