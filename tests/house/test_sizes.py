"""Files and functions stay short."""

from __future__ import annotations

import ast
import statistics

import pytest

from house import PROJECT, modules, tree

FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


def lines(path):
    return len(path.read_text(encoding="utf-8").splitlines())


@pytest.mark.parametrize("path", [*modules(), *sorted((PROJECT / "tests").rglob("*.py"))], ids=lambda path: "/".join(path.parts[-2:]))
def test_no_file_is_long(path):
    assert lines(path) <= 500


def test_the_median_file_is_short():
    assert statistics.median(lines(path) for path in modules()) <= 150


@pytest.mark.parametrize("path", modules(), ids=lambda path: "/".join(path.parts[-2:]))
def test_no_function_is_long(path):
    long = [
        f"{node.name} ({node.end_lineno - node.lineno + 1} lines)"
        for node in ast.walk(tree(path))
        if isinstance(node, FUNCTIONS) and node.end_lineno - node.lineno + 1 > 80
    ]
    assert not long
