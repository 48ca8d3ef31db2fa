"""What a system shows in a notebook: the drawing is to scale, nothing comes from outside, and text is escaped."""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ElementTree

import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.model.display import cross_section
from coaxshell.model.display.drawing import ROLE_COLOURS, wall_factor

SVG = "{http://www.w3.org/2000/svg}"
PIXELS_PER_A = 300 / 2 / 1.75


def circles(system: cx.System) -> list[dict[str, str]]:
    return [dict(one.attrib) for one in ElementTree.fromstring(cross_section(system)).iter(f"{SVG}circle")]


def test_walls_are_to_scale_but_for_the_factor_that_the_drawing_states():
    system = cx.presets.load("bare")
    layers = [one for one in circles(system) if one.get("fill") == "none"]
    factor = wall_factor(system)
    assert len(layers) == 6
    assert [one["stroke"] for one in layers[:3]] == [ROLE_COLOURS[role] for role in ("sensor", "core", "actuator")]
    assert_allclose([float(layers[i]["r"]) for i in (1, 4)], [0.5 * PIXELS_PER_A, PIXELS_PER_A], rtol=1e-3)
    assert_allclose(float(layers[4]["stroke-width"]), factor * 6e-3 * PIXELS_PER_A, rtol=1e-2)
    assert f"walls drawn {factor:.3g} times as thick" in cross_section(system)


def test_exaggerated_walls_never_touch():
    wall = [cx.Layer("aluminium", "10 mm")]
    system = cx.System(
        shells=[cx.Shell(radius=0.97, layers=wall), cx.Shell(radius=1.0, layers=wall)],
        fluids=["vacuum", "freshwater", "freshwater"],
        source=cx.PlaneShock(peak_pressure=1e5, decay_time=1e-4),
    )
    inner, outer = (one for one in circles(system) if one.get("fill") == "none")
    gap = float(outer["r"]) - float(outer["stroke-width"]) / 2 - float(inner["r"]) - float(inner["stroke-width"]) / 2
    assert wall_factor(system) > 1
    assert gap > 0


def test_a_thick_wall_is_drawn_as_it_is():
    system = cx.System(
        shells=[cx.Shell(radius=1.0, layers=[cx.Layer("aluminium", 0.3)])],
        fluids=["vacuum", "freshwater"],
        source=cx.PlaneShock(peak_pressure=1e5, decay_time=1e-4),
    )
    assert wall_factor(system) == 1.0
    assert "to scale" in cross_section(system)


def test_absorbers_sit_at_their_angles_counted_from_the_source():
    system = cx.presets.load("absorbers")
    marks = [(float(one["cx"]), -float(one["cy"])) for one in circles(system) if one.get("fill") == "currentColor"]
    assert len(marks) == 25
    angles = [math.degrees(math.atan2(y, x)) % 360 for x, y in marks]
    assert_allclose(angles, [14.4 * k for k in range(25)], atol=0.2, rtol=0)


@pytest.mark.parametrize("angle", [0.0, 60.0])
def test_the_front_comes_from_the_source(angle):
    system = cx.presets.load("iakovlev-evacuated")
    turned = system.with_overrides({"source.angle": angle})
    assert f'rotate({-angle:g})"' in cross_section(turned)


def test_a_source_within_the_picture_is_marked_where_it_is():
    system = cx.presets.load("bare").with_overrides({"source.distance": 1.5})
    mark = circles(system)[-1]
    assert_allclose(float(mark["cx"]), 1.5 * PIXELS_PER_A, atol=0.06, rtol=0)


@pytest.mark.parametrize("name", cx.presets.names())
def test_every_preset_shows_itself_and_needs_nothing_from_outside(name):
    text = cx.presets.load(name)._repr_html_()
    ElementTree.fromstring(f"<page>{text}</page>")
    assert re.findall(r"https?://(?!www\.w3\.org/2000/svg)", text) == []
    assert "<script" not in text
    assert name in text


def mass(system: cx.System) -> float:
    """Return x of the only absorber's mass, in pixels."""
    (place,) = (float(one["cx"]) for one in circles(system) if one.get("fill") == "currentColor")
    return place


def test_absorbers_are_drawn_from_shell_to_shell_with_the_mass_in_the_outermost_gap():
    bare = cx.presets.load("bare")
    inner, outer = bare.shells
    rod = {"mass": 10, "linear_stiffness": 1e9}
    three = bare.replace(shells=[inner, inner.replace(radius=0.75), outer], fluids=[bare.exterior] * 4)
    past, beside = (three.replace(absorbers=[cx.Absorber(**rod, **more)]) for more in ({"outer_shell": 2}, {"inner_shell": 1}))
    drawn, other = cross_section(past), cross_section(beside)
    (from_inner,), (from_middle,) = (re.findall(r'<path d="M(\S+) \S+L\S+ \S+" stroke="currentColor"', one) for one in (drawn, other))
    assert float(from_inner) < 0.6 * PIXELS_PER_A < 0.75 * PIXELS_PER_A < float(from_middle)
    assert mass(past) == mass(beside)
    assert "from inner to outer" in past._repr_html_()
    alone = bare.replace(shells=[outer], fluids=bare.fluids[1:], absorbers=[cx.Absorber(**rod, links="outer")])
    assert_allclose(mass(alone), 0.75 * PIXELS_PER_A, rtol=0.05)


def test_names_are_escaped():
    text = cx.presets.load("bare").replace(name="<b>&")._repr_html_()
    assert "<b>&lt;b&gt;&amp;</b>" in text


def test_the_table_names_what_is_there():
    text = cx.presets.load("hybrid").with_overrides({"control.saturation": True})._repr_html_()
    for words in ("6 mm aluminium, core", "spherical shock, 5 m from the axis", "25, every 14.4°", "stops at the field limit"):
        assert words in text
    rigid = cx.System(
        shells=[cx.RigidShell(radius=1.0)], fluids=["vacuum", "freshwater"], source=cx.PlaneShock(peak_pressure=1e5, decay_time=1e-4)
    )
    assert "rigid, radius 1 m" in rigid._repr_html_()


def test_the_table_says_where_fluids_wet_a_wall():
    system = cx.presets.load("bare")
    assert "wetted" not in system._repr_html_()
    faces = system.replace_path("shells.outer.wetted", "faces")
    assert "12 mm thick, wetted at its faces" in faces._repr_html_()
