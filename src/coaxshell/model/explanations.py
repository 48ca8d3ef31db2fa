"""What the entries of a description mean: the texts below them in the source, read when they are asked for.

Reading them while the classes are made, which is pydantic's own way, took a fifth of the time that importing the model takes, and
no run needs them.
"""

from __future__ import annotations

import ast
import inspect
import sys
from collections.abc import Mapping
from functools import cache
from itertools import pairwise


@cache
def explanations(model: type) -> Mapping[str, str]:
    """Return the explanation of each entry of a description by its name, inherited ones included; empty without the source."""
    found: dict[str, str] = {}
    for part in reversed(model.__mro__):
        if part.__module__.partition(".")[0] == __name__.partition(".")[0]:
            found |= _of_module(part.__module__).get(part.__qualname__, {})
    return found


@cache
def _of_module(name: str) -> Mapping[str, Mapping[str, str]]:
    """Return the texts below the annotated names of each class at the top of a module."""
    try:
        tree = ast.parse(inspect.getsource(sys.modules[name]))
    except OSError:  # an installation without sources
        return {}
    return {node.name: dict(_texts(node.body)) for node in tree.body if isinstance(node, ast.ClassDef)}


def _texts(body: list[ast.stmt]) -> list[tuple[str, str]]:
    found = []
    for entry, below in pairwise(body):
        match entry, below:
            case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                found.append((name, inspect.cleandoc(text)))
    return found
