"""Texts made fit to be shown."""

from __future__ import annotations

import pytest

from coaxshell.numerics.texts import percent, typeset


@pytest.mark.parametrize(
    ("plain", "printed"),
    [
        ("by -7.7 % (-32.3 %)", "by −7.7 % (−32.3 %)"),
        ("1.1e-08 % at 1e+22 N/m^3, 0.001 kg/m^3", "1.1e-8 % at 1e22 N/m³, 0.001 kg/m³"),
        ("by -0.0 %, -0.05 %, \u22120 %, 5-0, -0.00.", "by 0.0 %, −0.05 %, 0 %, 5-0, 0.00."),
        ("from 0.5-1 on, x-1, 1e-10, 1e0", "from 0.5-1 on, x-1, 1e-10, 1e0"),
    ],
)
def test_numbers_stand_as_they_are_printed(plain, printed):
    assert typeset(plain) == printed
    assert typeset(printed) == printed


@pytest.mark.parametrize(
    ("share", "given", "printed"),
    [
        (-4e-4, {}, "0.0 %"),
        (-4e-3, {"decimals": 0, "signed": True}, "0 %"),
        (0.123, {"signed": True}, "+12.3 %"),
        (-0.5, {"decimals": 0}, "-50 %"),
    ],
)
def test_nothing_has_no_sign(share, given, printed):
    assert percent(share, **given) == printed
