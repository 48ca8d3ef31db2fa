"""Few orders that tell what all orders do where answers are smooth functions of the order.

Far above the resonances along walls and around fluids an answer depends on m^2, smoothly, the even orders by one function and the odd ones
by another (the waves of a cavity have the sign (-1)^m). A polynomial in m^2 through some orders is farthest from such a function about
where the product of the distances from these orders is largest: there the next orders are put (Leja's points), so that orders once solved
stay of use, and there the polynomial through those before is checked.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray, real_product
from coaxshell.numerics.modes import Modes

CHECKED = 2
"""Orders of each parity by which the polynomial through those before is checked."""
_GROWING = (10, 18, 28)
"""Orders of each parity that are solved, one after the other, until the check holds."""
_WORTH = 0.7
"""Of all orders, up to which fewer are tried."""
FORETOLD = 1e-10
"""Of the largest answer of any order, up to which the check holds; with the orders checked known too, a tenth of it is left or less."""


@dataclass(frozen=True, eq=False)
class SampleRound:
    """What is solved next, and what is known then.

    Attributes
    ----------
    added : Modes
        Orders to be solved beside those of the rounds before.
    spread : ndarray, shape (all orders, orders known)
        What all orders answer from those that are known, in the order in which they were added.
    foretold : ndarray, shape (checks, orders known), or None
        What vanishes where the polynomials without the last orders foretell these; None of the last round, which knows all.
    """

    added: Modes
    spread: FloatArray
    foretold: FloatArray | None

    def tells(self, known: ComplexArray) -> npt.NDArray[np.bool_]:
        """Return at which nodes the orders that are known tell all, from their answers (pairs, orders known, nodes)."""
        if self.foretold is None:
            return np.ones(known.shape[-1], dtype=bool)
        missed = np.stack([real_product(self.foretold, one) for one in known])
        return np.asarray(np.abs(missed).max(axis=(0, 1)) <= FORETOLD * np.abs(known).max(axis=(0, 1)))


def sample_rounds(whole: Modes) -> list[SampleRound]:
    """Return the rounds in which orders 0 to M of the plane problem are solved; one alone where there are too few."""
    parities = [whole.orders[parity::2] for parity in (0, 1)]
    ways = [_leja(orders**2) for orders in parities]
    counts = [count for count in _GROWING if count <= _WORTH * min(map(len, parities))]
    rounds: list[SampleRound] = []
    known = np.zeros(0, dtype=np.int64)
    for count in counts:
        places = np.concatenate([parity + 2 * way[:count] for parity, way in enumerate(ways)])
        added = np.sort(np.setdiff1d(places, known))
        known = np.concatenate([known, added])
        spread, foretold = np.zeros((whole.count, known.size)), np.zeros((2 * CHECKED, known.size))
        column = {int(place): k for k, place in enumerate(known)}
        for parity, (orders, way) in enumerate(zip(parities, ways, strict=True)):
            here = [column[parity + 2 * int(k)] for k in way[:count]]
            squares, checks = orders[way[:count]] ** 2, slice(CHECKED * parity, CHECKED * (parity + 1))
            spread[parity::2, here] = _through(squares, orders**2)
            foretold[checks, here[:-CHECKED]] = _through(squares[:-CHECKED], squares[-CHECKED:])
            foretold[checks, here[-CHECKED:]] = -np.eye(CHECKED)
        rounds.append(SampleRound(whole.some(added), spread, foretold))
    rest = np.setdiff1d(np.arange(whole.count), known)
    rounds.append(SampleRound(whole.some(rest) if counts else whole, np.eye(whole.count)[:, np.concatenate([known, rest])], None))
    return rounds


def _leja(x: FloatArray) -> npt.NDArray[np.int64]:
    """Return the places of Leja's points among x, each where the product of the distances from those before is largest."""
    found = [int(np.argmax(x))]
    with np.errstate(divide="ignore"):
        product = np.log(np.abs(x - x[found[0]]))
        while len(found) < len(x):
            found.append(int(np.argmax(product)))
            product = product + np.log(np.abs(x - x[found[-1]]))
    return np.array(found)


def _through(points: FloatArray, x: FloatArray) -> FloatArray:
    """Return the polynomials that are 1 at one of the points and 0 at the others, at x, shape (x, points): by barycentric weights."""
    away = (points[:, None] - points) * (4.0 / np.ptp(points))
    np.fill_diagonal(away, 1.0)
    weights = 1.0 / away.prod(axis=1)
    distance = x[:, None] - points
    hit = distance == 0.0
    shares = weights / np.where(hit, 1.0, distance)
    return np.asarray(np.where(hit.any(axis=1, keepdims=True), hit, shares / shares.sum(axis=1, keepdims=True)), dtype=np.float64)
