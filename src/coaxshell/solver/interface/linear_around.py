"""Many linear absorbers that differ, solved at each Laplace node by iteration with their admittances as functions of the angle.

As :mod:`coaxshell.solver.interface.linear_many`, with the modes written e^{i m theta}: there D is a multiplication in the angle, D_mm'
depends on m - m' alone,

    D_mm' = 1/(2 pi R) sum_n Y_n e^{-i (m - m') theta_n},

so that it is applied by two FFTs a side, on L > 4 M angles on which no two orders are confused, whatever the angles and number of the
absorbers; what arcs take of each order is counted with C. Its diagonal, the preconditioner, is the mean. Scaled by the roots of the radii,
C_ij and D_ij are symmetric in the surfaces, and in sum_m p_m w_-m in the orders.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
from scipy import fft

from coaxshell.numerics.arrays import ComplexArray, real_product
from coaxshell.numerics.modes import Modes
from coaxshell.solver.interface import linear_many
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, SideAdmittance, side_admittance
from coaxshell.solver.interface.linear_many import Spread, over, precision
from coaxshell.solver.interface.signed_orders import of_parities, signed_orders
from coaxshell.solver.scaling import Problem

_Pairs = list[list[ComplexArray]]
"""Of the surfaces i and j."""


class Around:
    """The absorbers as functions of the angle.

    Parameters
    ----------
    problem : Problem
    absorbers : AbsorberSet
        In both parities; all of them hold arcs of one length on a side.
    modes : Modes
    """

    def __init__(self, problem: Problem, absorbers: AbsorberSet, modes: Modes) -> None:
        lines = replace(absorbers, footprint=None)
        self.absorbers, self._top = absorbers, modes.max_order
        self._lines = Spread(problem, lines, InterfacePoints(problem, lines, modes))
        self._angles, k = int(fft.next_fast_len(4 * self._top + 1)), np.arange(2 * self._top + 1)
        there = np.multiply.outer(2.0 * np.pi / self._angles * np.arange(self._angles), k)
        here = np.multiply.outer(np.radians(absorbers.angle), k)
        twice = np.where(k == 0, 1.0, 2.0)
        self._band = (twice * np.cos(there)) @ np.cos(here).T + (twice * np.sin(there)) @ np.sin(here).T
        self._common = None if absorbers.elements is not None else (self._band @ absorbers.damping, self._band @ absorbers.linear)
        self._orders = np.abs(np.arange(-self._top, self._top + 1))
        self._roots = np.sqrt([surface.radius for surface in problem.surfaces])
        means = None if absorbers.footprint is None else absorbers.means(problem, modes)[:, 0, self._orders]
        self._means = None if means is None else [[means[i] * means[j] for j in (0, 1)] for i in (0, 1)]

    @classmethod
    def of(cls, problem: Problem, absorbers: AbsorberSet, modes: Modes) -> Around | None:
        """Return it where absorbers are carried in both parities and hold arcs of one length on a side, else None."""
        one_kind = absorbers.footprint is None or len(absorbers.held_alike) == 1
        return cls(problem, absorbers, modes) if absorbers.parities == 2 and one_kind else None

    def _fields(self, s: ComplexArray, law: SideAdmittance) -> _Pairs:
        """Return Y_ij/(2 pi sqrt(R_i R_j)) at the angles, (nodes, L), of what the products of two orders see of it."""
        roots = np.sqrt(2.0 * np.pi) * self._roots
        held = self.absorbers.held
        other = self._of_angles(law.other * (held[0] * held[1] / (roots[0] * roots[1])))
        if self._common is None:
            inner, outer = (self._of_angles(law[i] * (held[i] / roots[i] ** 2)) for i in (0, 1))
            return [[inner, other], [other, outer]]
        damping, stiffness = self._common
        own = s[:, None] * damping
        own += stiffness
        inner, outer = (own / root**2 + other * (roots[1 - i] / root) for i, root in enumerate(roots))
        return [[inner, other], [other, outer]]

    def _of_angles(self, values: ComplexArray) -> ComplexArray:
        return np.ascontiguousarray(real_product(self._band, np.ascontiguousarray(values.T)).T)

    def iterate(
        self, s: ComplexArray, compliance: ComplexArray, excited: ComplexArray, largest: float
    ) -> tuple[ComplexArray, npt.NDArray[np.bool_]]:
        """Return the displacements of the points with absorbers, and at which nodes they were reached: see :func:`linear_many.iterate`."""
        law, bare, roots = side_admittance(self.absorbers, s), excited.reshape(2, -1, s.size), self._roots
        fields, width = self._fields(s, law), self._orders.size
        answer = [[np.ascontiguousarray(compliance[i, j][self._orders].T) * (roots[i] / roots[j]) for j in (0, 1)] for i in (0, 1)]
        if self._means is not None:
            answer = [[answer[i][j] * self._means[i][j] for j in (0, 1)] for i in (0, 1)]
        smooth = _preconditioner([[field.mean(axis=1)[:, None] for field in row] for row in fields], answer)
        pressing = self._lines.pressed(law, bare).reshape(2, 2, self._top + 1, -1)
        missing = np.ascontiguousarray(-signed_orders(pressing).transpose(0, 2, 1) * roots[:, None, None])
        moved, towards, motion, there, moves = (np.zeros_like(missing) for _ in range(5))
        scratch, beside = np.empty_like(missing[0]), np.empty((s.size, self._angles), np.complex128)
        pushed = np.empty((2, s.size, self._angles), np.complex128)
        reach = np.sqrt(2.0 * width) / float(roots.min())  # from the root of a sum of squares to at least the sum at any point
        enough, last, done = precision(bare, largest) / reach, np.ones(s.size, np.complex128), np.zeros(s.size, dtype=np.bool_)
        for step in range(linear_many.STEPS):
            _times(smooth, missing, there, scratch)
            _times(answer, there, moves, scratch)
            parts = moves.view(np.float64)
            done = np.sqrt(np.einsum("inm,inm->n", parts, parts)) <= enough
            if done.all():
                break
            product = np.einsum("inm,inm->n", missing, moves[..., ::-1])
            ratio = over(product, last, ~done)[:, None] if step else np.zeros((s.size, 1))
            towards *= ratio
            towards += there
            motion *= ratio
            motion += moves
            last = product
            _times(fields, fft.ifft(motion, self._angles, axis=-1), pushed, beside)
            image = fft.fft(pushed, axis=-1, overwrite_x=True)[..., :width]
            image += towards
            length = over(product, np.einsum("inm,inm->n", image, motion[..., ::-1]), ~done)[:, None]
            moved += np.multiply(motion, length, out=there)
            image *= length
            missing -= image
        orders = of_parities((moved / roots[:, None, None]).transpose(0, 2, 1), 2).reshape(2, -1, s.size)
        return (bare + self._lines.moved(orders)).reshape(excited.shape), done


def _times(matrix: _Pairs, vector: ComplexArray, out: ComplexArray, scratch: ComplexArray) -> None:
    """Put the product of 2 x 2 matrices and vectors (2, nodes, ...) into ``out``."""
    for i in (0, 1):
        np.multiply(matrix[i][0], vector[0], out=out[i])
        out[i] += np.multiply(matrix[i][1], vector[1], out=scratch)


def _preconditioner(mean: _Pairs, answer: _Pairs) -> _Pairs:
    """Return (1 + D C)^{-1} of absorbers spread evenly, whose D is given for every node, (nodes, 1)."""
    a, b, c, d = (mean[i][0] * answer[0][j] + mean[i][1] * answer[1][j] + float(i == j) for i in (0, 1) for j in (0, 1))
    determinant = a * d - b * c
    return [[d / determinant, -b / determinant], [-c / determinant, a / determinant]]
