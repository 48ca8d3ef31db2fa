"""Links from the documentation to the source, by file and name, follow it when it moves."""

from __future__ import annotations

import ast
import re

import pytest

from house import PACKAGE, PROJECT, tree

LINK = re.compile(r"\((?:\.\./)*src/coaxshell/([\w/]+\.py)(?:#([\w.]+))?\)")
PAGES = [*sorted((PROJECT / "docs").rglob("*.md")), PROJECT / "README.md", PROJECT / "CONTRIBUTING.md"]


def defined(path):
    """Return the names of all functions, classes, methods and constants of a file, each by its last part."""
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield node.name
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            yield from (ast.unparse(target) for target in (node.targets if isinstance(node, ast.Assign) else [node.target]))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_to_the_source_lead_somewhere(page):
    for name, definition in LINK.findall(page.read_text(encoding="utf-8")):
        assert (PACKAGE / name).is_file(), name
        assert not definition or definition.rpartition(".")[2] in defined(PACKAGE / name), f"{name}#{definition}"
