"""The field of a three-dimensional run on a cut: one pass over its waves, then any instants that it was made for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple, Protocol

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.threads import WORKERS, map_on_threads
from coaxshell.response.fields.axial_cut import PlaneField, VolumeField, axial_histories, lines_of, rings_of
from coaxshell.response.fields.cross_cut import CircleField, RasterField, is_exact
from coaxshell.response.fields.cuts import Cut
from coaxshell.response.fields.evaluate import points_of
from coaxshell.response.fields.grids import Grid
from coaxshell.response.fields.inversion import band
from coaxshell.response.fields.mirrored import Mirrored, flow_back, in_water, mirrored
from coaxshell.response.fields.request import FieldRequest, Tell
from coaxshell.response.fields.scattered import Points, raster_radii
from coaxshell.response.fields.spatial_incident import SpatialIncident
from coaxshell.response.fields.spatial_waves import SpatialQuantity, SpatialWaves, cut_waves, own_forces_cost, with_own_forces
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.axial.solve import laplace_grid, require_known
from coaxshell.solver.scaling import Problem

_SECONDS = 90e-9
"""Of a processor's core, for an order at a wave, a node and a radius."""
_WAVE = 4e-3
"""Of a core, for a wave and a block of nodes: the walls and the fluids between them."""
_SUM = 0.4e-9
"""Of a core, for a node, an instant and a row that the inverse transform of a wave has."""


class _Scattered(Protocol):
    """A scattered field, solved."""

    def add(self, out: FloatArray, quantity: SpatialQuantity, chosen: slice) -> None:
        """Add a quantity at a slice of the instants to ``out``, (instants, z, points)."""
        ...


class _Felt(NamedTuple):
    """A scattered field, at which of the axial positions of its cut it is felt, and its points at each."""

    field: _Scattered
    felt: np.ndarray
    points: int

    def read(self, quantity: SpatialQuantity, chosen: slice, instants: int) -> FloatArray:
        """Return a quantity at a slice of the instants, (instants, z felt, points)."""
        here = np.zeros((instants, self.felt.size, self.points))
        self.field.add(here, quantity, chosen)
        return here


class CutField:
    """Quantities of the field on a cut, solved for some instants; all dimensionless.

    Parameters
    ----------
    spatial : SpatialSolution
    cut : Cut
    asked : FieldRequest
    times : ndarray, shape (T,)
        Transits.
    quantities : sequence of SpatialQuantity

    Raises
    ------
    InputError
        The run is not whole, what it needs does not fit into memory, or an inclined wave has passed the positions before t = 0.
    """

    def __init__(
        self, spatial: SpatialSolution, cut: Cut, asked: FieldRequest, times: FloatArray, quantities: Sequence[SpatialQuantity]
    ) -> None:
        require_started(spatial, cut)
        self.cut, self.asked, self.times, self.quantities = cut, asked, times, tuple(quantities)
        self._problem = spatial.problem
        self._grid = band(laplace_grid(spatial.settings), asked.resolution)
        self._scattered = None if asked.part == "incident" else self._solved(spatial, cut)
        self._sent_back = [] if asked.part == "incident" else self._images(spatial)
        self._incident = self._of_sources() if asked.part in ("total", "incident") else None

    def values(self, chosen: slice = slice(None)) -> list[FloatArray]:
        """Return the quantities at a slice of the instants, each (instants, z, points)."""
        times = self.times[chosen]
        found = [np.zeros((times.size, self.cut.z.size, self.cut.points)) for _ in self.quantities]
        for quantity, out in zip(self.quantities, found, strict=True):
            if self._scattered is not None:
                out[:, self._scattered.felt] = self._scattered.read(quantity, chosen, times.size)
        for place, scattered in self._sent_back:
            self._add_sent_back(found, times, chosen, place, scattered)
        if self._incident is not None:
            self._add_incident(found, times, *self._incident)
        if self._problem.planes is not None:
            dry = ~in_water(self._problem, self.cut.grid.radius, self.cut.grid.angle)
            for out in found:
                out[..., dry] = 0.0
        return found

    def _images(self, spatial: SpatialSolution) -> list[tuple[Mirrored, _Felt]]:
        """Return what the planes of the sea send back of the scattered wave: where it is read, and its field there."""
        cut, grid, found = self.cut, self.cut.grid, []
        for place in mirrored(self._problem, grid.radius, grid.angle, self.times, self.asked.resolution):
            there = Grid(False, grid.axes, place.radius, place.angle)
            scattered = self._solved(spatial, Cut("across" if cut.kind == "across" else "along", there, cut.z, None))
            if scattered is not None:
                found.append((place, scattered))
        return found

    def _add_sent_back(self, found: list[FloatArray], times: FloatArray, chosen: slice, place: Mirrored, scattered: _Felt) -> None:
        planes = self._problem.planes
        assert planes is not None
        read = {quantity: scattered.read(quantity, chosen, times.size) for quantity in self.quantities}
        if "radial" in read:
            read["radial"], read["angular"] = flow_back(planes, place, self.cut.grid.angle, (read["radial"], read["angular"]))
        for quantity, out in zip(self.quantities, found, strict=True):
            out[:, scattered.felt[:, None], place.at] += place.image.sign * read[quantity]

    def _solved(self, spatial: SpatialSolution, cut: Cut) -> _Felt | None:
        """Return the scattered field on a cut, None where there is none yet."""
        asked, times, quantities = self.asked, self.times, self.quantities
        waves, felt = cut_waves(spatial, self._grid, cut.z, float(times.max()), asked)
        if waves is None:
            return None
        points = points_of(cut.grid)
        exact, radii = _radii(spatial.problem, cut, asked, points)
        what = f"the field at {radii:,} radii of {len(waves.sampling.modes):,} axial wavenumbers and {times.size:,} instants"
        cost = cut_cost(waves, cut, radii, times.size, len(quantities))
        cost.require(what, "ask for fewer points, for some instants at a time, or for a coarser time_resolution")
        waves = with_own_forces(waves, spatial)
        tell: Tell = (lambda _: None) if asked.progress is None else (lambda share: asked.progress(share, "field"))  # type: ignore[misc]
        if cut.kind == "along":
            lines = lines_of(waves, asked, cut.grid, times)
            return _Felt(PlaneField(axial_histories(waves, lines, cut.points, times, quantities, tell)), felt, cut.points)
        if cut.kind == "volume":
            rings = rings_of(waves, asked, cut.grid.radii, times)
            rows = rings[-1].rows.stop if rings else 0
            volume = VolumeField(axial_histories(waves, rings, rows, times, quantities, tell), rings, cut.grid.axes[1])
            return _Felt(volume, felt, cut.points)
        if exact:
            return _Felt(CircleField.solved(waves, asked, points, times, quantities, tell), felt, cut.points)
        return _Felt(RasterField.solved(waves, asked, cut.grid, times, quantities, tell), felt, cut.points)

    def _of_sources(self) -> tuple[np.ndarray, SpatialIncident]:
        """Return the incident waves outside the outermost shell, at which points of a section: exact, (z, points)."""
        cut, grid = self.cut, self.cut.grid
        at = np.flatnonzero(grid.radius >= self._problem.head)
        radius, angle = grid.radius[at], np.radians(grid.angle[at])
        z, x = (each.ravel() for each in np.meshgrid(cut.z, radius * np.cos(angle), indexing="ij"))
        y = np.tile(radius * np.sin(angle), cut.z.size)
        smooth = self._grid if self.asked.front == "matched" else None
        return at, SpatialIncident(self._problem, x, y, z, float(self.times.max()), smooth)

    def _add_incident(self, found: list[FloatArray], times: FloatArray, at: np.ndarray, incident: SpatialIncident) -> None:
        angle, moving = np.radians(self.cut.grid.angle[at]), any(name != "pressure" for name in self.quantities)
        cos, sin = np.cos(angle), np.sin(angle)

        def add(row: int) -> None:
            instant, whole = float(times[row]), (self.cut.z.size, at.size)
            x, y, z = (each.reshape(whole) for each in incident.velocity(instant)) if moving else (0.0, 0.0, 0.0)
            for quantity, out in zip(self.quantities, found, strict=True):
                match quantity:
                    case "pressure":
                        out[row][:, at] += incident.pressure(instant).reshape(whole)
                    case "radial":
                        out[row][:, at] += cos * x + sin * y
                    case "angular":
                        out[row][:, at] += cos * y - sin * x
                    case "axial":
                        out[row][:, at] += z

        add(0)  # what a wave tabulates at first use is there before the threads start
        list(map_on_threads(add, range(1, times.size)))


