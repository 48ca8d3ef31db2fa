"""From a system to its modal histories."""

from coaxshell.solver.solve import prepare, solve, solve_prepared

__all__ = ["prepare", "solve", "solve_prepared"]
