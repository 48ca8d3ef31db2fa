"""Spectral elements in r: Gauss-Lobatto-Legendre points of degree 8, integrals by Gauss quadrature."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre
from scipy.special import roots_jacobi

from coaxshell.numerics.arrays import FloatArray

DEGREE = 8


class RadialMatrices(NamedTuple):
    """Nodes and the integrals of N N r, N' N' r and N N/r over a region."""

    nodes: FloatArray
    mass: FloatArray
    radial: FloatArray
    angular: FloatArray


def elements(r_min: float, r_max: float, longest: float) -> RadialMatrices:
    """Return nodes and matrices of [r_min, r_max], cut into equal elements no longer than ``longest``."""
    inner = roots_jacobi(DEGREE - 1, 1, 1)[0]  # the zeros of P_n'
    local = np.concatenate([[-1.0], inner, [1.0]])
    x, weight = legendre.leggauss(DEGREE + 2)
    to_modal = np.linalg.inv(legendre.legvander(local, DEGREE))
    shape = legendre.legvander(x, DEGREE) @ to_modal
    slope = legendre.legval(x, legendre.legder(np.eye(DEGREE + 1))).T @ to_modal
    count = max(1, int(np.ceil((r_max - r_min) / longest)))
    half = (r_max - r_min) / count / 2
    size = count * DEGREE + 1
    nodes, (mass, radial, angular) = np.zeros(size), (np.zeros((size, size)) for _ in range(3))
    for k in range(count):
        rows = slice(k * DEGREE, (k + 1) * DEGREE + 1)
        middle = r_min + (2 * k + 1) * half
        nodes[rows] = middle + half * local
        r = middle + half * x
        mass[rows, rows] += half * (shape.T * (weight * r)) @ shape
        radial[rows, rows] += (slope.T * (weight * r)) @ slope / half
        angular[rows, rows] += half * (shape.T * (weight / r)) @ shape
    return RadialMatrices(nodes, mass, radial, angular)
