"""The structure at a sample of circumferential orders and Laplace nodes: what sources and absorbers excite there.

The orders above M are not extrapolated: a sample of them is solved. That matters because modal stress need not decay steadily: near the
order R sqrt(a22/d22), where a shell's membrane and bending frequencies cross (m = 284 for the paper's shells), it rises again
before it falls.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.coupling import ModalSystem
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.faced_forces import surfaces_of
from coaxshell.solver.interface.absorbers import AbsorberSet, side_admittance
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
        None where faces of walls move differently.
    faced : FacedSystem or None
        Where they do.
    surface_excited : ndarray, shape (surfaces, orders, nodes)
        The same of the surfaces on which links act.
    """

    problem: Problem
    orders: FloatArray
    weight: FloatArray
    nodes: ComplexArray
    excited: FloatArray
    strain: FloatArray
    modal: ModalSystem | None
    faced: FacedSystem | None
    surface_excited: FloatArray

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
        return cls(problem, orders, _weights(orders), nodes, excited, np.stack(strain), modal, None, excited)

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
        held = np.sum([np.abs(surfaces_of(problem, walls)) ** 2 for walls in answers], axis=0)
        strained = np.sum([[np.abs(modes.column * wall.tangential - wall.normal) ** 2 for wall in walls] for walls in answers], axis=0)
        strain = np.divide(strained, excited, out=np.zeros_like(strained), where=excited > 0)
        return cls(problem, modes.orders, _weights(modes.orders), nodes, excited, strain, None, system, held)

    @cached_property
    def _answers(self) -> tuple[ComplexArray, ComplexArray]:
        """Displacements of the surfaces and W of the walls per modal pressure on each surface, (rows, surfaces, orders, nodes)."""
        if self.modal is not None:
            found = np.stack([np.stack(self.modal.solve(j, 1.0)) for j in range(len(self.problem.shells))], axis=1)
            return found, found
        assert self.faced is not None
        answers = [self.faced.under_force(surface, 1.0) for surface in self.problem.surfaces]
        moved = [surfaces_of(self.problem, walls) for walls in answers]
        return np.stack(moved, axis=1), np.stack([np.stack([wall.normal for wall in walls]) for walls in answers], axis=1)

    @property
    def compliance(self) -> ComplexArray:
        """C_ij, shape (surfaces, surfaces, orders, nodes): displacement of surface i per modal pressure on surface j."""
        return self._answers[0]

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

    def forced(self, links: AbsorberSet, force: ComplexArray) -> FloatArray:
        """Return |W|^2 of every shell and order under the forces (2, N, nodes) of some absorbers, shape (shells, orders, nodes)."""
        if links.footprint is None:
            return self._forced(force_density(self.problem, links, force))
        means = links.means(self.problem, self._modes)
        parts = [
            self._forced(force_density(self.problem, links, force, members), _by_surface(self.problem, links, members, means))
            for members in links.held_alike
        ]
        return np.asarray(np.sum(parts, axis=0), dtype=np.float64)

    def _forced(self, density: ComplexArray, means: FloatArray | None = None) -> FloatArray:
        """Return |W|^2 under point forces.

        Parameters
        ----------
        density : ndarray, shape (surfaces, surfaces, nodes)
            sum_n f_n,j conj(f_n,k) of the line forces on surfaces j and k: cos^2 and sin^2 of m theta_n add to 1, and products of
            different absorbers' forces cancel over the orders.
        means : ndarray, shape (surfaces, orders), or None
            h_m of these forces, 1 unless given.
        """
        radius = np.pi * np.array([surface.radius for surface in self.problem.surfaces])
        per_force = self._answers[1] / radius[:, None, None]
        if means is not None:
            per_force = per_force * means[:, :, None]
        moved = np.einsum("ijmk,jlk->ilmk", per_force, density)
        squares = np.einsum("ilmk,ilmk->imk", moved, np.conj(per_force))
        return np.asarray(squares.real, dtype=np.float64)

    @property
    def _modes(self) -> Modes:
        return Modes(self.orders, sparse=True)

    def mobility(self, links: AbsorberSet, above: int = -1) -> ComplexArray:
        """Return the displacement where each absorber holds surface a per line force where it holds b, shape (2, 2, N, nodes).

        Of the orders above one alone if it is given.
        """
        share = np.where(self.orders > above, self.weight, 0.0) * np.where(self.orders == 0, 0.5, 1.0)
        return mobility_at(self.problem, links, self._modes, self.compliance, share)

    def motion(self, links: AbsorberSet, above: int = -1) -> FloatArray:
        """Return the mean square of the motion under the sources where each absorber holds its surfaces, shape (2, N, nodes).

        Of the orders above one alone if it is given.
        """
        share = np.where(self.orders > above, self.weight, 0.0) * np.where(self.orders == 0, 1.0, 0.5)
        if links.footprint is None:
            found = np.asarray(np.einsum("imk,m->ik", self.surface_excited, share)[links.surfaces])
            return found if links.elements is None else found * links.held[:, :, None]
        weight = links.means(self.problem, self._modes) ** 2 * share
        found = np.empty((2, links.count, self.nodes.size))
        for side in (0, 1):
            for members in links.held_alike:
                first = members[0]
                found[side, members] = weight[side, first] @ self.surface_excited[links.surfaces[side, first]]
        return found * links.held[:, :, None]


