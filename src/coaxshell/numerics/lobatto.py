"""Gauss-Lobatto points of an interval: quadrature, differentiation and interpolation of polynomials through them.

The p + 1 points on [-1, 1] are its ends and the zeros of P_p', the derivative of Legendre's polynomial; their weights
2/(p (p + 1) P_p(x)^2) integrate polynomials up to degree 2 p - 1.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from coaxshell.numerics.arrays import FloatArray


class Lobatto(NamedTuple):
    """The rule of one degree p, on [-1, 1].

    Attributes
    ----------
    points, weights : ndarray, shape (p + 1,)
        Points ascending.
    derivative : ndarray, shape (p + 1, p + 1)
        From values at the points to the derivative of their polynomial there.
    """

    points: FloatArray
    weights: FloatArray
    derivative: FloatArray


@lru_cache(maxsize=256)
def lobatto(degree: int) -> Lobatto:
    """Return the rule of a degree from 1 on; nobody may change it.

    Zeros of P_p' are eigenvalues of the Jacobi matrix of its orthogonal polynomials, refined by two steps of Newton's method. The
    derivative matrix is P_p(x_i)/(P_p(x_j) (x_i - x_j)) off the diagonal, and its rows add to zero.
    """
    if degree == 1:
        inner: FloatArray = np.zeros(0)
    else:
        n = np.arange(1.0, degree - 1)
        beside = np.sqrt(n * (n + 2.0) / ((2.0 * n + 1.0) * (2.0 * n + 3.0)))
        inner = np.linalg.eigvalsh(np.diag(beside, 1) + np.diag(beside, -1))
    top = np.zeros(degree + 1)
    top[-1] = 1.0
    for _ in range(2):
        inner = inner - legendre.legval(inner, legendre.legder(top)) / legendre.legval(inner, legendre.legder(top, 2))
    points = np.concatenate([[-1.0], 0.5 * (inner - inner[::-1]), [1.0]])  # symmetric to the last bit
    value = legendre.legval(points, top)
    weights = 2.0 / (degree * (degree + 1) * value**2)
    apart = points[:, None] - points[None, :]
    np.fill_diagonal(apart, 1.0)
    derivative = value[:, None] / (value[None, :] * apart)
    np.fill_diagonal(derivative, 0.0)
    np.fill_diagonal(derivative, -derivative.sum(axis=1))
    for array in (points, weights, derivative):
        array.setflags(write=False)
    return Lobatto(points, weights, derivative)


def interpolation(degree: int, at: float) -> FloatArray:
    """Return the values at one place of [-1, 1] of the polynomials that are 1 at one point of the rule and 0 at the others, (p + 1,).

    By the barycentric formula, whose weights are (-1)^j sqrt(weight of the quadrature) up to a factor.
    """
    rule = lobatto(degree)
    apart = at - rule.points
    if np.any(hit := np.abs(apart) < 1e-14):
        return hit.astype(np.float64)
    weight = np.where(np.arange(degree + 1) % 2 == 0, 1.0, -1.0) * np.sqrt(rule.weights)
    share = weight / apart
    return np.asarray(share / share.sum())
