"""Files and functions stay short."""

from __future__ import annotations

import ast
import statistics

from house import PROJECT, modules, named, tree

FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)


def lines(path):
    return len(path.read_text(encoding="utf-8").splitlines())


def test_no_file_is_long():
    every = [*modules(), *sorted((PROJECT / "tests").rglob("*.py"))]
    assert len(every) > 500
    assert {named(path): count for path in every if (count := lines(path)) > 500} == {}


def test_the_median_file_is_short():
    assert statistics.median(lines(path) for path in modules()) <= 150


def long_functions(module, most):
    """Yield the functions of a file that have more lines, with how many."""
    for node in ast.walk(module):
        if isinstance(node, FUNCTIONS) and (count := node.end_lineno - node.lineno + 1) > most:
            yield f"{node.name} ({count} lines)"


def test_no_function_is_long():
    assert list(long_functions(ast.parse("def f():\n    a\n    b\ndef g(): ..."), 2)) == ["f (3 lines)"]
    assert {named(path): long for path in modules() if (long := list(long_functions(tree(path), 80)))} == {}
