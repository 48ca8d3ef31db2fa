"""The interface march: seconds per absorber set on a prepared structure, and its history sums against plain ones.

Paper's resolution (M = 150, dt = 1e-3, T = 5); kernels are prepared before the clock starts.
"""

from __future__ import annotations

import time

import numpy as np

import coaxshell as cx
from benchmarks.measure import median_seconds
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.convolution import History, HistorySum, KernelTable
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.interface.absorbers import AbsorberSet, absorber_set
from coaxshell.solver.interface.linked import solve_linked
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.structure_spectra import StructureSpectra

COUNTS = (1, 25, 300)


class PlainHistorySum:
    """The same sums over the whole history at every step, O(N^2), vectorised over modes."""

    def __init__(self, kernels: np.ndarray, parities: int) -> None:
        _, inputs, modes, steps = kernels.shape
        self._backward = np.ascontiguousarray(kernels[..., ::-1])
        self._inputs = np.zeros((inputs, parities, modes, steps))
        self._steps, self._step = steps, 0

    def present(self) -> np.ndarray:
        """Return sum_{j<n} k_{n-j} x_j."""
        n = self._step
        recent = self._backward[..., self._steps - 1 - n : self._steps - 1]
        return np.stack([sum(np.einsum("mk,hmk->hm", row[j], self._inputs[j, ..., :n]) for j in range(row.shape[0])) for row in recent])

    def push(self, values: np.ndarray) -> None:
        """Append the input of the present step."""
        self._inputs[..., self._step] = values
        self._step += 1


def prepared() -> StructureSpectra:
    """Return the paper's structure with its feedback, everything linear computed."""
    structure = StructureSpectra(dimensionless(cx.presets.load("hybrid")), LaplaceGrid(1e-3, 5000), Modes.up_to(150))
    structure.kernels, structure.linear_velocity, structure.linear_displacement  # noqa: B018 - computed when first asked for
    return structure


def ring(structure: StructureSpectra, count: int) -> AbsorberSet:
    """Return the paper's absorbers, ``count`` of them."""
    absorbers = cx.absorber_ring(count, mass=10, damping=1e6, linear_stiffness=1e9, cubic_stiffness=1e20).absorbers
    return absorber_set(structure.problem, absorbers, 1)


def dyadic_seconds(sums: HistorySum, steps: int, modes: int, block: int = 8) -> float:
    """Return the time of all history sums of one march by dyadic blocks."""
    history, pushed = History(), np.ones((2, 1, modes, block))
    start = time.perf_counter()
    for _ in range(0, steps - block, block):
        sums.forcing(history, block)
        history, _own = sums.push(history, pushed)
    return time.perf_counter() - start


def plain_seconds(sums: PlainHistorySum, steps: int, modes: int) -> float:
    """Return the time of all history sums of one march over the whole history at every step."""
    values = np.ones((2, 1, modes))
    start = time.perf_counter()
    for _ in range(steps - 1):
        sums.present()
        sums.push(values)
    return time.perf_counter() - start


def main() -> None:
    """Print the times and the ratio."""
    structure = prepared()
    for count in COUNTS:
        links = ring(structure, count)
        print(f"hybrid, N = {count}: {median_seconds(lambda links=links: solve_linked(structure, links), 5):.2f} s after preparation")
    table: KernelTable = structure.kernels
    fast = np.median([dyadic_seconds(HistorySum(table, 1), table.steps, 151) for _ in range(3)])
    plain = plain_seconds(PlainHistorySum(table.kernels, 1), table.steps, 151)
    print(f"history sums of one march: {fast:.2f} s by dyadic blocks, {plain:.2f} s plain, ratio {plain / fast:.0f}")


if __name__ == "__main__":
    main()