def cut_cost(waves: SpatialWaves, cut: Cut, radii: int, instants: int, quantities: int = 1) -> Cost:
    """Return what the scattered field at so many radii costs, beside the values themselves."""
    orders, kept = waves.parities * (waves.sampling.max_order + 1.0), 8.0 * instants * quantities
    rows = orders * radii if cut.kind != "along" else float(cut.points)
    blocks = 16.0 * WORKERS * waves.block_size(radii) * (radii * (orders * quantities + 12.0) + rows * (cut.kind != "across"))
    held = (1.0 + WORKERS) * kept * rows
    pairs = waves.pairs(radii)
    count = float(len(waves.sampling.modes))
    seconds = (1.0 + 0.2 * (quantities - 1)) * _SECONDS * pairs * waves.parities
    seconds += _WAVE * count * -(-waves.grid.nodes.size // waves.block_size(radii))
    if cut.kind != "across":
        families = waves.families
        held *= families * count
        seconds += _SUM * families * count * rows * quantities * waves.grid.nodes.size * instants
    return Cost(blocks + held, 0.1 + seconds / WORKERS)


def field_cost(spatial: SpatialSolution, cut: Cut, asked: FieldRequest, times: FloatArray, quantities: int) -> Cost:
    """Return what a :class:`CutField` costs that is not made yet."""
    waves, _ = cut_waves(spatial, band(laplace_grid(spatial.settings), asked.resolution), cut.z, float(times.max()), asked)
    if waves is None:
        return Cost(0.0)
    _, radii = _radii(spatial.problem, cut, asked, points_of(cut.grid))
    return own_forces_cost(waves, spatial).then(cut_cost(waves, cut, radii, times.size, quantities))


def _radii(problem: Problem, cut: Cut, asked: FieldRequest, points: Points) -> tuple[bool, int]:
    """Return whether a cut is solved at its points' own radii, and how many radii it needs."""
    exact = cut.kind != "across" or is_exact(problem, asked, cut.grid, points)
    return exact, points.radius.size if exact else raster_radii(problem, asked, points.radius)


def require_started(spatial: SpatialSolution, cut: Cut) -> None:
    """Refuse runs that lack instants, and positions that an inclined plane wave has passed before t = 0."""
    spatial.at(0).need_every_instant("a field in the fluids")
    problem: Problem = spatial.problem
    ends = tuple(sorted({float(cut.z.min()) * problem.scales.length, float(cut.z.max()) * problem.scales.length}))
    try:
        require_known(problem, replace(spatial.settings, stations=ends))
    except InputError as error:
        raise InputError("z", error.problem, error.remedy.replace("stations", "positions")) from None
