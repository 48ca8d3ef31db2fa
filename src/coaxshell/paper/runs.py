"""Many systems solved at one resolution, each structure only once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response import PreparedSystem, Response

Report = Callable[[float, str], None]


@dataclass(frozen=True)
class Resolution:
    """Settings of a run, those of :func:`coaxshell.response.simulate`; the paper's unless given."""

    duration: float = 5.0
    time_step: float = 1e-3
    modes: int | Literal["auto"] = 150
    tolerance: float = 1e-3
    engine: str = "spectral"
    refinement: int = 1

    def up_to(self, duration: float) -> Resolution:
        """Return the same, but no longer than *duration* transits."""
        return replace(self, duration=min(self.duration, duration))


def solve_each(systems: Mapping[str, System], resolution: Resolution, progress: Report | None = None) -> Iterator[tuple[str, Response]]:
    """Yield (name, response) of each system in turn. Neighbours that differ only in their absorbers share one prepared structure.

    Parameters
    ----------
    systems : mapping of str to System
    resolution : Resolution
    progress : callable, optional
        Called with the fraction done and the name of the system in work.
    """
    from coaxshell.response import simulate

    settings = asdict(resolution)
    engine = settings.pop("engine")
    prepared: PreparedSystem | None = None
    for number, (name, system) in enumerate(systems.items()):
        if progress:
            progress(number / len(systems), "solving")
        if engine == "spectral":
            prepared = _prepared(system, settings, prepared)
            yield name, prepared.simulate(system.absorbers)
        else:
            yield name, simulate(system, engine=engine, **settings)
    if progress:
        progress(1.0, "solving")


def _prepared(system: System, settings: dict[str, object], last: PreparedSystem | None) -> PreparedSystem:
    """Return the last prepared structure if it is that of a system, else a new one."""
    from coaxshell.response import prepare

    structure = system.replace(absorbers=())
    if last is not None and last.system == structure:
        return last
    return prepare(structure, **settings)  # type: ignore[arg-type]
