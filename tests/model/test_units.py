"""Quantities: SI numbers or text with a unit, converted exactly, refused plainly."""

from __future__ import annotations

import math
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import coaxshell.model as cx
from coaxshell.errors import InputError
from coaxshell.model.units import DIMENSIONS, USUAL, by_pint, to_si


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("6 mm", "length", 0.006),
        ("6mm", "length", 0.006),
        ("9.3 mm", "length", 0.0093),
        ("  1e-3 km ", "length", 1.0),
        (".5 in", "length", 0.0127),
        ("0.25", "length", 0.25),
        ("70 GPa", "stress", 70e9),
        ("1.314e-4 s", "time", 1.314e-4),
        ("0.1314 ms", "time", 1.314e-4),
        ("590 V/mm", "electric field", 590e3),
        ("7.8 g/cm^3", "density", 7800.0),
        ("1 g/cm3", "density", 1000.0),
        ("1000 kg m-3", "density", 1000.0),
        ("1.4 km/s", "speed", 1400.0),
        ("-25 kPa", "pressure", -25e3),
        ("5.841 nF/m", "permittivity", 5.841e-9),
        ("-4.1 C/m2", "charge density", -4.1),
        ("90 deg", "angle", 90.0),
        ("90°", "angle", 90.0),
        ("0.5 turn", "angle", 180.0),
        ("10 kg", "line mass", 10.0),
        ("10 kg/m", "line mass", 10.0),
        ("1e9 N/m", "line stiffness", 1e9),
        ("1 GN/m^2", "line stiffness", 1e9),
        ("1 MN·s/m", "line damping", 1e6),
        ("1e20 N/m^3", "line cubic stiffness", 1e20),
        ("30 %", "number", 0.3),
    ],
)
def test_text_converts_exactly(text: str, dimension: str, expected: float) -> None:
    assert to_si(text, dimension) == expected


def test_the_factors_of_usual_units_are_those_of_pint() -> None:
    assert {target: {unit: by_pint(unit, target) for unit in factors} for target, factors in USUAL.items()} == USUAL
    known = {unit for kind in DIMENSIONS.values() for unit in (kind.unit, *kind.also)}
    assert set(USUAL) == known - {""}


def test_radians_become_degrees() -> None:
    assert to_si("3.141592653589793 rad", "angle") == pytest.approx(180.0, rel=1e-15)


@pytest.mark.parametrize(
    ("value", "dimension"),
    [
        ("6 kg", "length"),
        ("3 deg", "number"),
        ("3 m/m", "angle"),
        ("6 mm mm", "length"),
        *((f"6 {mark}m", "length") for mark in "‘’“”´¿¡\x91¨¬¦"),  # the parser of units passes over all of these
        ("six mm", "length"),
        ("", "length"),
        ("nan", "length"),
        ("-inf", "length"),
        ("1e999 m", "length"),
        (True, "length"),
        (None, "length"),
        ([1.0], "length"),
        (1j, "length"),
        (10**400, "length"),
        (math.nan, "length"),
    ],
)
def test_anything_else_is_refused_with_an_example(value: object, dimension: str) -> None:
    with pytest.raises(InputError) as caught:
        to_si(value, dimension)
    assert DIMENSIONS[dimension].name in str(caught.value)


@pytest.mark.parametrize("dimension", DIMENSIONS)
def test_the_example_of_a_message_is_itself_accepted(dimension: str) -> None:
    assert math.isfinite(to_si(DIMENSIONS[dimension].example, dimension))


@settings(deadline=None, max_examples=300)
@given(st.one_of(st.text(max_size=12), st.from_regex(r"[0-9]{1,3} ?[a-zA-Z/^*().%0-9 -]{0,8}", fullmatch=True)))
def test_any_text_is_a_number_or_an_input_error(text: str) -> None:
    try:
        assert math.isfinite(to_si(text, "length"))
    except InputError as error:
        assert "\n" not in str(error)  # noqa: PT017 - either outcome is right


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_pass_unchanged(value: float) -> None:
    assert to_si(value, "length") == value
    assert to_si(repr(value), "length") == value


def test_numpy_numbers_and_arrays_are_numbers() -> None:
    ring = cx.AbsorberRing(count=np.int64(3), mass=np.float32(2), damping=np.float64(1))  # type: ignore[arg-type]
    assert (ring.count, ring.mass) == (3, 2.0)
    assert type(ring.count) is int
    pulse = cx.Sampled(time=np.linspace(0, 1, 3), pressure=np.ones(3))  # type: ignore[arg-type]
    assert pulse.time == (0.0, 0.5, 1.0)


def test_import_leaves_pint_and_numpy_alone() -> None:
    code = "import sys, coaxshell.model; sys.exit(any(name in sys.modules for name in ('pint', 'numpy', 'tomli_w')))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
