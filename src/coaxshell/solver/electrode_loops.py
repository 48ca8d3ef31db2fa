"""The loops of feedback by electrodes, closed in the Laplace domain (theory manual, "Segments").

In each pattern q (:mod:`coaxshell.solver.electrode_patterns`) the walls under control have one loop,

    phi_q = phi0_q + C_q u_q,      u_q = H_q phi_q,      C_q = sum_m R_qm C_m L_mq,

C_m what they read in order m per volt of order m without feedback, so that u_q = (1 - H C_q)^-1 H phi0_q, as many equations as walls.
Dead segments tie all patterns: they are those on which further voltages e, of which no loop knows, leave nothing,

    u_q = (1 - H C_q)^-1 (H phi0_q + e_q),      u = 0 on every dead segment.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
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
        1 - H C_q.
    """

    patterns: Patterns
    law: ComplexArray
    matrix: ComplexArray

    @classmethod
    def of(cls, problem: Problem, response: VoltageResponse, patterns: Patterns, s: ComplexArray) -> ElectrodeLoops:
        """Return the loops with the feedback of a problem."""
        numbers, count = patterns.numbers, len(response.shells)
        laws = [gains_of_wall(problem, i).at(s, numbers) for i in response.shells]
        law = np.stack([np.broadcast_to(one, (numbers.count, s.size)) for one in laws])
        matrix = np.empty((numbers.count, s.size, count, count), np.complex128)
        for a, row in enumerate(patterns.responses(response.read)):
            for b, own in enumerate(row):
                matrix[..., a, b] = float(a == b) - law[a] * own
        return cls(patterns, law, matrix)

    @property
    def inverse(self) -> ComplexArray:
        """(1 - H C_q)^-1, shape (patterns, nodes, walls, walls)."""
        return np.asarray(np.linalg.inv(self.matrix), dtype=np.complex128)

    def asked(self, readings: ComplexArray) -> ComplexArray:
        """Return u_q, (walls, patterns, nodes), from what is read of the motion without voltages; dead segments as if they were alive."""
        return times(self.inverse, self.law * readings)

    def voltages(self, readings: ComplexArray) -> ComplexArray:
        """Return u_q with dead segments at ground."""
        inverse, dead = self.inverse, list(self.patterns.dead)
        found = times(inverse, self.law * readings)
        if not dead:
            return found
        left = np.einsum("dq,iqk->kid", self.patterns.evaluate[dead], found)
        further = -np.linalg.solve(self.between_dead(inverse), left.reshape(len(left), -1, 1)).reshape(left.shape)
        return found + times(inverse, np.einsum("qd,kid->iqk", self.patterns.project[:, dead], further))

    def between_dead(self, inverse: ComplexArray) -> ComplexArray:
        """Return the voltage on each dead segment per further volt on each, shape (nodes, n, n), n the dead segments of all walls."""
        dead = list(self.patterns.dead)
        held, amplitudes = self.patterns.evaluate[dead], self.patterns.project[:, dead]
        found = np.einsum("dq,qkij,qe->kidje", held, inverse, amplitudes, optimize=True)
        size = found.shape[1] * found.shape[2]
        return np.asarray(found.reshape(len(found), size, size))

    def factors(self) -> ComplexArray:
        """Return |1 - H C_q|, (patterns, nodes), and where dead segments tie the patterns one row more, whose product is that of all.

        Of the loops of live ones alone it is the product over patterns times |(1 - H C)^-1| on the dead segments, the complementary minor.
        """
        each = np.linalg.det(self.matrix)
        if not self.patterns.dead:
            return np.asarray(each)
        return np.concatenate([each, np.linalg.det(self.between_dead(self.inverse))[None]])

    def determinants(self) -> ComplexArray:
        """Return |1 - H C_q|, (patterns, nodes); where dead segments tie the patterns that of all together, (1, nodes)."""
        each = self.factors()
        return each.prod(axis=0, keepdims=True) if self.patterns.dead else each


def times(matrix: ComplexArray, vector: ComplexArray) -> ComplexArray:
    """Return matrices (patterns, nodes, walls, walls) times vectors (walls, patterns, nodes)."""
    return np.ascontiguousarray(np.moveaxis((matrix @ np.moveaxis(vector, 0, -1)[..., None])[..., 0], -1, 0))
