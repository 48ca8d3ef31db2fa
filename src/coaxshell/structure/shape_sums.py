"""Sums over the shapes of a wall of solid layers, weight/(omega^2 + s^2), at a block of Laplace nodes.

A block sees few shapes resonate; all others answer there as smooth functions of z = s^2. With w = (z - c)/h from about -1 to 1 on the block
and A = (omega^2 + c)/h a term is (1/h)/(A + w), and

    1/(A + w) = +-1/sqrt(A^2 - 1) sum over k of (2 - [k = 0]) (-+1)^k rho^-k T_k(w),      rho = |A| + sqrt(A^2 - 1),

upper signs where A > 0: real coefficients, which shapes of one order share as one polynomial. The nodes lie beside the axis of real z, on
an ellipse of Bernstein's of size rho_w, and the rest after K terms is about (rho_w/rho)^K. A block that reaches far, as the last of the
trapezoidal rule do, is better seen by u = 1/z: a term is u/(1 + omega^2 u), and fewer shapes resonate.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray

CHOICES = ((4, 26, 3.6), (math.inf, 18, 6.5))
"""Terms of the polynomial of shapes that do not resonate in a block, and rho/rho_w from which they count among these, for sums of up to so
many rows: the rest is 3.6^-26 or 6.5^-18, 3e-15 of it, and a term costs as many products as there are rows."""
FEWEST = 64
"""Nodes of a block from which a polynomial pays."""
WIDEST = 1e6
"""rho_w up to which there is one."""
FEW = 3
"""Shapes that are summed one by one: as many as bend and stretch along a wall."""


class _Smooth(NamedTuple):
    """What a block sees of shapes that do not resonate there.

    Attributes
    ----------
    first, last : ndarray, shape (orders,)
        The shapes from ``first`` to before ``last`` are not among them.
    series : ndarray, shape (orders, shapes, terms)
        Coefficients, 0 of these.
    terms : ndarray, shape (terms, nodes)
        T_k(w).
    """

    first: npt.NDArray[np.int64]
    last: npt.NDArray[np.int64]
    series: FloatArray
    terms: ComplexArray


def modal_sums(weights: FloatArray, squares: FloatArray, s: ComplexArray) -> ComplexArray:
    """Return sums over the shapes of weight/(omega^2 + s^2), shape (rows, orders, nodes), by one matrix product for each order.

    Parameters
    ----------
    weights : ndarray, shape (orders, rows, shapes)
    squares : ndarray, shape (orders, shapes)
        omega^2, ascending.
    s : ndarray, shape (nodes,)
    """
    orders, rows, shapes = weights.shape
    z = s * s
    if shapes <= FEW:
        each = 1.0 / (squares[..., None] + z)
        return np.moveaxis((weights @ each.view(np.float64)).view(np.complex128), 1, 0)
    smooth = _smooth(squares, z, rows)
    coefficients, count = weights @ smooth.series, smooth.terms.shape[0]
    most = int((smooth.last - smooth.first).max(initial=0))
    found = np.empty((rows, orders, s.size), np.complex128)
    answers = np.empty((count + most, s.size), np.complex128)  # in the cache of a processor for all orders
    answers[:count] = smooth.terms
    factors, (size, above) = np.empty((rows, count + most)), np.empty((2, most, s.size))
    as_real, into, real, imaginary = answers.view(np.float64), found.view(np.float64), answers.real, answers.imag
    x, y = np.ascontiguousarray(z.real), np.ascontiguousarray(z.imag)
    minus_y, y2 = -y, y * y
    for m, (first, last) in enumerate(zip(smooth.first.tolist(), smooth.last.tolist(), strict=True)):
        few, stop = last - first, count + last - first
        factors[:, :count] = coefficients[m]
        if few:
            a, inverse = above[:few], size[:few]
            np.add(squares[m, first:last, None], x, out=a)
            np.multiply(a, a, out=inverse)
            inverse += y2
            np.reciprocal(inverse, out=inverse)
            np.multiply(a, inverse, out=real[count:stop])
            np.multiply(minus_y, inverse, out=imaginary[count:stop])
            factors[:, count:stop] = weights[m, :, first:last]
        np.matmul(factors[:, :stop], as_real[:stop], out=into[:, m])
    return found


def _smooth(squares: FloatArray, z: ComplexArray, rows: int) -> _Smooth:
    """Return it; no terms where nodes are few or lie too far from a segment of the real axis."""
    orders, shapes = squares.shape
    count, least = next((terms, ratio) for most, terms, ratio in CHOICES if rows <= most)
    seen = [one for one in (_Seen.of(z, least), _Seen.of(1.0 / z, least)) if one is not None] if z.size >= FEWEST else []
    if not seen:
        none = np.zeros(orders, dtype=np.int64)
        return _Smooth(none, none + shapes, np.zeros((orders, shapes, 0)), np.zeros((0, z.size), np.complex128))
    parts = [(one.centre + squares, one.half + 0.0 * squares) for one in seen[:1]]
    parts += [(1.0 + squares * one.centre, squares * one.half) for one in seen[1:]]  # 1/(omega^2 + z) = u/(1 + omega^2 u), u = 1/z
    far = [np.abs(fixed) > one.edge * slope for one, (fixed, slope) in zip(seen, parts, strict=True)]
    best = int(np.argmax([np.count_nonzero(one) for one in far]))
    (fixed, slope), smooth, w = parts[best], far[best], seen[best].places
    root = np.sqrt(np.where(smooth, fixed * fixed - slope * slope, 1.0))
    ratio = np.where(smooth, -np.sign(fixed) * slope / (np.abs(fixed) + root), 0.0)
    series = np.empty((orders, shapes, count))
    series[..., 0] = np.where(smooth, np.sign(fixed) / root, 0.0)
    series[..., 1:] = 2.0 * series[..., :1] * np.cumprod(np.broadcast_to(ratio[..., None], (orders, shapes, count - 1)), axis=-1)
    terms = np.empty((count, z.size), np.complex128)
    terms[0], terms[1] = 1.0, w
    for k in range(2, count):
        terms[k] = 2.0 * w * terms[k - 1] - terms[k - 2]
    if best:
        terms /= z  # of u/(1 + omega^2 u)
    low = smooth & ((fixed > 0.0) if best else (fixed < 0.0))
    return _Smooth(np.count_nonzero(low, axis=1), shapes - np.count_nonzero(smooth & ~low, axis=1), series, terms)


class _Seen(NamedTuple):
    """A variable on a block, about real: its middle and half of its range, where the nodes are in these, and from where poles are far."""

    centre: float
    half: float
    places: ComplexArray
    edge: float

    @classmethod
    def of(cls, variable: ComplexArray, least: float) -> _Seen | None:
        """Return it, of poles whose rho is *least* times that of the nodes; None where these lie too far from the axis."""
        lowest, highest = float(variable.real.min()), float(variable.real.max())
        centre, half = 0.5 * (lowest + highest), 0.5 * (highest - lowest)
        if half <= 0.0:
            return None
        w = (variable - centre) / half
        root = np.sqrt(w * w - 1.0)
        size = float(np.maximum(np.abs(w + root), np.abs(w - root)).max())
        rho = least * size
        return None if size > WIDEST else cls(centre, half, w, 0.5 * (rho + 1.0 / rho))
