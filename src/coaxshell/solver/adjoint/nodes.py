"""Linear absorbers at each Laplace node, transposed.

The forces are f = -Y w with w = w_0 + G f, G the receptance at the points (:mod:`coaxshell.solver.interface.linear`). If F is what a unit
of force changes of a number, then

    (1 + G^T Y) mu = F,        psi = Y mu,        kappa = (z_0 mu_0 + z_1 mu_1)/(m s^2 + z_0 + z_1),

and adding g to the laws of the links of a mass changes it by Re sum (mu - kappa) g.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.adjoint.laws import ElementSensitivity, all_elements
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, side_admittance
from coaxshell.solver.interface.linear import BLOCK_BYTES
from coaxshell.solver.links.described import LINEAR, Element, LawGroup
from coaxshell.solver.links.law import LinearLaw
from coaxshell.solver.spectral import map_node_blocks
from coaxshell.solver.structure_spectra import StructureSpectra

_STEP = 1e-5
"""Relative step by which impedances are differenced."""


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
        law_of = side_admittance(absorbers, nodes[block])
        system = points.receptance(structure.compliance[..., block]).swapaxes(1, 2).copy()
        inner, outer = system[:, :, :count].copy(), system[:, :, count:]
        system[:, :, :count] = inner * law_of.inner[:, None] + outer * law_of.other[:, None]
        system[:, :, count:] = inner * law_of.other[:, None] + outer * law_of.outer[:, None]
        system[:, np.arange(2 * count), np.arange(2 * count)] += 1.0
        mu = np.linalg.solve(system, load[:, block].T[:, :, None])[:, :, 0]
        first, second = mu[:, :count], mu[:, count:]
        force[:count, block] = (law_of.inner * first + law_of.other * second).T
        force[count:, block] = (law_of.other * first + law_of.outer * second).T
        kappa = law_of.mass_displacement(first, second)
        mass[:, block] = kappa.T
        law[:count, block], law[count:, block] = (first - kappa).T, (second - kappa).T

    map_node_blocks(blocks, work, None, "linear absorbers backwards")
    return TransposedNodes(law, force, mass)


def elements_at_nodes(absorbers: AbsorberSet, s: ComplexArray, felt: ComplexArray) -> ElementSensitivity:
    """Return what the numbers of linear elements change, Re sum over nodes of felt dz/dp; ``felt`` is (mu - kappa) D, (2N, nodes).

    Their impedances z(p), known in closed form, are differenced, not the run.
    """
    assert absorbers.elements is not None
    found = []
    for link, several in enumerate(all_elements(absorbers)):
        bars = []
        for one in several:
            bar = np.zeros(len(one.numbers))
            for number, at in enumerate(one.numbers if one.kind in LINEAR else ()):
                step = _STEP * abs(at) or 1.0
                ends = [_impedance(one, number, at + sign * step, s) for sign in (1.0, -1.0)]
                bar[number] = float((felt[link] @ (ends[0] - ends[1])).real) / (2.0 * step)
            bars.append(bar)
        found.append(bars)
    return ElementSensitivity(found)


def _impedance(one: Element, number: int, value: float, s: ComplexArray) -> ComplexArray:
    numbers = tuple(value if j == number else x for j, x in enumerate(one.numbers))
    law = LawGroup(one.kind, np.zeros(1, np.int64), [one._replace(numbers=numbers)]).made(1.0)
    return cast(LinearLaw, law).impedance(s)[:, 0]
