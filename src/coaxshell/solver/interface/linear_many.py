"""Many linear absorbers that differ, solved at each Laplace node by iteration on the orders instead of a dense matrix of all points.

With f = -Y w and w = w_linear + E C P f, the modal pressures p = P f solve

    p + D C p = -P Y w_linear,        D = P Y E,

where C is diagonal in the orders and D, were the absorbers spread evenly, would be too. The diagonal of D makes a preconditioner that is
inverted order by order; what is left are the differences of the absorbers. As C_ij/R_j is symmetric, and with it everything once it is
multiplied by C from the left, conjugate orthogonal gradients do, with one product D C a step and nothing kept (H. A. van der Vorst,
J. B. M. Melissen, IEEE Trans. Magn. 26 (1990) 706-708). All nodes of a block take their steps together, as real products of matrices.

Layouts with large gaps, or pairs of absorbers much closer than the shortest wave, do not converge fast enough to pay: that is found out
first, at one node of a block.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray, real_product
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, SideAdmittance, side_admittance
from coaxshell.solver.point_forces import point_force_shares
from coaxshell.solver.scaling import Problem

POINTS = 160
"""Points from which on iterating is tried: with fewer a dense solve takes less."""
NODES = 32
"""Nodes solved together."""
STEPS = 40
"""Steps after which a dense solve would have taken less."""
_TOLERANCE = 1e-15
"""Of the walls' displacement that is still missing, relative to the largest of all nodes."""
_OWN = 1e-13
"""The same relative to the largest of the node itself, which is enough where it moves little."""


class Spread:
    """The absorbers as the orders of two surfaces see them.

    Parameters
    ----------
    problem : Problem
    absorbers : AbsorberSet
    points : InterfacePoints

    Attributes
    ----------
    evaluate, project : ndarray, shape (2, N, orders)
        E and P of both sides; the orders of two parities follow each other.
    weights : ndarray, shape (2, orders, 1)
        R_i beta_m, by which C becomes symmetric.
    """

    def __init__(self, problem: Problem, absorbers: AbsorberSet, points: InterfacePoints) -> None:
        self.absorbers = absorbers
        maps = [points.maps_of(i) for i in (0, 1)]
        self.evaluate, self.project = (np.stack([one[k] for one in maps]) for k in (0, 1))
        self.orders = self.evaluate.shape[-1]
        self._pairs = [[np.ascontiguousarray((p * e).T) for e in self.evaluate] for p in self.project]
        self._back = [np.ascontiguousarray(p.T) for p in self.project]
        beta = np.tile(np.where(np.arange(points.modes) == 0, 2.0, 1.0), points.parities)
        self.weights = np.stack([surface.radius * beta for surface in problem.surfaces])[:, :, None]

    @classmethod
    def of(cls, problem: Problem, absorbers: AbsorberSet, points: InterfacePoints) -> Spread | None:
        """Return it where this way is open: two surfaces, one for each side of every absorber, and many points; else None."""
        each_side = len(problem.surfaces) == 2 and bool((absorbers.surfaces == [[0], [1]]).all())
        plain = problem.point_force_shares is point_force_shares
        return cls(problem, absorbers, points) if each_side and plain and points.count >= POINTS else None

    def iterate(
        self, s: ComplexArray, compliance: ComplexArray, excited: ComplexArray, largest: float
    ) -> tuple[ComplexArray, npt.NDArray[np.bool_]]:
        """Return the displacements of the points with absorbers, and at which nodes they were reached: see :func:`iterate`."""
        return iterate(self, s, compliance, excited, largest)

    def diagonal(self, law: SideAdmittance) -> ComplexArray:
        """Return the diagonal of D, shape (2, 2, orders, nodes)."""
        sides = ((law.inner.T, law.other.T), (law.other.T, law.outer.T))
        return np.stack([np.stack([real_product(self._pairs[i][j], sides[i][j]) for j in (0, 1)]) for i in (0, 1)])

    def pressed(self, law: SideAdmittance, moved: ComplexArray) -> ComplexArray:
        """Return P Y w of displacements at the points, (2, N, nodes): shape (2, orders, nodes)."""
        inner, outer = moved
        forces = law.inner.T * inner + law.other.T * outer, law.other.T * inner + law.outer.T * outer
        return np.stack([real_product(self._back[i], forces[i]) for i in (0, 1)])

    def moved(self, displacement: ComplexArray) -> ComplexArray:
        """Return displacements at the points, (2, N, nodes), of the orders (2, orders, nodes)."""
        return np.stack([real_product(self.evaluate[i], displacement[i]) for i in (0, 1)])


