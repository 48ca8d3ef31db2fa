"""From a system to its modal histories."""

from coaxshell.solver.solve import solve

__all__ = ["solve"]
