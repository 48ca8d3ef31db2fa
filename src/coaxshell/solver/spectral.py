"""The spectral engine: every mode at every Laplace node by one small solve, time histories by FFT.

Without nonlinearity that is the whole solution. Nodes are worked through in blocks that stay in the processor's cache, two
blocks at a time (NumPy releases the interpreter lock).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.laplace_grid import WORKERS, LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts

# A block of complex numbers of this many order-node pairs is 1 MB, small enough that a dozen of them share a cache.
_BLOCK_ELEMENTS = 64 * 1024


def node_blocks(grid: LaplaceGrid, max_order: int) -> list[slice]:
    """Return consecutive slices of the Laplace nodes, each of about the same size."""
    count = grid.nodes.size
    width = max(64, _BLOCK_ELEMENTS // (max_order + 1))
    blocks = max(1, round(count / width))
    edges = np.linspace(0, count, blocks + 1).astype(int)
    return [slice(int(a), int(b)) for a, b in pairwise(edges)]


def map_node_blocks(blocks: list[slice], work: Callable[[slice], None], progress: Progress | None, stage: str) -> None:
    """Run ``work`` on every block on all threads, telling the progress after each."""
    with ThreadPoolExecutor(WORKERS) as pool:
        for done, _ in enumerate(pool.map(work, blocks), start=1):
            if progress is not None:
                progress(done / len(blocks), stage)


@dataclass(frozen=True)
class LinearSpectra:
    """Transforms of everything linear, at orders 0..M and the nodes of a Laplace grid.

    Attributes
    ----------
    normal, tangential : ndarray, shape (shells, parities, M + 1, nodes)
        W and V of every shell under the sources alone.
    compliance : ndarray, shape (shells, shells, M + 1, nodes), or None
        C_ij: W of shell i per modal pressure on shell j.
    ratio : ndarray, shape (shells, M + 1, nodes), or None
        V/W of every shell under any normal load.
    """

    normal: ComplexArray
    tangential: ComplexArray
    compliance: ComplexArray | None = None
    ratio: ComplexArray | None = None


def linear_spectra(
    problem: Problem,
    grid: LaplaceGrid,
    max_order: int,
    progress: Progress | None = None,
    *,
    compliance: bool = False,
    shared: SharedParts | None = None,
) -> LinearSpectra:
    """Return the transforms of W and V of every shell under the sources, and the modal compliance if asked for."""
    modes = Modes.up_to(max_order)
    loads = SurfaceLoads(problem, grid, modes, shared)
    count, orders, nodes = len(problem.shells), max_order + 1, grid.nodes.size
    spectra = LinearSpectra(
        np.empty((count, loads.parities, orders, nodes), np.complex128),
        np.empty((count, loads.parities, orders, nodes), np.complex128),
        np.empty((count, count, orders, nodes), np.complex128) if compliance else None,
        np.empty((count, orders, nodes), np.complex128) if compliance else None,
    )

    def work(block: slice) -> None:
        modal = ModalSystem(problem, grid.nodes[block], modes, shared=shared)
        for parity, load in enumerate(loads(modal.radial, block)):
            normal = modal.solve(count - 1, load)
            for shell, (w, v) in enumerate(zip(normal, modal.tangential(normal), strict=True)):
                spectra.normal[shell, parity, :, block], spectra.tangential[shell, parity, :, block] = w, v
        if spectra.compliance is not None and spectra.ratio is not None:
            for j in range(count):
                for i, w in enumerate(modal.solve(j, 1.0)):
                    spectra.compliance[i, j, :, block] = w
            for i, operator in enumerate(modal.shells):
                spectra.ratio[i, :, block] = operator.tangential

    map_node_blocks(node_blocks(grid, max_order), work, progress, "frequencies")
    return spectra


class Stopwatch:
    """Seconds by stage, in the order in which the stages ended."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = time.perf_counter()

    def lap(self, stage: str) -> None:
        """Book the time since the last lap on ``stage``."""
        now = time.perf_counter()
        self.seconds[stage] = self.seconds.get(stage, 0.0) + now - self._last
        self._last = now
