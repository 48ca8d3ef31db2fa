"""Linear absorbers, solved exactly at each Laplace node.

With z = c s + k_l and the mass eliminated, q = z (w_0 + w_1)/(m s^2 + 2 z), the forces on the two sides are f = -Y w,

    Y = [[z - z^2/d, -z^2/d], [-z^2/d, z - z^2/d]],     d = m s^2 + 2 z,

and the shells answer w = w_linear + G f with G = E C(s) P, E evaluating modes at the points and P projecting forces on modes:
(I + G Y) w = w_linear.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.laplace_grid import Nodes
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.progress import Progress
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, SideAdmittance, side_admittance
from coaxshell.solver.interface.linear_around import Around
from coaxshell.solver.interface.linear_many import NODES, Spread
from coaxshell.solver.scaling import Problem
from coaxshell.solver.spectral import map_node_blocks

BLOCK_BYTES = 8 * 1024 * 1024
"""Of the matrices of a block of nodes."""
_TOLD = 8
"""Blocks of which one node tells whether iteration pays."""


class LinearStructure(Protocol):
    """A structure at some nodes, of a contour or on the imaginary axis: what it does by itself and under unit modal pressures."""

    @property
    def problem(self) -> Problem:
        """Shells, fluids, sources."""
        ...

    @property
    def grid(self) -> Nodes:
        """The nodes."""
        ...

    @property
    def modes(self) -> Modes:
        """The modes."""
        ...

    @property
    def normal(self) -> ComplexArray:
        """W without absorbers, shape (shells, parities, M + 1, nodes)."""
        ...

    @property
    def surface_motion(self) -> ComplexArray:
        """Displacements of the surfaces on which links act, without absorbers, shape (surfaces, parities, M + 1, nodes)."""
        ...

    @property
    def compliance(self) -> ComplexArray:
        """C_ij, shape (surfaces, surfaces, M + 1, nodes)."""
        ...


@dataclass(frozen=True)
class LinearAbsorberSpectra:
    """Transforms of the interface quantities: force (2N, nodes), mass_displacement (N, nodes), modal_pressure."""

    force: ComplexArray
    mass_displacement: ComplexArray
    modal_pressure: ComplexArray


def solve_linear(
    structure: LinearStructure, absorbers: AbsorberSet, points: InterfacePoints, progress: Progress | None = None
) -> LinearAbsorberSpectra:
    """Return the interface spectra of linear absorbers, exact up to the modal truncation."""
    nodes, count = structure.grid.nodes, absorbers.count
    excited = points.evaluate(structure.surface_motion)
    force = np.empty((2 * count, nodes.size), np.complex128)
    displacement = np.empty((count, nodes.size), np.complex128)
    spread: Spread | Around | None = Spread.of(structure.problem, absorbers, points)
    if spread is not None:
        spread = Around.of(structure.problem, absorbers, structure.modes) or spread
    width = max(4, BLOCK_BYTES // (16 * (2 * count) ** 2)) if spread is None else NODES
    blocks = [slice(a, min(a + width, nodes.size)) for a in range(0, nodes.size, width)]
    largest = float(np.abs(excited).max(initial=0.0))
    pays = [False] * len(blocks) if spread is None else _paying(spread, structure, blocks, excited, largest)
    tried = {block.start for block, one in zip(blocks, pays, strict=True) if one}

    def work(block: slice) -> None:
        law, compliance = side_admittance(absorbers, nodes[block]), structure.compliance[..., block]
        if spread is None:
            w = _dense(points, law, compliance, excited[:, block])
        else:
            w = _iterated(spread, points, nodes[block], compliance, excited[:, block], largest, tried=block.start in tried)
        force[:, block], displacement[:, block] = _exerted(law, w)

    map_node_blocks(blocks, work, progress, "linear absorbers")
    return LinearAbsorberSpectra(force, displacement, points.project(force))


def forces_at(
    absorbers: AbsorberSet, s: ComplexArray, receptance: ComplexArray, excited: ComplexArray
) -> tuple[ComplexArray, ComplexArray]:
    """Return forces (2N, nodes) and displacements of the masses (N, nodes) where points answer forces by G, (nodes, 2N, 2N)."""
    law = side_admittance(absorbers, s)
    return _exerted(law, _held(law, receptance, excited))


def _exerted(law: SideAdmittance, w: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    inner, outer = np.split(w, 2)
    force = np.concatenate([-(law.inner.T * inner + law.other.T * outer), -(law.other.T * inner + law.outer.T * outer)])
    return force, law.mass_displacement(inner.T, outer.T).T


def _dense(points: InterfacePoints, law: SideAdmittance, compliance: ComplexArray, excited: ComplexArray) -> ComplexArray:
    """Return w of (1 + G Y) w = w_linear, (2N, nodes), by matrices of all points."""
    return _held(law, points.receptance(compliance), excited)


def _held(law: SideAdmittance, receptance: ComplexArray, excited: ComplexArray) -> ComplexArray:
    """Return w of (1 + G Y) w = w_linear, (2N, nodes), from G, (nodes, 2N, 2N)."""
    count, system = receptance.shape[-1] // 2, np.empty_like(receptance)
    for side in (0, 1):
        here, there = slice(side * count, (side + 1) * count), slice((1 - side) * count, (2 - side) * count)
        own = law[side]
        system[:, :, here] = receptance[:, :, here] * own[:, None, :] + receptance[:, :, there] * law.other[:, None, :]
    system[:, np.arange(2 * count), np.arange(2 * count)] += 1.0
    return np.asarray(np.linalg.solve(system, excited.T[:, :, None])[:, :, 0].T)


def _iterated(
    spread: Spread | Around,
    points: InterfacePoints,
    s: ComplexArray,
    compliance: ComplexArray,
    excited: ComplexArray,
    largest: float,
    *,
    tried: bool,
) -> ComplexArray:
    """Return the same by iteration if it is tried; at nodes where it is not or does not converge, by the matrices of one after another."""
    w, reached = np.empty_like(excited), np.zeros(s.size, dtype=np.bool_)
    if tried:
        w, reached = spread.iterate(s, compliance, excited, largest)
    for k in np.flatnonzero(~reached):
        one = slice(k, k + 1)
        w[:, one] = _dense(points, side_admittance(spread.absorbers, s[one]), compliance[..., one], excited[:, one])
    return w


def _paying(spread: Spread | Around, structure: LinearStructure, blocks: list[slice], excited: ComplexArray, largest: float) -> list[bool]:
    """Return in which blocks of nodes iteration is tried, which one node of several tells."""
    found: list[bool] = []
    for first in range(0, len(blocks), _TOLD):
        middle = blocks[min(first + _TOLD // 2, len(blocks) - 1)].start
        one = slice(middle, middle + 1)
        _, reached = spread.iterate(structure.grid.nodes[one], structure.compliance[..., one], excited[:, one], largest)
        found += [bool(reached.all())] * min(_TOLD, len(blocks) - first)
    return found
