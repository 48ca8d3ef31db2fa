"""The loops of feedback by electrodes, closed in the Laplace domain (theory manual, "Segments").

In each pattern q (:mod:`coaxshell.solver.electrode_patterns`) the walls under control have one loop,

    phi_q = phi0_q + C_q u_q,      u_q = H_q K phi_q,      C_q = sum_m R_qm C_m L_mq,

C_m what they read in order m per volt of order m without feedback, so that u_q = (1 - H K C_q)^-1 H K phi0_q, as many equations as walls.
K says by how much each wall answers the reading of each, 1 where every wall answers its own.
Dead segments tie all patterns: they are those on which further voltages e, of which no loop knows, leave nothing,

    u_q = (1 - H K C_q)^-1 (H K phi0_q + e_q),      u = 0 on every dead segment.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.solver.electrode_patterns import Patterns
from coaxshell.solver.scaling import Problem
from coaxshell.solver.voltage_response import VoltageResponse, gains_of_wall


@dataclass(frozen=True, eq=False)
class ElectrodeLoops:
    """The loops of all patterns at some nodes.

    Attributes
    ----------
    patterns : Patterns
    law : ndarray, shape (walls, patterns, nodes)
        H.
    matrix : ndarray, shape (patterns, nodes, walls, walls)
        1 - H K C_q.
    shares : ndarray, shape (walls, walls)
        K.
    """

    patterns: Patterns
    law: ComplexArray
    matrix: ComplexArray
    shares: FloatArray

    @classmethod
    def of(cls, problem: Problem, response: VoltageResponse, patterns: Patterns, s: ComplexArray) -> ElectrodeLoops:
        """Return the loops with the feedback of a problem."""
        numbers, count = patterns.numbers, len(response.shells)
        laws = [gains_of_wall(problem, i).at(s, numbers) for i in response.shells]
        law = np.stack([np.broadcast_to(one, (numbers.count, s.size)) for one in laws])
        matrix = np.empty((numbers.count, s.size, count, count), np.complex128)
        shares, answered = shares_of(problem, response.shells), patterns.responses(response.read)
        for a in range(count):
            for b in range(count):
                read = sum(shares[a, c] * answered[c, b] for c in range(count) if shares[a, c])
                matrix[..., a, b] = float(a == b) - law[a] * read
        return cls(patterns, law, matrix, shares)

    @cached_property
    def inverse(self) -> ComplexArray:
        """(1 - H K C_q)^-1, shape (patterns, nodes, walls, walls)."""
        return np.asarray(np.linalg.inv(self.matrix), dtype=np.complex128)

    def asked(self, readings: ComplexArray) -> ComplexArray:
        """Return u_q, (walls, patterns, nodes), from what is read of the motion without voltages; dead segments as if they were alive."""
        return times(self.inverse, self._without_answers(readings))

    def _without_answers(self, readings: ComplexArray) -> ComplexArray:
        """Return H K phi0_q."""
        return np.asarray(self.law * np.einsum("ij,jqk->iqk", self.shares, readings))

    def voltages(self, readings: ComplexArray) -> ComplexArray:
        """Return u_q with dead segments at ground."""
        return self.given(self._without_answers(readings))

    def given(self, further: ComplexArray) -> ComplexArray:
        """Return u_q under voltages of which no loop knows, (walls, patterns, nodes), with dead segments at ground."""
        inverse, dead = self.inverse, list(self.patterns.dead)
        found = times(inverse, further)
        if not dead:
            return found
        left = np.einsum("dq,iqk->kid", self.patterns.evaluate[dead], found)
        held = -np.linalg.solve(self.between_dead(inverse), left.reshape(len(left), -1, 1)).reshape(left.shape)
        return found + times(inverse, np.einsum("qd,kid->iqk", self.patterns.project[:, dead], held))

    def between_dead(self, inverse: ComplexArray) -> ComplexArray:
        """Return the voltage on each dead segment per further volt on each, shape (nodes, n, n), n the dead segments of all walls."""
        found = self.between(list(self.patterns.dead), inverse)
        size = found.shape[1] * found.shape[2]
        return np.asarray(found.reshape(len(found), size, size))

    def between(self, points: list[int], inverse: ComplexArray) -> ComplexArray:
        """Return the voltage on some points per further volt on each, (nodes, walls, points, walls, points), dead ones as if alive."""
        held, amplitudes = self.patterns.evaluate[points], self.patterns.project[:, points]
        return np.asarray(np.einsum("dq,qkij,qe->kidje", held, inverse, amplitudes, optimize=True))

    def factors(self) -> ComplexArray:
        """Return |1 - H K C_q|, (patterns, nodes), and where dead segments tie the patterns one row more, whose product is that of all.

        Of the loops of live ones alone it is the product over patterns times |(1 - H K C)^-1| on dead segments, the complementary minor.
        """
        each = determinant_of(self.matrix)
        if not self.patterns.dead:
            return np.asarray(each)
        return np.concatenate([each, np.linalg.det(self.between_dead(self.inverse))[None]])

    def determinants(self) -> ComplexArray:
        """Return |1 - H K C_q|, (patterns, nodes); where dead segments tie the patterns that of all together, (1, nodes)."""
        each = self.factors()
        return each.prod(axis=0, keepdims=True) if self.patterns.dead else each


def determinant_of(matrix: ComplexArray) -> ComplexArray:
    """Return determinants of matrices (..., n, n): of one wall or two by hand, which costs a fifth of a general one."""
    if matrix.shape[-1] == 1:
        return np.asarray(matrix[..., 0, 0])
    if matrix.shape[-1] == 2:
        return np.asarray(matrix[..., 0, 0] * matrix[..., 1, 1] - matrix[..., 0, 1] * matrix[..., 1, 0])
    return np.asarray(np.linalg.det(matrix))


def shares_of(problem: Problem, shells: Sequence[int]) -> FloatArray:
    """Return by how much the actuators of each wall under control answer the reading of each, (walls, walls)."""
    found = np.eye(len(shells))
    for place, shell in enumerate(shells):
        shares = problem.shells[shell].shares
        if shares is not None:
            found[place] = [shares.get(other, 0.0) for other in shells]
    return found


def times(matrix: ComplexArray, vector: ComplexArray) -> ComplexArray:
    """Return matrices (patterns, nodes, walls, walls) times vectors (walls, patterns, nodes)."""
    return np.ascontiguousarray(np.moveaxis((matrix @ np.moveaxis(vector, 0, -1)[..., None])[..., 0], -1, 0))
