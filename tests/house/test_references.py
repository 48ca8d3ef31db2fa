"""Links from the documentation to the source, by file and name, follow it when it moves."""

from __future__ import annotations

import ast
import re
from functools import cache

from house import PACKAGE, PROJECT, named, tree

LINK = re.compile(r"\((?:\.\./)*src/coaxshell/([\w/]+\.py)(?:#([\w.]+))?\)")
PAGES = [*sorted((PROJECT / "docs").rglob("*.md")), PROJECT / "README.md", PROJECT / "CONTRIBUTING.md"]


@cache
def defined(path):
    """Return the names of all functions, classes, methods and constants of a file, each by its last part."""
    found = set()
    for node in ast.walk(tree(path)):
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found.add(node.name)
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            found |= {ast.unparse(target) for target in (node.targets if isinstance(node, ast.Assign) else [node.target])}
    return found


def broken(page):
    """Yield the links of a page to files or definitions that do not exist."""
    for name, definition in LINK.findall(page.read_text(encoding="utf-8")):
        if not (PACKAGE / name).is_file() or (definition and definition.rpartition(".")[2] not in defined(PACKAGE / name)):
            yield f"{name}#{definition}"


def test_links_to_the_source_lead_somewhere():
    assert {named(page): lost for page in PAGES if (lost := list(broken(page)))} == {}


def test_the_search_for_links_sees_those_that_lead_nowhere(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("[a](../src/coaxshell/errors.py#InputError) [b](src/coaxshell/errors.py#Egg) [c](src/coaxshell/egg.py)")
    assert list(broken(page)) == ["errors.py#Egg", "egg.py#"]


def test_formulas_are_written_in_environments_that_the_pages_know():
    """The converter to MathML writes the ampersands of others, such as aligned, as letters, and the build of the pages refuses them."""
    used = {page: set(re.findall(r"\\begin\{([^}]+)\}", page.read_text(encoding="utf-8"))) for page in PAGES}
    assert {"array", "cases"} <= set().union(*used.values())
    assert {named(page): names for page, found in used.items() if (names := found - {"array", "cases", "pmatrix"})} == {}
