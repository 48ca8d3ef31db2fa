"""Every module and every public name tells what it is for; the version stands in one place."""

from __future__ import annotations

import ast
import importlib
import re
import tomllib

import limit_pages
import pytest

import coaxshell
from coaxshell import limits
from house import PACKAGE, PROJECT, modules, named, tree

DEFINITIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)


def undocumented(body, prefix=""):
    """Yield public functions, classes and methods without a docstring."""
    for node in body:
        if not isinstance(node, DEFINITIONS) or node.name.startswith("_"):
            continue
        decorators = {ast.unparse(decorator) for decorator in node.decorator_list}
        if ast.get_docstring(node) is None and not any("overload" in d or d.endswith(".setter") for d in decorators):
            yield prefix + node.name
        if isinstance(node, ast.ClassDef):
            yield from undocumented(node.body, f"{prefix}{node.name}.")


def test_modules_and_their_public_names_are_documented():
    assert [named(path) for path in modules() if not ast.get_docstring(tree(path))] == []
    assert {named(path): missing for path in modules() if (missing := list(undocumented(tree(path).body)))} == {}


def test_the_search_for_docstrings_sees_what_has_none():
    source = 'class A:\n    "a"\n    def b(self): ...\n    def _c(self): ...\ndef d():\n    "d"\nasync def e(): ...'
    assert list(undocumented(ast.parse(source).body)) == ["A.b", "e"]


LEANING = re.compile(r"(?:The same\b|Likewise|Ditto|Those\b|That of|Their\b|Its\b|Theirs|Of\b|As above)")
"""How a docstring begins that makes sense only after another one."""


def leaning(module):
    """Yield the names of definitions whose docstrings lean on others, with their first lines."""
    texts = ((node.name, ast.get_docstring(node) or "") for node in ast.walk(module) if isinstance(node, DEFINITIONS))
    yield from (f"{name}: {text.splitlines()[0]}" for name, text in texts if LEANING.match(text))


def test_docstrings_stand_by_themselves():
    assert list(leaning(ast.parse('def f():\n    "The same, of g."'))) == ["f: The same, of g."]
    assert {named(path): found for path in modules() if (found := list(leaning(tree(path))))} == {}


def test_every_exported_name_exists():
    for name in coaxshell.__all__:
        assert getattr(coaxshell, name) is not None
    assert set(coaxshell.__all__) <= set(dir(coaxshell))


def test_lazy_names_and_their_static_imports_agree():
    guarded = next(node for node in tree(PACKAGE / "__init__.py").body if isinstance(node, ast.If))
    static = {(node.module, alias.name) for node in guarded.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    for home, name in static:
        assert getattr(coaxshell, name) is getattr(importlib.import_module(home), name)
    assert set(coaxshell.__all__) == {name for _, name in static} | {"InputError", "PhysicsWarning", "__version__"}


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'shell_of_an_egg'"):
        _ = coaxshell.shell_of_an_egg


def test_the_version_stands_in_one_place():
    project = tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))
    assert "version" not in project["project"]
    assert project["project"]["dynamic"] == ["version"]
    assert PROJECT / project["tool"]["hatch"]["version"]["path"] == PACKAGE / "_version.py"
    version = importlib.import_module("coaxshell._version").__version__
    assert re.fullmatch(r"\d+\.\d+\.\d+([a-z.]+\d+)?", version)
    holders = [path for path in modules() if version in path.read_text(encoding="utf-8")]
    assert holders == [PACKAGE / "_version.py"]


def test_the_package_is_marked_as_typed():
    assert (PACKAGE / "py.typed").is_file()


def test_every_bound_stands_in_the_documentation():
    bounds = {name: value for name, value in vars(limits).items() if isinstance(value, limits.Limit)}
    assert {name for name, value in bounds.items() if value not in limits.TABLE} == set()
    assert len(limits.TABLE) == len(set(limits.TABLE)) == len(bounds)
    page = limit_pages.limit_table()
    for value in bounds.values():
        assert f"| {value.what} | {value.value:,} | {value.unit} |" in page
