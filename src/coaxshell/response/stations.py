"""The stations of a three-dimensional run: the motion of the walls at each, and what is read there as one array."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.wall_motion import MotionSpectra, WallMotion
from coaxshell.solver.axial.solution import SpatialSolution, StationSpectra
from coaxshell.solver.axial.solve import histories_within, station_spectra
from coaxshell.solver.axial.through import searched_depths, stresses_through
from coaxshell.structure.elastic_depth import Shown
from coaxshell.structure.elastic_wall import Asked

_NAMES = {"normal": "w", "tangential": "v", "along_axis": "u"}
"""Displacements as fields are named."""
BYTES = 2**29
"""Transforms of stresses through walls that are found together."""


def joined(arrays: Sequence[xr.DataArray], known: FloatArray, chosen: Sequence[int], *, alone: bool) -> xr.DataArray:
    """Return arrays of some stations as one, dims (time, station, ...); of one alone with a scalar coordinate."""
    attributes = {"units": "m", "long_name": "axial position"}
    if alone:
        return arrays[0].assign_coords(station=xr.Variable((), known[chosen[0]], attributes))
    first = arrays[0]
    axis = first.dims.index("time") + 1 if "time" in first.dims else 0
    dims = (*first.dims[:axis], "station", *first.dims[axis:])
    values = np.stack([np.asarray(one) for one in arrays], axis=axis)
    coordinates = {**first.coords, "station": xr.Variable("station", known[list(chosen)], attributes)}
    return xr.DataArray(values, dims=dims, coords=coordinates, name=first.name, attrs=first.attrs)


class Transforms:
    """Transforms of the motion at all stations of a run: those that it kept, or made again once for all of them.

    Parameters
    ----------
    spatial : SpatialSolution
    """

    def __init__(self, spatial: SpatialSolution) -> None:
        self.spatial = spatial
        self._within: tuple[int, float, dict[str, FloatArray]] | None = None
        self._through: _Through | None = None

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy takes over: not the transforms."""
        return {"spatial": self.spatial, "_within": None, "_through": None}

    def within(self, shell: int, depth: float) -> dict[str, FloatArray]:
        """Return motion and stresses at a depth (in a) of an elastic wall at all stations; those asked for last are kept."""
        if self._within is None or self._within[:2] != (shell, depth):
            self._within = shell, depth, histories_within(self.spatial, shell, depth)
        return self._within[2]

    def through(self, shell: int, layer: int, names: tuple[Shown, ...], station: int) -> FloatArray:
        """Return stresses at the searched depths of a layer of an elastic wall at a station, Pa, shape (names, depths, parities, M + 1, T).

        The waves of the run are solved once more, for as many stations and layers as fit into :data:`BYTES`, which are kept.
        """
        kept = self._through
        if (
            kept is None
            or kept.shell != shell
            or not set(names) <= set(kept.names)
            or layer not in kept.layers
            or station not in kept.stations
        ):
            kept = self._through = self._solve_through(shell, layer, names, station)
        chosen = [kept.names.index(name) for name in names]
        return np.asarray(kept.layers[layer][chosen, :, kept.stations.index(station)])

    def _solve_through(self, shell: int, layer: int, names: tuple[Shown, ...], station: int) -> _Through:
        self._through = None
        per_layer = searched_depths(self.spatial, shell)
        first = self.spatial.fields["w"]
        one = 16.0 * len(names) * self.spatial.settings.refinement * first[0, shell].size  # bytes of a depth at a station
        last = min(self.spatial.stations.size, station + max(1, int(BYTES / (one * per_layer[layer].size))))
        stations, layers, used = range(station, last), [layer], one * per_layer[layer].size * (last - station)
        for further in [*range(layer + 1, len(per_layer)), *range(layer)]:
            used += one * per_layer[further].size * len(stations)
            if used > BYTES:
                break
            layers.append(further)
        asked = [Asked(name, float(z)) for number in layers for z in per_layer[number] for name in names]
        found = stresses_through(self.spatial, shell, asked, stations)
        parts = np.split(found, np.cumsum([len(names) * per_layer[number].size for number in layers])[:-1])
        shaped = (part.reshape(-1, len(names), *part.shape[1:]).swapaxes(0, 1) for part in parts)
        return _Through(shell, names, dict(zip(layers, shaped, strict=True)), stations)

    @property
    def at_hand(self) -> bool:
        """Whether they are there without solving the run again."""
        return self.spatial.spectra is not None or "found" in vars(self)

    @cached_property
    def found(self) -> StationSpectra:
        """All of them; InputError if instants of the run are missing."""
        return station_spectra(self.spatial)


class _Through(NamedTuple):
    """Stresses through some layers of an elastic wall at some stations, Pa: of each layer (names, depths, stations, parities, M + 1, T)."""

    shell: int
    names: tuple[Shown, ...]
    layers: dict[int, FloatArray]
    stations: range


class StationMotion(WallMotion):
    """The motion of all walls at a station of a three-dimensional run.

    Parameters
    ----------
    transforms : Transforms
        Those of the run, shared by its stations.
    station : int
        Its number.
    """

    def __init__(self, transforms: Transforms, station: int) -> None:
        super().__init__(transforms.spatial.at(station))
        self._transforms, self._station = transforms, station

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy takes over: not the transforms."""
        return {name: value for name, value in vars(self).items() if name not in ("for_rates", "spectra")}

    def within(self, shell: int, what: Shown, depth: float) -> FloatArray:
        """Return modal histories of a displacement or a stress at a depth (m) of an elastic wall, SI, (parities, M + 1, T).

        The waves of the run are solved once more for all stations and all that stands at that depth.
        """
        scales, name = self.solution.problem.scales, _NAMES.get(what, what)
        found = self._transforms.within(shell, depth / scales.length)
        if name not in found:
            return np.zeros(self.solution.normal.shape[1:])
        return np.asarray(found[name][self._station] * (scales.length if what in _NAMES else scales.pressure))

    def searched_depths(self, shell: int) -> list[FloatArray]:
        """Return the depths (m) of each layer of an elastic wall, from the inside out, at which a search begins."""
        length = self.solution.problem.scales.length
        return [length * depths for depths in searched_depths(self._transforms.spatial, shell)]

    def through_layer(self, shell: int, layer: int, names: tuple[Shown, ...]) -> FloatArray:
        """Return stresses at these depths of a layer, Pa, shape (names, depths, parities, M + 1, T); see :meth:`Transforms.through`."""
        return self._transforms.through(shell, layer, names, self._station)

    def has_rate(self, rate: int) -> bool:
        """Return whether derivatives of an order are there without solving the run again, which takes as long as the run."""
        return rate == 0 or (self.solution.whole and self._transforms.at_hand)

    @cached_property
    def for_rates(self) -> MotionSpectra:
        """Transforms of W and V at the station; InputError if instants of the run are missing."""
        found = self._transforms.found
        return MotionSpectra(found.grid, found.normal[self._station], found.tangential[self._station])
