"""History sums while the history is made, and the weights they are made with."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.convolution import History, HistorySum, KernelTable
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.kernels import exponential_weights, velocity_weights
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra


def march(table: KernelTable, inputs: np.ndarray, block: int = 8) -> np.ndarray:
    """Return the sums of all inputs, the present one included, pushed by blocks."""
    convolution, history = HistorySum(table, inputs.shape[1]), History()
    sums = []
    for start in range(0, inputs.shape[-1], block):
        pushed = inputs[..., start : start + block]
        before = convolution.forcing(history, pushed.shape[-1])
        earlier, (history, own) = history, convolution.push(history, pushed)
        np.testing.assert_array_equal(convolution.forcing(earlier, pushed.shape[-1]), before)  # the old one stays as it was
        sums.append(before + own)
    np.testing.assert_array_equal(np.concatenate(history.inputs, axis=-1), inputs)
    return np.concatenate(sums, axis=-1)


@pytest.mark.parametrize("block", [1, 4, 32])
@pytest.mark.parametrize("steps", [1, 2, 31, 32, 33, 65, 177, 256])
def test_equals_the_direct_sum(steps: int, block: int) -> None:
    random = np.random.default_rng(steps)
    kernels, inputs = random.normal(size=(3, 2, 4, steps)), random.normal(size=(2, 2, 4, steps))
    direct = np.zeros((3, 2, 4, steps))
    for n in range(steps):
        for j in range(n + 1):
            direct[..., n] += np.einsum("oim,ihm->ohm", kernels[..., n - j], inputs[..., j])
    np.testing.assert_allclose(march(KernelTable(kernels), inputs, block), direct, rtol=0, atol=1e-12 * abs(direct).max())


def test_a_table_is_shared_between_marches() -> None:
    random = np.random.default_rng(1)
    table = KernelTable(random.normal(size=(2, 2, 3, 300)))
    first, second = random.normal(size=(2, 2, 1, 3, 300))
    alone = march(table, second)
    march(table, first)
    np.testing.assert_array_equal(march(table, second), alone)


def test_the_present_weight_belongs_to_the_block_itself() -> None:
    kernels = np.random.default_rng(2).normal(size=(1, 1, 2, 200))
    table = KernelTable(kernels)
    np.testing.assert_array_equal(table.present, kernels[..., 0])
    convolution = HistorySum(table, 1)
    history, own = convolution.push(History(), np.eye(1, 4)[None, None] * np.ones((1, 1, 2, 1)))
    np.testing.assert_allclose(own[:, 0], kernels[0, ..., :4], rtol=1e-14)
    np.testing.assert_allclose(convolution.forcing(history, 4)[:, 0], kernels[0, ..., 4:8], rtol=1e-14)


@pytest.mark.parametrize(("decay", "tolerance"), [(1e-6, 1e-11), (0.3, 1e-11), (5.0, 1e-11), (200.0, 1e-11)])
def test_exponential_weights_are_integrals_against_hats(decay: float, tolerance: float) -> None:
    grid = LaplaceGrid(0.02, 6)
    weights = exponential_weights(np.array([[decay]]), grid)[0]
    step = grid.time_step
    for lag, weight in enumerate(weights):
        expected = sum(
            quad(lambda t, lag=lag: np.exp(-decay * t) * (1 - abs(t - lag * step) / step), a, b, epsabs=1e-15)[0]
            for a, b in ([(0, step)] if lag == 0 else [((lag - 1) * step, lag * step), (lag * step, (lag + 1) * step)])
        )
        assert weight == pytest.approx(expected, rel=tolerance)


class TestProductIntegration:
    """Velocities under a smooth modal pressure, by the weights and exactly in the Laplace domain."""

    rate = 2.0

    def error(self, step: float) -> float:
        problem = dimensionless(cx.presets.load("active"))
        grid = LaplaceGrid(step, round(1.6 / step))
        structure = StructureSpectra(problem, grid, Modes.up_to(12))
        weights = velocity_weights(problem, grid, structure.compliance)
        s, width, centre = grid.nodes, 0.06, 0.5
        history = np.exp(-(((grid.time - centre) / width) ** 2) / 2)
        spectrum = width * np.sqrt(2 * np.pi) * np.exp(0.5 * (s * width) ** 2 - s * centre)
        exact = grid.invert(structure.compliance * s * spectrum)
        pressure = np.broadcast_to(history, weights.shape)
        table = KernelTable(weights.reshape(1, 1, -1, grid.time.size))
        flat = np.ascontiguousarray(pressure.reshape(1, 1, -1, grid.time.size))
        found = march(table, flat).reshape(exact.shape)
        return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))

    def test_rate(self) -> None:
        errors = [self.error(step) for step in (2e-2, 1e-2, 5e-3)]
        np.testing.assert_allclose(np.log2([errors[0] / errors[1], errors[1] / errors[2]]), self.rate, rtol=0, atol=0.02)
        assert errors[-1] < 2e-3


def test_weights_cannot_make_energy() -> None:
    # The symbol of a passive shell's own weights has a positive real part at every frequency.
    problem = dimensionless(cx.presets.load("bare"))
    grid = LaplaceGrid(5e-3, 400)
    weights = velocity_weights(problem, grid, StructureSpectra(problem, grid, Modes.up_to(20)).compliance)
    for i in (0, 1):
        damped = weights[i, i] * np.exp(-grid.shift * grid.time)
        symbol = np.fft.rfft(damped, 4 * grid.time.size, axis=-1).real
        assert symbol.min() > -2e-3 * abs(symbol).max(axis=-1).min()
