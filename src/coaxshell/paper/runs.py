"""Many systems solved at one resolution, each structure only once: the studies' way, under the names that the recipes use."""

from __future__ import annotations

from coaxshell.studies.resolution import Resolution
from coaxshell.studies.structures import Report, solve_each

__all__ = ["Report", "Resolution", "solve_each"]
