"""Texts with units that would take for ever to read are refused at once."""

from __future__ import annotations

import pytest

from coaxshell.errors import InputError
from coaxshell.model.units import to_si


@pytest.mark.parametrize(
    "unit", ["9**9**9**9", "9^9^9^9", "(9)**(9)**(9)**(9)", "9⁹⁹⁹⁹⁹⁹⁹", "m**99999999", "m*" * 5000 + "m", "(" * 500 + "m" + ")" * 500]
)
def test_units_that_cannot_be_read_in_time(unit):
    with pytest.raises(InputError):
        to_si(f"1 {unit}", "length")


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [("3 N*s/m^2", "line damping", 3.0), ("2 (kN)/(m)^2", "pressure", 2e3), ("1e6 N/m**3", "line cubic stiffness", 1e6)],
)
def test_units_with_powers_still_are(text, kind, value):
    assert to_si(text, kind) == value
