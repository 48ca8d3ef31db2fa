"""Systems solved one after another, each structure prepared only once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from coaxshell.model.gains import saturates
from coaxshell.model.system import System
from coaxshell.numerics.progress import Progress
from coaxshell.response import PreparedSystem, Response, prepare, simulate
from coaxshell.solver.settings import Settings


def structure_of(system: System) -> System:
    """Return all of a system but its absorbers: what its prepared kernels depend on."""
    return system.replace(absorbers=())


class Structures:
    """Solve systems at one resolution; neighbours that differ only in their absorbers share one prepared structure.

    An answer depends on its own system alone, to the last bit, whatever was solved before: what is shared is the same whoever
    prepared it, and a system that has no use for the kernels is solved by itself.

    Parameters
    ----------
    resolution : Settings
    prepared : PreparedSystem, optional
        A structure that is at hand already, at this resolution.
    progress : callable, optional
        Called with the fraction of each run done and the name of its stage.
    """

    def __init__(self, resolution: Settings, prepared: PreparedSystem | None = None, progress: Progress | None = None) -> None:
        self.resolution = resolution
        self._prepared = prepared
        self._structure = None if prepared is None else structure_of(prepared.system)
        self._progress = progress

    def response(self, system: System) -> Response:
        """Return the response of a system; InputError as :func:`coaxshell.response.simulate`."""
        prepares = self.resolution.engine == "spectral" and self.resolution.dimensions == 2
        if not prepares or not (system.absorber_list or saturates(system)):
            return simulate(system, progress=self._progress, settings=self.resolution)
        structure = structure_of(system)
        if self._prepared is None or self._structure != structure:
            self._prepared, self._structure = self._made(structure), structure
        return self._prepared.simulate(system.absorbers, progress=self._progress)

    def _made(self, structure: System) -> PreparedSystem:
        """Return a prepared structure: the last one retuned, which shares what the two have in common and gives the same numbers."""
        if self._prepared is not None and self.resolution.modes != "auto":  # retuning keeps the number of modes
            return self._prepared.retuned(structure)
        self._prepared = None  # let go of the old kernels before new ones are made
        return prepare(structure, progress=self._progress, settings=self.resolution)


def solve_each(
    systems: Mapping[str, System],
    resolution: Settings,
    progress: Progress | None = None,
    solve: Callable[[System], Response] | None = None,
) -> Iterator[tuple[str, Response]]:
    """Yield (name, response) of each system in turn. Neighbours that differ only in their absorbers share one prepared structure.

    Parameters
    ----------
    systems : mapping of str to System
    resolution : Settings
    progress : callable, optional
        Called with the fraction done and the name of the stage.
    solve : callable, optional
        From a system to its response, in place of :class:`Structures`.
    """
    solve = solve or Structures(resolution).response
    for number, (name, system) in enumerate(systems.items()):
        if progress:
            progress(number / len(systems), "solving")
        yield name, solve(system)
    if progress:
        progress(1.0, "solving")
