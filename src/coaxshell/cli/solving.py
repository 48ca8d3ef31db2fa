"""From the options of a command to a response."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from coaxshell.cli import values
from coaxshell.cli.progress import progress

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response import Response


@dataclass(frozen=True)
class Request:
    """The resolution options of a command, as typed."""

    duration: str
    time_step: str
    modes: str
    tolerance: str
    engine: str
    refinement: str = "1"

    def solve(self, system: System, *, quiet: bool) -> Response:
        """Solve the system at this resolution, showing progress; InputError names the option that is wrong."""
        from coaxshell.response import simulate

        duration = values.number("--duration", self.duration)
        time_step = values.number("--time-step", self.time_step)
        tolerance = values.number("--tolerance", self.tolerance)
        modes = values.modes(self.modes)
        refinement = values.whole("--refinement", self.refinement)
        with values.named_as_options(), progress(quiet) as report:
            return simulate(
                system,
                duration=duration,
                time_step=time_step,
                modes=modes,
                tolerance=tolerance,
                engine=self.engine,
                refinement=refinement,
                progress=report,
            )
