"""The package's source files, parsed."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

import coaxshell

PACKAGE = Path(coaxshell.__file__).parent
PROJECT = Path(__file__).parents[2]


def modules(*, inside_rooms: bool = False) -> list[Path]:
    """Return the package's source files, or only those inside its rooms."""
    paths = sorted(path for path in PACKAGE.rglob("*.py") if "__pycache__" not in path.parts)
    return [path for path in paths if path.parent != PACKAGE or path.name == "apps/cli.py"] if inside_rooms else paths


def named(path: Path) -> str:
    """Return how a test that looks at all files names one of them."""
    return path.relative_to(PACKAGE if PACKAGE in path.parents else PROJECT).as_posix()


@cache
def tree(path: Path) -> ast.Module:
    """Return the syntax tree of a file."""
    return ast.parse(path.read_text(encoding="utf-8"), filename=str(path))
