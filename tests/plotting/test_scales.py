"""Two quantities on one panel share their zero line and their grid."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from coaxshell.plotting.scales import common_scales, round_up

magnitudes = st.floats(min_value=1e-12, max_value=1e12)


@given(st.lists(st.tuples(magnitudes, magnitudes), min_size=1, max_size=3))
def test_scales_hold_the_data_and_share_their_steps(extremes):
    ranges = [(-low, high) for low, high in extremes]
    scales = common_scales(ranges)
    assert len({(scale.below, scale.above) for scale in scales}) == 1
    for scale, (low, high) in zip(scales, ranges, strict=True):
        lowest, highest = scale.limits
        assert lowest <= low
        assert high <= highest
        assert scale.ticks[scale.below] == 0.0


def test_the_scale_is_not_much_larger_than_the_data():
    (scale,) = common_scales([(-0.97, 0.45)])
    lowest, highest = scale.limits
    assert highest - lowest < 1.8 * (0.97 + 0.45)


@pytest.mark.parametrize("values", [(0.0, 0.0), (0.0, 3.0), (-3.0, 0.0)])
def test_one_sided_and_empty_ranges(values):
    (scale,) = common_scales([values])
    assert scale.limits[0] <= values[0] <= values[1] <= scale.limits[1]


@pytest.mark.parametrize(("value", "rounded"), [(0.97, 1.0), (1.0, 1.0), (1.1, 2.0), (2.2e-7, 2.5e-7), (61, 80), (0, 1.0)])
def test_round_up(value, rounded):
    assert round_up(value) == pytest.approx(rounded)
