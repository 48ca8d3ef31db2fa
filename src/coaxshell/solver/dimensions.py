"""What two and three dimensions can solve; whatever solves asks here first."""

from __future__ import annotations

from coaxshell.errors import InputError
from coaxshell.solver.settings import Settings


def require_dimensions(settings: Settings) -> None:
    """Raise InputError if no solver has the dimensions that a run asks for."""
    if settings.dimensions == 3:
        raise InputError("dimensions", "3 is not solved yet", "use dimensions=2")
