"""From the options of a command to a response."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypedDict

from coaxshell.cli import values
from coaxshell.cli.progress import progress

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

        settings = self.settings()
        with values.named_as_options(), progress(quiet) as report:
            return simulate(system, progress=report, **settings)

    def settings(self) -> Settings:
        """Return the settings of a run as numbers; InputError names the option that is wrong."""
        return {
            "duration": values.number("--duration", self.duration),
            "time_step": values.number("--time-step", self.time_step),
            "tolerance": values.number("--tolerance", self.tolerance),
            "modes": values.modes(self.modes),
            "engine": self.engine,
            "refinement": values.whole("--refinement", self.refinement),
        }
