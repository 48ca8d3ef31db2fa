"""The coupled modal system: shells and fluids at each order m and Laplace node s (theory manual, section "Coupled modal system").

Per shell, with the tangential equation eliminated, Z_i W_i = p_out r_out/R - p_in r_in/R + F_i, r_in and r_out the radii that the fluids
wet; per fluid, wall pressures per wall acceleration. Together an n x n tridiagonal system for the normal displacements of all shells,

    lower_i W_{i-1} + diagonal_i W_i + upper_i W_{i+1} = load_i,

whose inverse is the modal compliance C_m(s).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.operators import annulus
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts


@dataclass
class FluidMatrix:
    """Added mass of all fluids: minus the net inward pressure on each shell per normal acceleration of each, tridiagonal.

    Entries are 0.0 where a vacuum leaves nothing to couple.
    """

    diagonal: list[ComplexArray | float]
    upper: list[ComplexArray | float]
    lower: list[ComplexArray | float]

    @property
    def nbytes(self) -> int:
        """Bytes of all entries."""
        return sum(x.nbytes for row in (self.diagonal, self.upper, self.lower) for x in row if isinstance(x, np.ndarray))


def fluid_matrix(problem: Problem, radial: RadialBasis) -> FluidMatrix:
    """Return the added mass of interior, gaps and exterior.

    Parameters
    ----------
    problem : Problem
    radial : RadialBasis
    """
    count = len(problem.shells)
    matrix = FluidMatrix([0.0] * count, [0.0] * count, [0.0] * count)
    for i, fluid in enumerate(problem.fluids):
        if fluid is None:
            continue
        sides = [j for j in (i - 1, i) if 0 <= j < count]
        walls = [radial(fluid.slowness, problem.shells[j].wetted[int(j < i)]) for j in sides]
        density = [fluid.density * fluid.wall_motion_factor(j, radial) for j in sides]
        load = [problem.shells[j].leverage[int(j < i)] for j in sides]
        if i == 0:
            matrix.diagonal[0] = matrix.diagonal[0] + density[0] * load[0] * walls[0].disc
        elif i == count:
            matrix.diagonal[-1] = matrix.diagonal[-1] - density[0] * load[0] * walls[0].exterior
        else:
            gap = annulus(*walls)
            matrix.diagonal[i - 1] = matrix.diagonal[i - 1] - density[0] * load[0] * gap.aa
            matrix.diagonal[i] = matrix.diagonal[i] + density[1] * load[1] * gap.bb
            matrix.upper[i - 1], matrix.lower[i] = -density[1] * load[0] * gap.ab, density[0] * load[1] * gap.ba
    return matrix


class ModalSystem:
    """The factored tridiagonal system of all shells at some orders and a block of Laplace nodes.

    Parameters
    ----------
    problem : Problem
    s : ndarray, shape (nodes,)
    modes : Modes
    radial : RadialBasis, optional
        Bessel ratios at these nodes, if known.
    shared : SharedParts, optional
        Where the added mass of the fluids is found, or left for the next one.

    Attributes
    ----------
    radial : RadialBasis
        Bessel ratios of the fluids, reused by the incident wave.
    shells : list of WallOperator
    """

    def __init__(
        self, problem: Problem, s: ComplexArray, modes: Modes, radial: RadialBasis | None = None, shared: SharedParts | None = None
    ) -> None:
        self.problem, self.s, self.modes, self._shared = problem, s, modes, shared
        self.radial = RadialBasis(modes, s) if radial is None else radial
        self.shells = [wall.operator(modes, s) for wall in problem.shells]
        self._assemble()
        self._factor()

    @property
    def _shape(self) -> tuple[int, int]:
        return self.modes.count, self.s.size

    def _fluids(self) -> FluidMatrix:
        """Return the added mass, shared where only fluids, radii, modes and nodes determine it."""
        problem = self.problem
        if self._shared is None:
            return fluid_matrix(problem, self.radial)
        key = ("fluids", problem.fluids, tuple((shell.radius, shell.wetted) for shell in problem.shells), self.modes.key, self.s.tobytes())
        fluids: FluidMatrix = self._shared.get_or_make(key, lambda: fluid_matrix(problem, self.radial))
        return fluids

    def _assemble(self) -> None:
        """Add shells and fluids; a rigid shell keeps a row of its own, W = 0, and couples to none."""
        s2, fluids, free = self.s * self.s, self._fluids(), [wall.moves for wall in self.problem.shells]
        self._diagonal = [
            wall.impedance + s2 * fluids.diagonal[i] if free[i] else np.ones(self._shape, np.complex128)
            for i, wall in enumerate(self.shells)
        ]
        self._upper = [s2 * x if free[i] and i + 1 < len(free) and free[i + 1] else 0.0 for i, x in enumerate(fluids.upper)]
        self._lower = [s2 * x if free[i] and i > 0 and free[i - 1] else 0.0 for i, x in enumerate(fluids.lower)]

    def _factor(self) -> None:
        """Eliminate from the inside out; keep 1/pivot, and what passes inward and outward."""
        self._inverse_pivot: list[ComplexArray] = []
        self._inward: list[ComplexArray | float] = []  # W_i gains -inward_i W_{i+1}
        self._outward: list[ComplexArray | float] = [0.0]  # load_i gains -outward_i load_{i-1}
        for i, diagonal in enumerate(self._diagonal):
            if i > 0:
                diagonal = diagonal - self._lower[i] * self._inward[i - 1]
                self._outward.append(self._lower[i] * self._inverse_pivot[i - 1])
            self._inverse_pivot.append(np.reciprocal(diagonal))
            self._inward.append(self._upper[i] * self._inverse_pivot[i])

    def solve(self, index: int, load: ComplexArray | float) -> list[ComplexArray]:
        """Return W of every shell under a normal load (positive inward) on shell ``index`` alone."""
        if not self.problem.shells[index].moves:
            return [np.zeros(self._shape, np.complex128) for _ in self.shells]
        count = len(self.shells)
        loads: list[ComplexArray | float] = [0.0] * count
        loads[index] = load
        for i in range(index + 1, count):
            loads[i] = -self._outward[i] * loads[i - 1]
        answer: list[ComplexArray] = [np.zeros(0, np.complex128)] * count
        for i in reversed(range(count)):
            answer[i] = loads[i] * self._inverse_pivot[i]
            if i + 1 < count:
                answer[i] = answer[i] - self._inward[i] * answer[i + 1]
        return answer

    def compliance(self) -> ComplexArray:
        """Return C_ij, W of shell i per normal load on shell j, shape (shells, shells, orders, nodes)."""
        return np.stack([np.stack(self.solve(j, 1.0)) for j in range(len(self.shells))], axis=1)

    def solve_outside(self, pressure: ComplexArray) -> list[ComplexArray]:
        """Return W of every shell under a pressure on the surface that the exterior fluid wets: r_out/R of it loads the outermost shell."""
        last = len(self.shells) - 1
        leverage = self.problem.shells[last].leverage[1]
        return self.solve(last, pressure if leverage == 1.0 else leverage * pressure)

    @property
    def diagonal(self) -> list[ComplexArray]:
        """Diagonal of the tridiagonal system of the shells: stiffness and own added mass, one entry a shell, each (orders, nodes)."""
        return self._diagonal

    def beside(self, index: int) -> tuple[ComplexArray | float, ComplexArray | float]:
        """Return upper_i and lower_{i+1}, by which a shell and the next one outward load each other."""
        return self._upper[index], self._lower[index + 1]

    @property
    def coupling(self) -> list[ComplexArray | float]:
        """Products lower_i upper_{i-1} of the off-diagonals, i = 1 onwards: what neighbouring shells do to the determinant."""
        return [self._lower[i] * self._upper[i - 1] for i in range(1, len(self.shells))]

    def determinant(self) -> ComplexArray:
        """Return the determinant of the tridiagonal system, shape (orders, nodes): zero at the poles of the response."""
        return determinant(self.diagonal, self.coupling)

    def tangential(self, normal: list[ComplexArray]) -> list[ComplexArray]:
        """Return V of every shell from W of every shell (no tangential load)."""
        return [wall.tangential * w for wall, w in zip(self.shells, normal, strict=True)]

    def axial(self, normal: list[ComplexArray]) -> list[ComplexArray]:
        """Return U of every shell from W of every shell (no axial load)."""
        return [np.zeros_like(w) if wall.axial is None else wall.axial * w for wall, w in zip(self.shells, normal, strict=True)]


def determinant(diagonal: Sequence[ComplexArray], coupling: Sequence[ComplexArray | float]) -> ComplexArray:
    """Return the determinant of a tridiagonal matrix by its three-term recursion."""
    before: ComplexArray | float = 1.0
    present = diagonal[0]
    for entry, product in zip(diagonal[1:], coupling, strict=True):
        before, present = present, entry * present - product * before
    return present
