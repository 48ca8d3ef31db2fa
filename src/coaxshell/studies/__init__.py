"""Many cases of one system: sweeps, with what they share done once, on one machine or a cluster."""

from __future__ import annotations

from coaxshell.studies.resolution import Resolution
from coaxshell.studies.structures import solve_each

__all__ = ["Resolution", "solve_each"]
