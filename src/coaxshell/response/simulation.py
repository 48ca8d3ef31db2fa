"""The one call from a system to its response."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal

from coaxshell import solver
from coaxshell.model.system import System
from coaxshell.response.response import Response
from coaxshell.solver.settings import Settings


def simulate(
    system: System,
    *,
    duration: float = 5.0,
    time_step: float = 1e-3,
    modes: int | Literal["auto"] = 150,
    engine: str = "spectral",
    tolerance: float = 1e-3,
    progress: Callable[[float, str], None] | None = None,
) -> Response:
    """Return the response of a system to its sources.

    Parameters
    ----------
    system : System
    duration, time_step : float
        In acoustic transit times a/c_e, a the outermost radius and c_e the sound speed outside.
    modes : int or "auto"
        Highest circumferential order M; "auto" chooses it by *tolerance*.
    engine : str
        "spectral" or "direct".
    tolerance : float
        Relative error aimed at by ``modes="auto"``.
    progress : callable, optional
        Called with the fraction done (0 to 1) and the name of the stage.

    Returns
    -------
    Response

    Raises
    ------
    InputError
        If a setting is not allowed.
    """
    settings = Settings(duration=duration, time_step=time_step, modes=modes, engine=engine, tolerance=tolerance)
    return Response(solver.solve(system, settings=settings, progress=progress))
