"""How a magnitude stands to another, in words without signs."""

from __future__ import annotations

import pytest

from coaxshell.model.prefixes import against


@pytest.mark.parametrize(
    ("value", "reference", "words"),
    [
        (1.0, 2.0, "smaller by 50.0 %"),
        (3.0, 2.0, "larger by 50.0 %"),
        (3.058, 1.0, "3.06 times as large"),
        (2.0, 1.0, "2.00 times as large"),
        (1.9996, 1.0, "larger by 100.0 %"),
        (250.0, 1.0, "250 times as large"),
        (3e9, 1.0, "3e+09 times as large"),
        (2.0, 2.0, "the same"),
        (2.0, 2.0000001, "the same"),
        (0.0, 2.0, "smaller by 100.0 %"),
        (None, 2.0, "-"),
        (1.0, None, "-"),
        (1.0, 0.0, "-"),
        (-1.0, 2.0, "-"),
        (1.0, -2.0, "-"),
        (float("nan"), 1.0, "-"),
        (1.0, float("nan"), "-"),
    ],
)
def test_signs_are_words(value, reference, words):
    assert against(value, reference) == words


def test_decimals():
    assert against(0.596, 1.0, decimals=0) == "smaller by 40 %"
    assert against(0.997, 1.0, decimals=0) == "the same"
