"""One grammar of dotted paths: read, written, followed."""

from __future__ import annotations

import pytest

import coaxshell as cx
from coaxshell.model import presets
from coaxshell.model.overrides import entry
from coaxshell.model.paths import joined, parsed, parts, within, written

HYBRID = presets.load("hybrid")


@pytest.mark.parametrize("path", ["shells[0].layers[1].thickness", "shells.0.layers.1.thickness", " shells[0]layers[1].thickness "])
def test_brackets_and_dots_are_the_same(path):
    assert parts(path) == ["shells", "0", "layers", "1", "thickness"]
    assert entry(HYBRID, parts(path)) == HYBRID.shells[0].layers[1].thickness


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("shells.outer.radius", HYBRID.shells[1].radius),
        ("fluids.gap", HYBRID.fluids[1]),
        ("fluids[exterior].density", HYBRID.fluids[2].density),
        ("materials.PZT4.density", 7500.0),
        ("shells[2].radius", None),
        ("shells.gap.radius", None),
        ("source.nothing", None),
    ],
)
def test_entries_are_found_by_path(path, expected):
    assert entry(HYBRID, parts(path)) == expected


def test_a_path_is_written_as_it_is_read():
    location = ["shells", 0, "layers", 1, "thickness"]
    assert written(location) == "shells[0].layers[1].thickness"
    assert parts(written(location)) == [str(part) for part in location]
    assert written(["metrics", 3]) == joined("metrics", "[3]") == "metrics[3]"
    assert joined("", "radius") == joined("radius", "") == "radius"


def test_an_error_is_told_from_the_outermost_entry():
    inner = cx.InputError("[2]", "is wrong", "mend it", (cx.InputError("x", "too"),))
    outer = within("layers", inner)
    assert (outer.where, outer.also[0].where) == ("layers[2]", "layers.x")
    assert str(outer) == "layers[2]: is wrong; mend it"


@pytest.mark.parametrize("wrong", ["", " ", "..", "[]", 3, None, "x" * 201])
def test_what_is_no_path_is_told_with_an_example(wrong):
    for ask in (parsed, lambda path: HYBRID.with_overrides({path: 1.0}), lambda path: cx.sweep(HYBRID, {path: [1.0]})):
        with pytest.raises(cx.InputError, match=r"source\.peak_pressure or shells\[0\]\.radius"):
            ask(wrong)


def test_an_item_that_does_not_exist_is_told_with_those_that_do():
    for path, listing in (("shells[2].radius", "0, 1, inner, outer"), ("fluids.air", "0, 1, 2, interior, gap, exterior")):
        with pytest.raises(cx.InputError, match=f"allowed: {listing}$"):
            HYBRID.with_overrides({path: 1.0})
