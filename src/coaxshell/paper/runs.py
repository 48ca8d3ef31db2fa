"""Many systems solved at one resolution, each structure only once: the studies' way, under the names that the recipes use."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

from coaxshell.numerics.progress import Progress
from coaxshell.studies.resolution import Resolution
from coaxshell.studies.structures import solve_each

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response import Response

Solver = Callable[["Mapping[str, System]", Resolution, "Progress | None"], "Iterator[tuple[str, Response]]"]
"""Solves systems in turn; :func:`solve_each` or one with slips turned on."""

__all__ = ["Progress", "Resolution", "Solver", "solve_each"]
