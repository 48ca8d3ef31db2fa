"""What a run refuses of a system, by its dimensions: asked before the first of many runs."""

from __future__ import annotations

from coaxshell.model.system import System
from coaxshell.solver.axial.solve import require_known
from coaxshell.solver.dimensions import require_two_dimensions
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings


def require_solvable(system: System, settings: Settings) -> None:
    """Raise InputError if a system has what the dimensions asked for do not know."""
    if settings.dimensions == 3:
        require_known(dimensionless(system, dimensions=3, settings=settings), settings)
    else:
        require_two_dimensions(system, settings)
        if settings.engine == "direct":
            from coaxshell.solver.direct.solve import require_steps

            require_steps(dimensionless(system, settings=settings))
