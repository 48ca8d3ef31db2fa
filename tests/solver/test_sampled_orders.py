"""A sample of orders at a sample of nodes is what all orders at all nodes hold there."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.sampled_orders import NODES, SampledOrders
from coaxshell.solver.scaling import dimensionless

PULSE = cx.Exponential(peak_pressure=1e5, decay_time=1e-4)
SOURCES = [
    cx.PlaneWave(pulse=PULSE),
    cx.LineWave(pulse=PULSE, distance=3.0),
    cx.SphericalWave(pulse=PULSE, distance=3.0, angle=40.0),
    cx.PlaneWave(pulse=cx.Sampled(time=[0.0, 1e-4, 3e-4], pressure=[1e5, -5e4, 0.0]), angle=-90.0, delay=1e-4),
]
GRID = LaplaceGrid(1e-2, 300)


@pytest.mark.parametrize("source", SOURCES, ids=["plane", "line", "spherical", "sampled"])
def test_motion_under_the_sources(source: cx.LineWave) -> None:
    problem = dimensionless(cx.presets.load("iakovlev-double").replace(source=source))
    orders = np.array([13.0, 20.0, 45.0, 90.0])
    sampled = SampledOrders.of(problem, GRID, orders)
    modes = Modes.up_to(90)
    modal = ModalSystem(problem, GRID.nodes, modes)
    loads = SurfaceLoads(problem, GRID, modes)(modal.radial, slice(None))
    expected = sum(np.abs(np.stack(modal.solve(1, load))) ** 2 for load in loads)[:, orders.astype(int), NODES]
    np.testing.assert_allclose(sampled.excited, expected, rtol=1e-6, atol=1e-14 * expected.max())
    compliance = np.stack([np.stack(modal.solve(j, 1.0)) for j in (0, 1)], axis=1)[:, :, orders.astype(int), NODES]
    np.testing.assert_allclose(sampled.compliance, compliance, rtol=1e-9, atol=1e-12 * np.abs(compliance).max())