def _times(matrix: ComplexArray, vector: ComplexArray) -> ComplexArray:
    """Return the product of 2 x 2 matrices (2, 2, orders, nodes) and vectors (2, orders, nodes)."""
    first = matrix[0, 0] * vector[0]
    first += matrix[0, 1] * vector[1]
    second = matrix[1, 0] * vector[0]
    second += matrix[1, 1] * vector[1]
    return np.stack([first, second])


def _inverse(matrix: ComplexArray) -> ComplexArray:
    """Return the inverses of 2 x 2 matrices (2, 2, orders, nodes)."""
    (a, b), (c, d) = matrix
    return np.asarray(np.stack([np.stack([d, -b]), np.stack([-c, a])]) / (a * d - b * c))


def iterate(
    spread: Spread, s: ComplexArray, compliance: ComplexArray, excited: ComplexArray, largest: float
) -> tuple[ComplexArray, npt.NDArray[np.bool_]]:
    """Return the displacements of the points with absorbers, and at which nodes they were reached.

    Parameters
    ----------
    spread : Spread
    s : ndarray, shape (nodes,)
    compliance : ndarray, shape (2, 2, M + 1, nodes)
        C_ij.
    excited : ndarray, shape (2 N, nodes)
        Displacements of the points without absorbers.
    largest : float
        Of these at all nodes.

    Returns
    -------
    tuple of ndarray, shapes (2 N, nodes) and (nodes,)
    """
    law = side_admittance(spread.absorbers, s)
    parities = spread.orders // compliance.shape[2]
    answer = np.tile(compliance, (1, 1, parities, 1))
    bare = excited.reshape(2, -1, s.size)
    mean = spread.diagonal(law)
    changed = np.stack([_times(mean, answer[:, j]) for j in (0, 1)], axis=1)  # D C of the spread absorbers
    changed[0, 0] += 1.0
    changed[1, 1] += 1.0
    smooth = _inverse(changed)
    enough = precision(bare, largest)
    pressure, towards, motion = np.zeros((3, 2, spread.orders, s.size), np.complex128)
    missing = -spread.pressed(law, bare)
    last, done = np.ones(s.size, np.complex128), np.zeros(s.size, dtype=np.bool_)
    for step in range(STEPS):
        there = _times(smooth, missing)
        moves = _times(answer, there)
        done = np.abs(moves).sum(axis=(0, 1)) <= enough
        if done.all():
            break
        product = (missing * moves * spread.weights).sum(axis=(0, 1))
        ratio = over(product, last, ~done) if step else np.zeros(s.size)
        towards, motion, last = there + ratio * towards, moves + ratio * motion, product
        image = towards + spread.pressed(law, spread.moved(motion))
        length = over(product, (image * motion * spread.weights).sum(axis=(0, 1)), ~done)
        pressure += length * towards
        missing -= length * image
    reached = bare + spread.moved(_times(answer, pressure))
    return reached.reshape(excited.shape), done


def precision(bare: ComplexArray, largest: float) -> FloatArray:
    """Return how small a missing displacement is small enough at each node; ``bare`` is (2, N, nodes)."""
    return np.asarray(np.maximum(_TOLERANCE * largest, _OWN * np.abs(bare).max(axis=(0, 1))))


def over(upper: ComplexArray, lower: ComplexArray, where: npt.NDArray[np.bool_]) -> ComplexArray:
    """Return the quotient at some nodes, 0 at the others."""
    return np.divide(upper, lower, out=np.zeros_like(upper), where=where & (lower != 0.0))
