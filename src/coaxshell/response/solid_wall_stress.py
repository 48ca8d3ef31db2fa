"""The stresses through an elastic wall: at the points of its layers, and between them by the polynomials through these.

In three dimensions a search reads the stresses at the points of all layers by solving the waves of the run once more, for all stations at
once, and takes from the polynomials what stands between the points.

A layer's displacements are polynomials of its degree in the depth, and so, to what the degree resolves, are its stresses: those of all
points tell those of every depth. The last point of a layer lies within it by a hair.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.lobatto import interpolation
from coaxshell.response.components import SOLID
from coaxshell.response.depth_stress import DepthStress
from coaxshell.response.stations import StationMotion
from coaxshell.response.through import each_within
from coaxshell.solver.recompute import spectra_of
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.structure.elastic_depth import STRESSES, Shown
from coaxshell.structure.elastic_wall import Asked, ElasticWall

FINE = 12
"""Steps between two points of a layer."""


class SolidWallStress:
    """The stresses at any depth of an elastic wall of a run in two dimensions.

    Parameters
    ----------
    solution : ModalSolution
    shell : int

    Raises
    ------
    InputError
        If instants of the run are missing.
    """

    def __init__(self, solution: ModalSolution, shell: int) -> None:
        self.solution, self.shell = solution, shell

    @cached_property
    def _spectra(self) -> SolvedSpectra:
        return spectra_of(self.solution)

    @property
    def components(self) -> tuple[str, ...]:
        """What may be asked for."""
        return ("von_mises", *SOLID)

    def depths(self) -> list[FloatArray]:
        """Return the depths (m) of each layer, from the inside out, at which a search begins."""
        wall = self._spectra.problem.shells[self.shell]
        assert isinstance(wall, ElasticWall)
        return [self.solution.problem.scales.length * points for points in wall.points(self._spectra.modes.max_order)]

    def at(self, depths: Sequence[float], component: str) -> Iterator[DepthStress]:
        """Yield a stress at each of some depths (m)."""
        names = SOLID if component == "von_mises" else (component,)
        asked = [Asked(name, float(z)) for z in depths for name in names]  # type: ignore[arg-type]
        every = self.solution.settings.refinement
        for found in each_within(self._spectra, self.shell, asked, len(names)):
            yield DepthStress(dict(zip(names, found[..., ::every], strict=True)))

    def between(self, depths: FloatArray, fields: Sequence[DepthStress], place: int, near: slice) -> tuple[FloatArray, DepthStress]:
        """Return a stress in fine steps around one of a layer's points, the places as instants: the depths (D), and (..., D times T).

        Parameters
        ----------
        depths : ndarray
            Of the points of the layer.
        fields : sequence of DepthStress
            There.
        place : int
        near : slice
            Instants.
        """
        ends = max(place - 1, 0), min(place + 1, depths.size - 1)
        fine = np.linspace(depths[ends[0]], depths[ends[1]], 1 + FINE * (ends[1] - ends[0]))
        within = 2.0 * (fine - depths[0]) / (depths[-1] - depths[0]) - 1.0
        shares = np.stack([interpolation(depths.size - 1, float(x)) for x in within])
        modal = {}
        for name in fields[0].modal:
            there = np.stack([one.modal[name][..., near] for one in fields], axis=-2)  # (parities, orders, points, T)
            spread = shares @ there
            modal[name] = spread.reshape(*spread.shape[:2], -1)
        return fine, DepthStress(modal)


class StationWallStress(SolidWallStress):
    """The stresses at any depth of an elastic wall at a station of a run in three dimensions.

    Parameters
    ----------
    motion : StationMotion
    shell : int
    """

    def __init__(self, motion: StationMotion, shell: int) -> None:
        super().__init__(motion.solution, shell)
        self._motion = motion

    @property
    def components(self) -> tuple[str, ...]:
        """What may be asked for."""
        return ("von_mises", *STRESSES)

    def depths(self) -> list[FloatArray]:
        """Return the depths (m) of each layer, from the inside out, at which a search begins."""
        return self._motion.searched_depths(self.shell)

    def at(self, depths: Sequence[float], component: str) -> Iterator[DepthStress]:
        """Yield a stress at each of some depths (m), by the polynomials through the searched depths of its layer."""
        names: tuple[Shown, ...] = tuple(STRESSES) if component == "von_mises" else (component,)  # type: ignore[assignment, arg-type]
        per_layer = self.depths()
        for depth in depths:
            layer = next((i for i, points in enumerate(per_layer) if depth <= points[-1]), len(per_layer) - 1)
            points, found = per_layer[layer], self._motion.through_layer(self.shell, layer, names)
            if depth in points:
                values = found[:, int(np.flatnonzero(points == depth)[0])]
            else:
                values = np.einsum("d,ndpmt->npmt", interpolation(points.size - 1, _within(depth, points)), found)
            yield DepthStress(dict(zip(names, values, strict=True)))


def _within(depth: float, points: FloatArray) -> float:
    """Return the place of a depth between the first (-1) and the last (1) of a layer's points."""
    return float(min(max(2.0 * (depth - points[0]) / (points[-1] - points[0]) - 1.0, -1.0), 1.0))
