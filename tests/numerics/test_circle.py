"""Sums over the circle and their largest value, against plain cosines and sines at every angle and instant."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.numerics import circle
from coaxshell.numerics.circle import CirclePeak, circle_angles, on_circle, peak_on_circle, reachable

SEVERAL = 400
"""Instants, many times as many as are summed before the others are judged."""


@pytest.fixture
def modal() -> np.ndarray:
    values = np.random.default_rng(1).standard_normal((2, 9, 5))
    values[1, 0] = 0.0
    return values


def plain(modal: np.ndarray, *, finer: int = 1) -> np.ndarray:
    """Return what :func:`on_circle` does, order by order."""
    parities, orders, _ = modal.shape
    arguments = np.radians(np.outer(circle_angles(orders, parities, finer=finer), np.arange(orders)))
    sums = np.cos(arguments) @ modal[0]
    return np.asarray(sums if parities == 1 else sums + np.sin(arguments) @ modal[1])


def histories(parities: int, *, seed: int = 3) -> np.ndarray:
    """Return orders that fall off, with a pulse in time, as those of a shell do."""
    random = np.random.default_rng(seed)
    fall = np.exp(-0.4 * np.arange(12))[None, :, None] * np.exp(-(((np.arange(SEVERAL) - 150) / 60) ** 2))
    values = random.standard_normal((2, 12, SEVERAL)) * fall
    values[1, 0] = 0.0
    return np.asarray(values[:parities])


@pytest.mark.parametrize("parities", [1, 2])
@pytest.mark.parametrize("finer", [1, 2])
def test_on_circle_is_the_sum_at_its_angles(modal: np.ndarray, parities: int, finer: int) -> None:
    modal = np.concatenate([modal] * 12, axis=1)[:parities]  # 108 orders: finer than whole degrees
    modal[1:, 0] = 0.0
    np.testing.assert_allclose(on_circle(modal, finer=finer), plain(modal, finer=finer), rtol=0, atol=1e-11)


@pytest.mark.parametrize(("orders", "step"), [(2, 1.0), (90, 1.0), (91, 0.5), (151, 0.5), (2001, 360 / (23 * 360))])
def test_circle_is_fine_enough_and_holds_whole_degrees(orders: int, step: float) -> None:
    whole, half = circle_angles(orders, 2), circle_angles(orders, 1)
    assert whole[1] == pytest.approx(step)
    assert len(whole) >= 4 * orders
    assert half[-1] == 180.0
    np.testing.assert_allclose(whole[:: len(whole) // 360], np.arange(360.0), rtol=1e-14)


@pytest.mark.parametrize("parities", [1, 2])
def test_nothing_exceeds_what_is_reachable(parities: int) -> None:
    modal = histories(parities)
    highest = np.abs(plain(modal)).max(axis=0)
    assert np.all(highest <= reachable(modal) * (1 + 1e-12))
    alone = np.zeros((parities, 5, 1))
    alone[:, 3, 0] = [3.0, 4.0][:parities]
    assert reachable(alone) == pytest.approx(np.hypot(*alone[:, 3, 0]) if parities == 2 else 3.0)


def fine(modal: np.ndarray) -> np.ndarray:
    """Return the magnitude at angles FINE times closer than those of the circle."""
    arguments = np.radians(np.outer(np.arange(0.0, 360.0, 1.0 / circle.FINE), np.arange(modal.shape[1])))
    return np.asarray(np.abs(sum(wave(arguments) @ part for wave, part in zip((np.cos, np.sin), modal, strict=False))))


@pytest.mark.parametrize("parities", [1, 2])
@pytest.mark.parametrize("seed", range(5))
def test_peak_is_the_largest_of_the_whole_field(parities: int, seed: int) -> None:
    modal = histories(parities, seed=seed)
    values = fine(modal)
    place, instant = np.unravel_index(values.argmax(), values.shape)
    found = peak_on_circle(modal)
    assert found is not None
    assert found.instant == instant
    angle = circle_angles(modal.shape[1], parities)[found.place]
    assert min(abs(angle - x) for x in (place / circle.FINE, 360.0 - place / circle.FINE)) <= 1.0
    assert found.value == pytest.approx(values.max(), rel=1e-12)


@pytest.mark.parametrize("parities", [1, 2])
@pytest.mark.parametrize("reversed_", [False, True])
def test_of_two_crests_that_between_the_angles_is_not_missed(parities: int, reversed_: bool) -> None:
    """Its neighbours are lower than the other crest, which lies on an angle."""
    orders = 30
    m = np.arange(1, orders)
    modal = np.zeros((parities, orders, 2))
    for instant, (angle, size) in enumerate(((40.5, 1.005), (90.0, 1.0))):
        modal[0, 1:, instant] = size * np.cos(m * np.radians(angle))
        if parities == 2:
            modal[1, 1:, instant] = size * np.sin(m * np.radians(angle))
    modal = modal[..., ::-1] if reversed_ else modal
    on_angles = np.abs(plain(modal)).max(axis=0)
    values = fine(modal).max(axis=0)
    assert on_angles.argmax() != values.argmax()
    found = peak_on_circle(modal)
    assert found is not None
    assert found.instant == values.argmax()
    assert found.value == pytest.approx(values.max(), rel=1e-12)


def test_crest_is_found_where_few_instants_promise_it() -> None:
    """The instant that could reach most, by its orders, does not: they cancel each other."""
    modal = np.zeros((1, 12, SEVERAL))
    modal[0, 1:, 100 : 100 + 2 * circle._FIRST] = 0.1 * np.array([1, 1, -1, -1] * 3)[:11, None]  # can reach 1.1
    modal[0, 0, 300] = 0.9
    highest = np.abs(plain(modal))
    assert highest[:, 100].max() < 0.9
    assert peak_on_circle(modal) == CirclePeak(0.9, 0, 300)


def test_crest_of_equal_values_is_the_first() -> None:
    modal = np.zeros((1, 3, SEVERAL))
    modal[0, 0, 7::40] = -2.0
    assert peak_on_circle(modal) == CirclePeak(2.0, 0, 7)


def test_crest_of_nothing() -> None:
    assert peak_on_circle(np.zeros((2, 4, 30))) == CirclePeak(0.0, 0, 0)
    assert peak_on_circle(np.zeros((2, 4, 30)), above=0.0) is None


@pytest.mark.parametrize("times", [1, 3])
def test_crest_of_few_instants(times: int) -> None:
    modal = histories(2)[..., 150 : 150 + times]
    found = peak_on_circle(modal)
    assert found is not None
    assert found.value == pytest.approx(fine(modal).max(), rel=1e-12)


def test_crest_above_a_limit() -> None:
    modal = histories(1)
    largest = peak_on_circle(modal)
    assert largest is not None
    assert peak_on_circle(modal, above=0.999 * largest.value) == largest
    assert peak_on_circle(modal, above=largest.value) is None
    reach = float(reachable(modal).max())
    assert largest.value < 0.9 * reach, "the orders must not add up, or the next line shows nothing"
    assert peak_on_circle(modal, above=0.5 * (largest.value + reach)) is None
