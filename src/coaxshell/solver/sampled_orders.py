"""The structure at a sample of circumferential orders and Laplace nodes: what sources and absorbers excite there.

The orders above M are not extrapolated: a sample of them is solved. That matters because modal stress need not decay steadily: near the
order R sqrt(a22/d22), where a shell's membrane and bending frequencies cross (m = 284 for the paper's shells), it rises again
before it falls.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.interface.absorbers import AbsorberSet, admittance
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import MAX_MODES
from coaxshell.solver.shared_parts import SharedParts
from coaxshell.solver.solid_spectra import FacedSystem, band

NODES = slice(0, None, 16)
"""Every sixteenth node: poles are at least sigma from the contour; sums over nodes 4 sigma apart err by half for one such pole, by less
for the many poles of many orders."""
_SAMPLE = 20


def crossing_order(problem: Problem) -> float:
    """Return the largest order R sqrt(a22/d22) at which a shell's membrane and bending frequencies cross."""
    return max(wall.crossing_order for wall in problem.shells)


def orders_above(problem: Problem, first: int) -> FloatArray:
    """Return about 20 orders from ``first`` to well above four times it and the crossing order, geometrically spaced."""
    top = min(2 * MAX_MODES, int(max(4 * first, 2.2 * crossing_order(problem), first + 32)))
    return np.unique(np.geomspace(first, top, _SAMPLE).round())


def standing_for(orders: FloatArray) -> FloatArray:
    """Return how many orders from the first to the last each of an ascending sample stands for, by the trapezoidal rule."""
    gaps = np.diff(orders)
    weight: FloatArray = 0.5 * (np.append(gaps, 1.0) + np.insert(gaps, 0, 1.0))
    return weight


def _weights(orders: FloatArray) -> FloatArray:
    """Return how many orders each of a sample stands for, with those above the last."""
    weight = standing_for(orders)
    weight[-1] += 0.5 * orders[-1]
    return weight


@dataclass(frozen=True)
class SampledOrders:
    """Responses of some orders at every sixteenth node of a grid.

    Attributes
    ----------
    problem : Problem
    orders, weight : ndarray, shape (orders,)
        The orders, and how many each stands for.
    nodes : ndarray, shape (nodes,)
    excited : ndarray, shape (shells, orders, nodes)
        |W|^2 under the sources, both parities together.
    strain : ndarray, shape (shells, orders, nodes)
        |m V/W - 1|^2: the strain's share of |W|^2.
    modal : ModalSystem or None
        None where faces of walls move differently: nothing but the sources acts there.
    """

    problem: Problem
    orders: FloatArray
    weight: FloatArray
    nodes: ComplexArray
    excited: FloatArray
    strain: FloatArray
    modal: ModalSystem | None

    @classmethod
    def of(cls, problem: Problem, grid: LaplaceGrid, orders: FloatArray, shared: SharedParts | None = None) -> SampledOrders:
        """Solve a problem at some ascending orders."""
        count, nodes = len(problem.shells), grid.nodes[NODES]
        modes = Modes(orders, sparse=True)
        if problem.two_faced:
            return cls._of_faces(problem.resolving(band(grid)), grid, modes, shared)
        modal = ModalSystem(problem, nodes, modes, shared=shared)
        excited = np.zeros((count, orders.size, nodes.size))
        for load in SurfaceLoads(problem, grid.sparser(NODES.step), modes, shared)(modal.radial, slice(0, nodes.size)):
            excited += np.abs(np.stack(modal.solve_outside(load))) ** 2
        strain = [np.abs(orders[:, None] * wall.tangential - 1.0) ** 2 for wall in modal.shells]
        return cls(problem, orders, _weights(orders), nodes, excited, np.stack(strain), modal)

    @classmethod
    def _of_faces(cls, problem: Problem, grid: LaplaceGrid, modes: Modes, shared: SharedParts | None) -> SampledOrders:
        """Solve a problem some of whose walls have two faces; one answer has the V/W of all, as all sources press on the same face."""
        nodes = grid.nodes[NODES]
        system = FacedSystem(problem, nodes, modes)
        answers = [
            system.under_sources(load)
            for load in SurfaceLoads(problem, grid.sparser(NODES.step), modes, shared)(system.radial, slice(0, nodes.size))
        ]
        excited = np.sum([[np.abs(wall.normal) ** 2 for wall in walls] for walls in answers], axis=0)
        strained = np.sum([[np.abs(modes.column * wall.tangential - wall.normal) ** 2 for wall in walls] for walls in answers], axis=0)
        strain = np.divide(strained, excited, out=np.zeros_like(strained), where=excited > 0)
        return cls(problem, modes.orders, _weights(modes.orders), nodes, excited, strain, None)

    @cached_property
    def compliance(self) -> ComplexArray:
        """C_ij, shape (shells, shells, orders, nodes): W of shell i per modal pressure on shell j."""
        assert self.modal is not None
        return np.stack([np.stack(self.modal.solve(j, 1.0)) for j in range(len(self.problem.shells))], axis=1)

    def norms(self, squares: FloatArray) -> FloatArray:
        """Return the mean squares over the surface of displacement and strain, summed over the nodes, of each order.

        Parameters
        ----------
        squares : ndarray, shape (shells, orders, nodes)
            |W|^2, both parities together.

        Returns
        -------
        ndarray, shape (shells, 2, orders)
        """
        share = np.where(self.orders == 0, 1.0, 0.5)
        return np.stack([squares.sum(axis=-1), (squares * self.strain).sum(axis=-1)], axis=1) * share

    def forced(self, density: ComplexArray) -> FloatArray:
        """Return |W|^2 of every shell and order under point forces, shape (shells, orders, nodes).

        Parameters
        ----------
        density : ndarray, shape (shells, shells, nodes)
            sum_n f_n,j conj(f_n,k) of the line forces on shells j and k: cos^2 and sin^2 of m theta_n add to 1, and products of
            different absorbers' forces cancel over the orders.
        """
        radius = np.pi * np.array([shell.radius for shell in self.problem.shells])
        moved = np.einsum("ijmk,jlk->ilmk", self.compliance / radius[:, None, None], density)
        squares = np.einsum("ilmk,ilmk->imk", moved, np.conj(self.compliance) / radius[:, None, None])
        return np.asarray(squares.real, dtype=np.float64)

    def mobility(self, above: int = -1) -> ComplexArray:
        """Return the displacement at a point of shell i per line force at the same angle of shell j, shape (shells, shells, nodes).

        Of the orders above one alone if it is given.
        """
        share = np.where(self.orders > above, self.weight, 0.0) * np.where(self.orders == 0, 0.5, 1.0)
        return mobility_of(self.problem, self.compliance, share)

    def motion(self, above: int = -1) -> FloatArray:
        """Return the mean square of the motion of a point of every shell under the sources, shape (shells, nodes).

        Of the orders above one alone if it is given.
        """
        share = np.where(self.orders > above, self.weight, 0.0) * np.where(self.orders == 0, 1.0, 0.5)
        return np.asarray(np.einsum("imk,m->ik", self.excited, share))


