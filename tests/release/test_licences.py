"""Everything that an installation brings may be used by a BSD-3-Clause package, and the citation names this version."""

from __future__ import annotations

import re

import pytest
from licence_pages import ALLOWED, dependencies, licence, parts

import coaxshell
from house import PROJECT

CORE = sorted(dependencies("coaxshell"), key=lambda found: found.metadata["Name"].lower())


@pytest.mark.parametrize("found", CORE, ids=lambda found: found.metadata["Name"])
def test_a_core_dependency_has_an_allowed_licence(found):
    assert parts(licence(found)) <= ALLOWED, licence(found)


def test_the_walk_reaches_dependencies_of_dependencies():
    names = {found.metadata["Name"].lower() for found in CORE}
    assert {"numpy", "scipy", "matplotlib", "pandas", "contourpy"} <= names


def test_a_licence_that_is_not_allowed_is_seen():
    assert not parts("GPL-3.0-only AND MIT") <= ALLOWED
    assert not parts("not stated") <= ALLOWED
    assert parts("Apache-2.0 WITH LLVM-exception OR MIT") <= ALLOWED


def test_the_citation_names_this_version():
    text = (PROJECT / "CITATION.cff").read_text(encoding="utf-8")
    assert re.search(r'^version: "(.+)"$', text, re.MULTILINE)[1] == coaxshell.__version__
