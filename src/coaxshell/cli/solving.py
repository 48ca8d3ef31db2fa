"""From the options of a command to a response."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, fields
from functools import wraps
from inspect import Parameter, signature
from typing import TYPE_CHECKING, Any

from coaxshell.cli import options, values
from coaxshell.cli.progress import progress, tell_time

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response import Response
    from coaxshell.solver.settings import Settings


@dataclass(frozen=True)
class Request:
    """The resolution options of a command, as typed; their names, help and defaults are those of every command that solves.

    The defaults are the texts of :class:`coaxshell.solver.settings.Settings`', which takes too long to import for a page of help.
    """

    duration: options.DurationOption = options.DURATION
    time_step: options.TimeStepOption = options.TIME_STEP
    modes: options.ModesOption = options.MODES
    tolerance: options.ToleranceOption = "1e-3"
    engine: options.EngineOption = "spectral"
    refinement: options.RefinementOption = "1"

    def solve(self, system: System, *, quiet: bool) -> Response:
        """Solve the system at this resolution, showing progress; InputError names the option that is wrong."""
        from coaxshell.response import simulate
        from coaxshell.solver.cost import run_cost

        settings = self.settings(system)
        with values.named_as_options(), progress(quiet) as report:
            if settings.modes != "auto":
                tell_time(run_cost(system, settings), "the run", quiet)
            return simulate(system, settings=settings, progress=report)

    def settings(self, system: System) -> Settings:
        """Return the settings of a run of a system; InputError names the option that is wrong."""
        return settings_of(system, asdict(self))


def settings_of(system: System, given: Mapping[str, str]) -> Settings:
    """Return the settings that the texts of some options describe; InputError names the option that is wrong."""
    from coaxshell.solver.settings import Settings

    with values.named_as_options():
        return Settings.of(system, given)


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