def force_density(problem: Problem, links: AbsorberSet, force: ComplexArray) -> ComplexArray:
    """Return sum_n f_n,j conj(f_n,k) on shells j, k, shape (shells, shells, nodes), from line forces (2, N, nodes)."""
    density = np.zeros((len(problem.shells), len(problem.shells), force.shape[-1]), np.complex128)
    for inner in np.unique(links.inner_shell):
        members = links.inner_shell == inner
        pair, sides = slice(inner, inner + 2), force[:, members]
        density[pair, pair] += np.einsum("ank,bnk,n->abk", sides, np.conj(sides), links.multiplicity[members])
    return density


def mobility_of(problem: Problem, compliance: ComplexArray, share: FloatArray) -> ComplexArray:
    """Return the displacement at a point of shell i per line force at the same angle of shell j, shape (shells, shells, nodes).

    Parameters
    ----------
    problem : Problem
    compliance : ndarray, shape (shells, shells, orders, nodes)
    share : ndarray, shape (orders,)
        How many orders each stands for, half of that for order 0.
    """
    radius = np.pi * np.array([shell.radius for shell in problem.shells])
    return np.asarray(np.einsum("ijmk,m->ijk", compliance, share) / radius[:, None])


def each_alone(links: AbsorberSet, nodes: ComplexArray, mobility: ComplexArray, motion: ComplexArray) -> ComplexArray:
    """Return the forces (2, N, nodes) of absorbers that do not feel each other on walls that would move by ``motion`` (2, N, nodes).

    ``mobility`` is that of :meth:`SampledOrders.mobility`.
    """
    own, other, _ = (x.T for x in admittance(links, nodes))
    force = np.empty(motion.shape, np.complex128)
    for n, inner in enumerate(links.inner_shell):
        (g00, g01), (g10, g11) = mobility[inner : inner + 2, inner : inner + 2]
        a, b = 1.0 + g00 * own[n] + g01 * other[n], g00 * other[n] + g01 * own[n]
        c, d = g10 * own[n] + g11 * other[n], 1.0 + g10 * other[n] + g11 * own[n]
        determinant = a * d - b * c
        here, there = (d * motion[0, n] - b * motion[1, n]) / determinant, (a * motion[1, n] - c * motion[0, n]) / determinant
        force[0, n], force[1, n] = -(own[n] * here + other[n] * there), -(other[n] * here + own[n] * there)
    return force
