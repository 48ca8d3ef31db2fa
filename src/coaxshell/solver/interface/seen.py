"""A structure as a march of absorbers sees it: by as few kernels as tell how their points move each other.

Kernels between points are sums over the orders, K(a, b) = sum_m k_m cos m(theta_a - theta_b)/(beta_m pi R). Where the forces are wanted
first and the motion of all orders afterwards, from the transforms of the forces, fewer channels than orders can be marched:

- absorbers on a lattice of N places, rings among them, have N/2 + 1 classes of orders whose kernels are added up beforehand
  (:mod:`coaxshell.solver.interface.lattice`); what footprints take of each order is in the sum;
- few absorbers have one kernel for each pair of their points.

Both are added up as spectra, before anything is inverted.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.convolution import KernelTable
from coaxshell.numerics.threads import map_on_threads
from coaxshell.solver.faced_forces import combined_march_weights
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, PointsAlone
from coaxshell.solver.interface.lattice import channels, folding
from coaxshell.solver.kernels import combined_velocity_weights
from coaxshell.solver.quadrature import trapezoidal_weights, unresolved_orders
from coaxshell.solver.structure_spectra import StructureSpectra

_KEPT = 8
"""Lattices whose kernels are kept."""

Shares = Callable[[int, int], FloatArray]
"""From the numbers of a surface and of one that is pressed to the shares (rows, M + 1) of the orders in each kernel between them."""


class SeenStructure(StructureSpectra):
    """A structure at the points of some absorbers, without its orders.

    Parameters
    ----------
    whole : StructureSpectra
    absorbers : AbsorberSet
    """

    def __init__(self, whole: StructureSpectra, absorbers: AbsorberSet) -> None:
        super().__init__(whole.problem, whole.grid, whole.modes, shared=whole.shared, units=whole.units)
        self.whole, self.absorbers = whole, absorbers
        self.of_orders = InterfacePoints(whole.problem, absorbers, whole.modes)

    def motion_at(self, points: InterfacePoints | PointsAlone) -> tuple[FloatArray, FloatArray]:
        """Return displacements and velocities of the points under the sources alone, (points, T) each."""
        return self._motion

    @cached_property
    def _motion(self) -> tuple[FloatArray, FloatArray]:
        moved = self.of_orders.evaluate(self.whole.surface_motion)
        return self.grid.invert(moved), self.grid.invert(moved * self.grid.nodes)

    def _weights(self, shares: Shares) -> dict[tuple[int, int], FloatArray]:
        """Return the step weights (rows, T) of sums over the orders, for all pairs of surfaces that absorbers hold.

        By product integration; of orders whose membrane the step does not resolve, and where walls have two faces, by the weights of the
        orders themselves.
        """
        whole, problem, grid = self.whole, self.problem, self.grid
        held = np.unique(self.of_orders.surface).tolist()
        pairs = [(i, j) for i in held for j in held]
        if problem.two_faced:
            return self._faced_weights({(i, j): shares(i, j) for i, j in pairs})
        late = unresolved_orders(problem, grid, whole.modes)
        compliance = whole.compliance

        def combined(pair: tuple[int, int]) -> FloatArray:
            return combined_velocity_weights(problem, grid, compliance[pair], pair, np.where(late, 0.0, shares(*pair)))

        found = dict(zip(pairs, map_on_threads(combined, pairs), strict=True))
        if late.any():
            late_weights, _ = trapezoidal_weights(problem, grid, Modes(whole.modes.orders[late]), [])
            for i, j in pairs:
                found[i, j] += shares(i, j)[:, late] @ late_weights[i, j]
        return found

    def _faced_weights(self, shares: dict[tuple[int, int], FloatArray]) -> dict[tuple[int, int], FloatArray]:
        """Return the same where walls have two faces: of the first absorbers by sums alone, of others by the kernels that all share."""
        whole, fewer = self.whole, sum(len(rows) for rows in shares.values()) < len(shares) * self.modes.count
        if whole.units.kernels is None and fewer and not whole.units.marched:
            whole.units.marched = True
            return combined_march_weights(self.problem, self.grid, self.modes, shares)
        return {pair: rows @ whole.kernels.kernels[pair] for pair, rows in shares.items()}


class StructureOfClasses(SeenStructure):
    """A structure as absorbers on a lattice see it, all of which hold the same arcs: orders added up by classes.

    Parameters
    ----------
    whole : StructureSpectra
    absorbers : AbsorberSet
    lattice : int
        Places of the lattice.
    """

    def __init__(self, whole: StructureSpectra, absorbers: AbsorberSet, lattice: int) -> None:
        super().__init__(whole, absorbers)
        self._lattice = lattice

    def points(self, absorbers: AbsorberSet) -> InterfacePoints:
        """Return the points in terms of the classes; footprints are in the kernels."""
        return InterfacePoints(self.problem, replace(absorbers, footprint=None), Modes.up_to(self._lattice // 2))

    @property
    def kernels(self) -> KernelTable:
        """Step weights of the velocities of each class of orders, (surfaces, surfaces, classes, T)."""
        means = None if self.absorbers.footprint is None else self.absorbers.means(self.problem, self.modes)[:, 0]
        held = tuple(np.unique(self.of_orders.surface).tolist())  # no others have kernels
        known, key = self.units.classes, (self._lattice, held, *(() if means is None else (self._held_by_side, means.tobytes())))
        if key not in known:
            while len(known) >= _KEPT:
                known.pop(next(iter(known)))
            known[key] = KernelTable(self._folded(means))
        return known[key]

    @property
    def _held_by_side(self) -> tuple[int, ...]:
        return tuple(int(x) for x in self.absorbers.surfaces[:, 0])

    def _folded(self, means: FloatArray | None) -> FloatArray:
        shares, count = folding(self._lattice, self.modes.max_order), len(self.problem.surfaces)
        held = np.ones((count, self.modes.count))
        if means is not None:
            held[list(self._held_by_side)] = means
        weights = self._weights(lambda i, j: shares * (held[i] * held[j]))
        found = np.zeros((count, count, len(shares), self.grid.time.size))
        for pair, values in weights.items():
            found[pair] = values
        return found


class StructureOfPoints(SeenStructure):
    """A structure as few absorbers see it: one kernel for each pair of their points."""

    def points(self, absorbers: AbsorberSet) -> PointsAlone:
        """Return the points, each by itself."""
        return PointsAlone(absorbers)

    @cached_property
    def kernels(self) -> KernelTable:
        """Step weights of the velocities of the points, (points, points, 1, T)."""
        points = self.of_orders
        weights = self._weights(points.shares_of_pairs)
        found = np.zeros((points.count, points.count, 1, self.grid.time.size))
        for (i, j), between in weights.items():
            rows, columns = points.on_surface(i), points.on_surface(j)
            found[rows[:, None], columns, 0] = between.reshape(rows.size, columns.size, -1)
        return KernelTable(found)


def as_seen(structure: StructureSpectra, absorbers: AbsorberSet) -> StructureSpectra:
    """Return a structure as a march of some absorbers sees it by the fewest kernels: the structure itself where its orders are fewest."""
    if not absorbers.count:
        return structure
    way = channels(structure.problem, absorbers, structure.modes.max_order)
    if way.alone:
        return StructureOfPoints(structure, absorbers)
    return StructureOfClasses(structure, absorbers, way.lattice) if way.lattice else structure
