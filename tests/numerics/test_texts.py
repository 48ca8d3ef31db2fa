"""Texts made fit to be shown."""

from __future__ import annotations

import pytest

from coaxshell.numerics.texts import typeset


@pytest.mark.parametrize(
    ("plain", "printed"),
    [
        ("by -7.7 % (-32.3 %)", "by −7.7 % (−32.3 %)"),
        ("1.1e-08 % at 1e+22 N/m^3, 0.001 kg/m^3", "1.1e-8 % at 1e22 N/m³, 0.001 kg/m³"),
        ("from 0.5-1 on, x-1, 1e-10, 1e0", "from 0.5-1 on, x-1, 1e-10, 1e0"),
    ],
)
def test_numbers_stand_as_they_are_printed(plain, printed):
    assert typeset(plain) == printed
    assert typeset(printed) == printed
