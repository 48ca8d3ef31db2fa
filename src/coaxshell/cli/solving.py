"""From the options of a command to a response."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import wraps
from inspect import Parameter, signature
from typing import TYPE_CHECKING, Any, Literal, TypedDict

from coaxshell.cli import options, values
from coaxshell.cli.progress import progress, tell_time

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response import Response


class Settings(TypedDict):
    """Resolution of a run as numbers."""

    duration: float
    time_step: float
    tolerance: float
    modes: int | Literal["auto"]
    engine: str
    refinement: int


@dataclass(frozen=True)
class Request:
    """The resolution options of a command, as typed; their names, help and defaults are those of every command that solves."""

    duration: options.DurationOption = "5"
    time_step: options.TimeStepOption = "1e-3"
    modes: options.ModesOption = "150"
    tolerance: options.ToleranceOption = "1e-3"
    engine: options.EngineOption = "spectral"
    refinement: options.RefinementOption = "1"

    def solve(self, system: System, *, quiet: bool) -> Response:
        """Solve the system at this resolution, showing progress; InputError names the option that is wrong."""
        from coaxshell.response import simulate
        from coaxshell.solver.cost import run_cost
        from coaxshell.solver.settings import Settings as Checked

        settings = self.settings(system)
        with values.named_as_options(), progress(quiet) as report:
            if settings["modes"] != "auto":
                tell_time(run_cost(system, Checked(**settings)), "the run", quiet)
            return simulate(system, progress=report, **settings)

    def settings(self, system: System) -> Settings:
        """Return the settings of a run of a system as numbers; InputError names the option that is wrong."""
        from coaxshell.model.durations import transits

        return {
            "duration": transits(self.duration, system, "--duration"),
            "time_step": transits(self.time_step, system, "--time-step"),
            "tolerance": values.number("--tolerance", self.tolerance),
            "modes": values.modes(self.modes),
            "engine": self.engine,
            "refinement": values.whole("--refinement", self.refinement),
        }


RESOLUTION = tuple(field.name for field in fields(Request))
"""The names of the resolution's parameters."""


def with_resolution(command: Callable[..., None]) -> Callable[..., None]:
    """Return a command whose parameter ``request`` is filled from the options of a :class:`Request`, which stand in its place."""
    parameters = signature(command, eval_str=True).parameters
    shown: list[Parameter] = []
    for parameter in parameters.values():
        if parameter.name == "request":
            shown += signature(Request, eval_str=True).parameters.values()
        else:
            shown.append(parameter)

    @wraps(command)
    def filled(**given: Any) -> None:
        request = Request(**{name: given.pop(name) for name in RESOLUTION})
        command(**given, request=request)

    told: Any = filled
    told.__signature__ = signature(command).replace(parameters=[each.replace(kind=Parameter.KEYWORD_ONLY) for each in shown])
    return filled
