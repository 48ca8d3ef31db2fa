"""Linear absorbers at each Laplace node, transposed.

The forces are f = -Y w with w = w_0 + G f, G the receptance at the points (:mod:`coaxshell.solver.interface.linear`). If F is what a unit
of force changes of a number, then

    (1 + G^T Y) mu = F,        psi = Y mu,        kappa = z (mu_0 + mu_1)/(m s^2 + 2 z),

and adding g to the laws of the links of a mass changes it by Re sum (mu - kappa) g.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, admittance
from coaxshell.solver.interface.linear import BLOCK_BYTES
from coaxshell.solver.spectral import map_node_blocks
from coaxshell.solver.structure_spectra import StructureSpectra


@dataclass(frozen=True)
class TransposedNodes:
    """Transforms of N absorbers carried: lambda = mu - kappa and psi (2N, nodes), eta = kappa (N, nodes)."""

    law: ComplexArray
    force: ComplexArray
    mass: ComplexArray


def solve_transposed(structure: StructureSpectra, absorbers: AbsorberSet, points: InterfacePoints, load: ComplexArray) -> TransposedNodes:
    """Solve the transposed system of linear absorbers; ``load`` is F, shape (2N, nodes)."""
    nodes, count = structure.grid.nodes, absorbers.count
    law, force = np.empty((2, 2 * count, nodes.size), np.complex128)
    mass = np.empty((count, nodes.size), np.complex128)
    width = max(4, BLOCK_BYTES // (16 * (2 * count) ** 2))
    blocks = [slice(a, min(a + width, nodes.size)) for a in range(0, nodes.size, width)]

    def work(block: slice) -> None:
        own, other, share = admittance(absorbers, nodes[block])
        system = points.receptance(structure.compliance[..., block]).swapaxes(1, 2).copy()
        inner, outer = system[:, :, :count].copy(), system[:, :, count:]
        system[:, :, :count] = inner * own[:, None] + outer * other[:, None]
        system[:, :, count:] = inner * other[:, None] + outer * own[:, None]
        system[:, np.arange(2 * count), np.arange(2 * count)] += 1.0
        mu = np.linalg.solve(system, load[:, block].T[:, :, None])[:, :, 0]
        first, second = mu[:, :count], mu[:, count:]
        force[:count, block] = (own * first + other * second).T
        force[count:, block] = (other * first + own * second).T
        kappa = share * (first + second)
        mass[:, block] = kappa.T
        law[:count, block], law[count:, block] = (first - kappa).T, (second - kappa).T

    map_node_blocks(blocks, work, None, "linear absorbers backwards")
    return TransposedNodes(law, force, mass)
