"""From a system to its modal histories."""

from coaxshell.solver.solve import Prepared, solve

__all__ = ["Prepared", "solve"]
