"""The shapes of a wall that bend and stretch along it, in waves that run along the axis with a front: at complex wavenumbers.

What voltages find inertia of, and what a control law hears, are the three lowest shapes of a wall
(:mod:`coaxshell.structure.solid_transducers`). At a real wavenumber an eigenproblem gives them. With these, X_i, at some k_i, and X_0 in
the middle of the k_i, the sum of all three of anything is that of

    Y(k_i) = X_i (X_0'M X_i)^-1,      X X'M = Y W^-1 Y'M,      W = Y'M Y,

and Y is as smooth in k as the three together: a polynomial through Chebyshev's points k_i gives it beside the real axis, panel by panel.
The three are followed, by what they have in common with those before: where orders are so high that one of them meets a shape that moves
through the thickness, it is still the same motion that is heard. Up to there they agree with those of the complex K(m, k) to 1e-9.
"""

from __future__ import annotations

import math
from functools import lru_cache
from threading import Lock

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.structure.elastic_basis import orders_basis
from coaxshell.structure.elastic_mesh import WallMesh
from coaxshell.structure.solid_transducers import along_wall

_PANEL = 0.6
"""Length of a panel, in 1 over the thickness of the wall."""
_POINTS = 12
_BESIDE = 0.05
"""How far points reach beyond a panel, in its length."""
_AMONG = 8
"""Lowest shapes among which those before are looked for."""


class LowestShapes:
    """Y of some orders of a wall at any wavenumber, times the root of the mass.

    Parameters
    ----------
    mesh : WallMesh
    orders : tuple of float
    """

    def __init__(self, mesh: WallMesh, orders: tuple[float, ...]) -> None:
        self._mesh, self._orders = mesh, np.array(orders)
        self._root = np.sqrt(mesh.mass)
        self._length = _PANEL / float(mesh.radius[-1] - mesh.radius[0])
        self._points = np.cos((2.0 * np.arange(_POINTS) + 1.0) * math.pi / (2.0 * _POINTS))
        self._panels: list[FloatArray] = []
        self._last: FloatArray | None = None
        self._lock = Lock()

    def at(self, order: int, k: ComplexArray) -> ComplexArray:
        """Return Y of an order, by its number, at some wavenumbers, shape (nodes, displacements, 3)."""
        back = float(np.mean(k.real)) < 0.0
        along = -k if back else k
        panels = np.maximum(np.floor(along.real / self._length), 0.0).astype(int)
        found = np.empty((k.size, 3 * self._root.size, 3), np.complex128)
        for number in np.unique(panels):
            some = panels == number
            found[some] = np.tensordot(self._weights(along[some], int(number)), self._panel(int(number))[:, order], 1)
        if back:  # the other way along the axis: u_z has the other sign
            found[:, 2 * self._root.size :] *= -1.0
        return found

    def _wavenumbers(self, number: int) -> FloatArray:
        return np.asarray(self._length * (number + 0.5 + (0.5 + _BESIDE) * self._points))

    def _weights(self, k: ComplexArray, number: int) -> ComplexArray:
        """Return Lagrange's polynomials through the points of a panel, shape (nodes, points): (1 + 2 sum T_j(x_i) T_j(x))/n."""
        x = (k / self._length - number - 0.5) / (0.5 + _BESIDE)
        before, now = np.ones_like(x), x
        of_points, found = np.arccos(self._points), np.ones((k.size, _POINTS), np.complex128)
        for j in range(1, _POINTS):
            found += 2.0 * np.multiply.outer(now, np.cos(j * of_points))
            before, now = now, 2.0 * x * now - before
        return found / _POINTS

    def _panel(self, number: int) -> FloatArray:
        """Return Y at the points of a panel, shape (points, orders, displacements, 3); those before it are made first."""
        with self._lock:
            while len(self._panels) <= number:
                self._panels.append(self._made(len(self._panels)))
            return self._panels[number]

    def _made(self, number: int) -> FloatArray:
        each, middle = [], _POINTS // 2
        for k in self._wavenumbers(number)[::-1]:  # from below
            basis = orders_basis(self._mesh, slice(0, self._orders.size), self._orders, float(k))
            shapes = (basis.shapes[:, :_AMONG] * self._root).reshape(self._orders.size, _AMONG, -1)
            if self._last is None:
                self._last = shapes[:, : along_wall(float(k))]
            self._last = _followed(self._last, shapes)
            each.append(np.swapaxes(self._last, 1, 2))
        of_reference = np.swapaxes(each[middle], 1, 2)
        return np.stack([one @ np.linalg.inv(of_reference @ one) for one in each[::-1]])


def _followed(before: FloatArray, shapes: FloatArray) -> FloatArray:
    """Return those of some shapes, (orders, shapes, displacements), that have most in common with as many before them."""
    shared = (np.einsum("mbd,mnd->mbn", before, shapes) ** 2).sum(axis=1)
    most = np.sort(np.argsort(-shared, axis=1, kind="stable")[:, : before.shape[1]], axis=1)
    return np.take_along_axis(shapes, most[..., None], axis=1)


lowest_shapes = lru_cache(maxsize=24)(LowestShapes)
