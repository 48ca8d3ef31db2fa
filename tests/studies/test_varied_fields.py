"""Fields by dotted path, and where a study goes beyond overrides."""

from __future__ import annotations

import pytest

import coaxshell as cx
from coaxshell.studies.varied_fields import field_of, varied

BARE = cx.presets.load("bare")


def test_a_gain_where_there_was_no_control():
    system = varied(BARE, {"control.derivative": -150})
    assert system.control == cx.PDControl(proportional=0, derivative=-150)
    assert field_of(BARE, "control.proportional").units == "1"


def test_a_property_of_absorbers_listed_one_by_one():
    system = BARE.replace(absorbers=[cx.Absorber(angle=a, mass=1, linear_stiffness=1e9) for a in (0, 90)])
    assert [a.mass for a in varied(system, {"absorbers.mass": "2 kg"}).absorber_list] == [2, 2]
    with pytest.raises(cx.InputError, match=r"absorbers.mass: .*-1"):
        varied(system, {"absorbers.mass": -1})


@pytest.mark.parametrize(
    ("path", "given", "value", "units"),
    [
        ("absorbers.count", 30, 30, "1"),
        ("absorbers.count", 30.0, 30, "1"),
        ("absorbers.mass", "500 g", 0.5, "kg/m"),
        ("shells.inner.layers[1].thickness", "6 mm", 0.006, "m"),
        ("materials.aluminium.density", 2800, 2800.0, "kg/m^3"),
        ("fluids[1].sound_speed", 1400, 1400.0, "m/s"),
        ("source.peak_pressure", "30 kPa", 3e4, "Pa"),
        ("control.saturation", True, True, "1"),
        ("control.field_limit", "590 V/mm", 5.9e5, "V/m"),
    ],
)
def test_fields_have_units_and_values_in_them(hybrid, path, given, value, units):
    field = field_of(hybrid, path)
    assert field.units == units
    assert field.value(given, path) == value
    assert varied(hybrid, {path: given}) == varied(hybrid, {path: value})


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("source.peak_presure", "source.peak_presure: .*did you mean 'peak_pressure'"),
        ("shells[4].radius", r"shells\[4\]"),
        ("absorber.count", "absorber: .*did you mean 'absorbers'"),
        ("materials.iron.density", "materials.iron"),
        ("", "is not a path"),
    ],
)
def test_unknown_paths(hybrid, path, message):
    with pytest.raises(cx.InputError, match=message):
        field_of(hybrid, path)


def test_wrong_units_and_values(hybrid):
    with pytest.raises(cx.InputError, match=r"over.x\[1\]: '6 kg' is not a length"):
        field_of(hybrid, "shells[0].radius").value("6 kg", "over.x[1]")
    with pytest.raises(cx.InputError, match="is not a count"):
        field_of(hybrid, "absorbers.count").value(2.5, "x")
