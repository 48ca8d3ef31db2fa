"""Sums over the shapes of a wall of solid layers, weight/(omega^2 + s^2), at a block of Laplace nodes.

A block sees few shapes resonate; all others answer there as smooth functions of z = s^2. With w = (z - c)/h from about -1 to 1 on the block
and A = (omega^2 + c)/h a term is (1/h)/(A + w), and

    1/(A + w) = +-1/sqrt(A^2 - 1) sum over k of (2 - [k = 0]) (-+1)^k rho^-k T_k(w),      rho = |A| + sqrt(A^2 - 1),

upper signs where A > 0: real coefficients, which shapes of one order share as one polynomial. The nodes lie beside the axis of real z, on
an ellipse of Bernstein's of size rho_w, and the rest after K terms is about (rho_w/rho)^K.
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
    orders, rows, _ = weights.shape
    z = s * s
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
    lowest, highest = float(z.real.min()), float(z.real.max())
    centre, half = 0.5 * (lowest + highest), 0.5 * (highest - lowest)
    w = (z - centre) / half if half > 0.0 else np.full_like(z, np.inf)
    root = np.sqrt(w * w - 1.0) if half > 0.0 else w
    size = float(np.maximum(np.abs(w + root), np.abs(w - root)).max()) if half > 0.0 else math.inf
    if size > WIDEST or z.size < FEWEST:
        none = np.zeros(orders, dtype=np.int64)
        return _Smooth(none, none + shapes, np.zeros((orders, shapes, 0)), np.zeros((0, z.size), np.complex128))
    count, least = next((terms, ratio) for most, terms, ratio in CHOICES if rows <= most)
    place = (squares + centre) / half
    edge = 0.5 * (least * size + 1.0 / (least * size))  # where rho is so much
    below, above = place < -edge, place > edge
    root = np.sqrt(np.where(below | above, place * place - 1.0, 1.0))
    ratio = np.where(below | above, -np.sign(place) / (np.abs(place) + root), 0.0)
    series = np.empty((orders, shapes, count))
    series[..., 0] = np.where(below | above, np.sign(place) / (half * root), 0.0)
    series[..., 1:] = 2.0 * series[..., :1] * np.cumprod(np.broadcast_to(ratio[..., None], (orders, shapes, count - 1)), axis=-1)
    terms = np.empty((count, z.size), np.complex128)
    terms[0], terms[1] = 1.0, w
    for k in range(2, count):
        terms[k] = 2.0 * w * terms[k - 1] - terms[k - 2]
    return _Smooth(np.count_nonzero(below, axis=1), shapes - np.count_nonzero(above, axis=1), series, terms)
