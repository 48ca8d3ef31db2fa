"""The sea in a description: what cannot be is refused in words, the rest is written, read, shown and changed."""

from __future__ import annotations

import pytest

import coaxshell as cx
from coaxshell.apps.cli.template import scenario_text
from coaxshell.errors import InputError
from coaxshell.model.sea import ATMOSPHERE, GRAVITY

BARE = cx.presets.load("bare")
PLANE = cx.PlaneShock(peak_pressure=1e4, decay_time=1e-4)
CHARGE = cx.SphericalShock(peak_pressure=1e4, decay_time=1e-4, distance=5.0)


@pytest.mark.parametrize(
    ("changes", "where", "words"),
    [
        ({"sea": {"depth": 1.0}}, "sea.depth", "rise above the surface"),
        ({"sea": {"depth": 20, "bottom": "90 cm"}}, "sea.bottom", "reach into the bottom"),
        ({"sea": {"depth": 4, "up": 0}}, "source", "lies above the surface, which is 4 m above"),
        ({"sea": {"depth": 4, "up": 180, "bottom": 3}}, "source", "lies below the bottom, which is 3 m below"),
        ({"sea": {"depth": 4, "up": 0, "surface": False}}, "source", "above the surface"),
        ({"source": PLANE, "sea": {"depth": 20}}, "source.angle", "runs along the surface"),
        ({"source": PLANE, "sea": {"depth": 20, "up": 30}}, "source.angle", "comes from above the surface"),
        ({"source": [PLANE, CHARGE], "sea": {"depth": 20, "up": 30}}, "source[0].angle", "comes from above the surface"),
        ({"source": PLANE, "sea": {"depth": 20, "up": 180, "bottom": 9}}, "source.angle", "comes from below the bottom"),
        ({"sea": {"depth": 20, "bottom": -3}}, "sea.bottom", "not allowed"),
        ({"sea": {"depth": 20, "botom": 3}}, "sea.botom", "is not an entry of Sea"),
        ({"sea": 20}, "sea", "not allowed"),
    ],
)
def test_what_cannot_be_is_refused(changes: dict[str, object], where: str, words: str) -> None:
    with pytest.raises(InputError) as found:
        BARE.replace(**changes)
    assert found.value.where == where
    assert words in str(found.value)


def test_what_can_be() -> None:
    below = PLANE.replace(angle=200.0)
    assert BARE.replace(source=below, sea=cx.Sea(depth="20 m", up=0)).sea == cx.Sea(depth=20.0, up=0.0)
    assert BARE.replace(source=PLANE, sea=cx.Sea(depth=20, surface=False, bottom="3 m")).sea.bottom == 3.0
    assert BARE.replace(sea="none").sea is None


def test_it_is_written_read_changed_and_shown() -> None:
    system = BARE.replace(sea=cx.Sea(depth=1.5, bottom=1.4, up=80))
    again = cx.System.from_toml_string(system.to_toml_string())
    assert again == system
    assert again.canonical() != BARE.canonical()
    assert "sea" not in BARE.to_toml_string()
    assert system.with_overrides({"sea.depth": "30 m"}).sea.depth == 30.0
    card = system._repr_html_()
    for words in ("axis 1.5 m deep", "rigid bottom 1.4 m below", "towards the surface", "surface 1.5 m above the axis"):
        assert words in card
    assert "1.5 m deep in the sea" in repr(system)
    assert "[sea]" in scenario_text("bare")


def test_the_water_at_rest() -> None:
    sea = cx.Sea(depth=20.0)
    assert sea.at_rest(0.0, 1025.0) == ATMOSPHERE + 1025.0 * GRAVITY * 20.0
    assert sea.at_rest(20.0, 1025.0) == ATMOSPHERE
    assert sea.replace(hydrostatic=False).at_rest(0.0, 1025.0) == ATMOSPHERE