def _by_surface(problem: Problem, links: AbsorberSet, members: npt.NDArray[np.int64], means: FloatArray) -> FloatArray:
    """Return h_m by surface, shape (surfaces, orders), of absorbers that hold the same surfaces alike; 1 where they hold none."""
    found = np.ones((len(problem.surfaces), means.shape[-1]))
    found[links.surfaces[:, members[0]]] = means[:, members[0]]
    return found


def force_density(problem: Problem, links: AbsorberSet, force: ComplexArray, members: npt.NDArray[np.int64] | None = None) -> ComplexArray:
    """Return sum_n f_n,j conj(f_n,k) on surfaces j, k, shape (surfaces, surfaces, nodes), from line forces (2, N, nodes).

    Of some absorbers alone if ``members`` gives their numbers.
    """
    count = len(problem.surfaces)
    density, inner = np.zeros((count, count, force.shape[-1]), np.complex128), links.surfaces[0]
    some = np.ones(links.count, dtype=bool) if members is None else np.isin(np.arange(links.count), members)
    for first in np.unique(inner[some]):
        here = (inner == first) & some
        sides = force[:, here] if links.elements is None else force[:, here] * links.held[:, here, None]
        both = np.einsum("ank,bnk,n->abk", sides, np.conj(sides), links.multiplicity[here])
        of_sides = links.surfaces[:, np.argmax(here)]
        for a in (0, 1):
            for b in (0, 1):
                density[of_sides[a], of_sides[b]] += both[a, b]
    return density


def mobility_of(problem: Problem, compliance: ComplexArray, share: FloatArray) -> ComplexArray:
    """Return the displacement at a point of surface i per line force at the same angle of surface j, (surfaces, surfaces, nodes).

    Parameters
    ----------
    problem : Problem
    compliance : ndarray, shape (surfaces, surfaces, orders, nodes)
    share : ndarray, shape (orders,)
        How many orders each stands for, half of that for order 0.
    """
    radius = np.pi * np.array([surface.radius for surface in problem.surfaces])
    return np.asarray(np.einsum("ijmk,m->ijk", compliance, share) / radius[:, None])


def mobility_at(problem: Problem, links: AbsorberSet, modes: Modes, compliance: ComplexArray, share: FloatArray) -> ComplexArray:
    """Return the displacement where each absorber holds surface a per line force where it holds b, shape (2, 2, N, nodes).

    ``share`` as in :func:`mobility_of`; a footprint weighs it by h_m of both.
    """
    between = links.held[:, None] * links.held
    if links.footprint is None:
        found = mobility_of(problem, compliance, share)[links.surfaces[:, None], links.surfaces]
        return found if links.elements is None else found * between[..., None]
    means = links.means(problem, modes)
    found = np.empty((2, 2, links.count, compliance.shape[-1]), np.complex128)
    for members in links.held_alike:
        held = _by_surface(problem, links, members, means)
        weighed = compliance * (held[:, None] * held)[..., None]
        surfaces = links.surfaces[:, members[0]]
        found[:, :, members] = mobility_of(problem, weighed, share)[surfaces[:, None], surfaces][:, :, None]
    return found * between[..., None]


def each_alone(links: AbsorberSet, nodes: ComplexArray, mobility: ComplexArray, motion: ComplexArray) -> ComplexArray:
    """Return the forces (2, N, nodes) of absorbers that do not feel each other on walls that would move by ``motion`` (2, N, nodes).

    ``mobility`` is that of :func:`mobility_at`.
    """
    inner, outer, other = (x.T for x in side_admittance(links, nodes)[:3])
    force = np.empty(motion.shape, np.complex128)
    for n in range(links.count):
        (g00, g01), (g10, g11) = mobility[:, :, n]
        a, b = 1.0 + g00 * inner[n] + g01 * other[n], g00 * other[n] + g01 * outer[n]
        c, d = g10 * inner[n] + g11 * other[n], 1.0 + g10 * other[n] + g11 * outer[n]
        determinant = a * d - b * c
        here, there = (d * motion[0, n] - b * motion[1, n]) / determinant, (a * motion[1, n] - c * motion[0, n]) / determinant
        force[0, n], force[1, n] = -(inner[n] * here + other[n] * there), -(other[n] * here + outer[n] * there)
    return force
