"""Few orders that tell all."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.modes import Modes
from coaxshell.numerics.order_samples import sample_rounds

WHOLE = Modes.up_to(60)
SIGN = np.where(WHOLE.orders % 2 == 0, 1.0, -0.6)[:, None]


def answers(pole: complex) -> np.ndarray:
    """Return a resonance at m^2 = pole, even and odd orders by functions of their own, (pairs, orders, nodes)."""
    return (SIGN * 1e3 / (WHOLE.orders[:, None] ** 2 - pole))[None]


def test_all_orders_are_foretold_where_they_are_smooth_and_solved_where_not() -> None:
    """What a round says it tells, all orders are to 1e-11 of the largest; the last one tells all by having solved each once."""
    rounds = sample_rounds(WHOLE)
    known: list[int] = []
    said = []
    for one in rounds:
        known += one.added.orders.astype(int).tolist()
        for pole in (-6e4 + 1e4j, -3e3 + 1e3j, 900.0 + 30.0j):
            every = answers(pole)
            told = bool(one.tells(every[:, known])[0])
            said.append(told)
            if told:
                np.testing.assert_allclose(one.spread @ every[0, known], every[0], rtol=0, atol=1e-11 * np.abs(every).max())
    assert sorted(known) == list(range(61))
    assert said == [True, False, False, True, True, False, True, True, True]


def test_few_orders_are_solved_at_once() -> None:
    few = Modes.up_to(12)
    (one,) = sample_rounds(few)
    assert one.added is few
    np.testing.assert_array_equal(one.spread, np.eye(13))
