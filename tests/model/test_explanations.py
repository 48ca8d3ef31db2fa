"""What the entries of a description mean, read from the texts below them when it is asked for."""

from __future__ import annotations

import subprocess
import sys

import coaxshell as cx
from coaxshell.model.explanations import explanations
from coaxshell.studies.span import Span


def test_every_entry_has_the_text_below_it():
    assert explanations(cx.Elastic)["density"] == "Mass per volume (kg/m^3)."
    assert explanations(cx.Layer)["thickness"].startswith("Thickness")


def test_inherited_entries_keep_theirs():
    assert explanations(cx.PlaneShock)["angle"] == explanations(cx.SphericalShock)["angle"]


def test_descriptions_of_other_rooms_have_theirs_too():
    assert set(Span.model_fields) & set(explanations(Span))


def test_what_stands_elsewhere_adds_none():
    made_here = type("Here", (cx.Elastic,), {"__module__": "elsewhere"})
    assert explanations(made_here) == explanations(cx.Elastic)
    assert not explanations(int)


def test_no_source_is_read_before_an_explanation_is_asked_for():
    code = (
        "import linecache, coaxshell as cx; cx.presets.load('hybrid')\n"
        "print([name for name in linecache.cache if 'coaxshell' in name and not name.startswith('<')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
