"""The answer of a three-dimensional run at its stations, with names, units and coordinates."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import Late, supplied
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.progress import Progress
from coaxshell.response import absorbers, arguments, fields, storage
from coaxshell.response.response import HEAD_AND_TAIL, Response
from coaxshell.response.spatial_effort import SpatialEffort, spatial_effort
from coaxshell.response.spatial_summary import SpatialSummary, station_card, summarise_stations
from coaxshell.response.station_choice import chosen_stations
from coaxshell.response.stations import StationMotion, Transforms, joined
from coaxshell.response.tables import history_table, shortest
from coaxshell.response.thinning import some_instants, thinned_stations
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.electrodes import Segment
from coaxshell.solver.finite import require_finite_stations

if TYPE_CHECKING:
    from coaxshell.response.energy import whole_length
else:
    whole_length = Late("coaxshell.response.energy.whole_length")


class SpatialResponse(Response):
    """Hold the solution of a three-dimensional run and read it in SI, at all of its stations or at some.

    What reads a shell takes *station*: an axial position of the run or several of them, in m or as text ("70 cm"), all of them by
    default; one alone leaves no dimension. Everything else is as for :class:`Response`.

    Parameters
    ----------
    spatial : SpatialSolution
        What the solver returned, or a file held.

    Attributes
    ----------
    spatial : SpatialSolution
    """

    def __init__(self, spatial: SpatialSolution) -> None:
        require_finite_stations(spatial)
        self.spatial = spatial
        transforms = Transforms(spatial)
        self._motions = [StationMotion(transforms, i) for i in range(spatial.stations.size)]
        super().__init__(self._motions[0].solution)
        self.motion = self._motions[0]

    @property
    def stations(self) -> FloatArray:
        """Axial positions at which the run answers, m, shape (stations,)."""
        return self.spatial.stations

    @property
    def motions(self) -> list[StationMotion]:
        """What quantities of shells are read from, one a station."""
        return self._motions

    def at(self, station: Any) -> SpatialResponse:
        """Return the response at some of its stations alone: one axial position (m or text) or several."""
        chosen, _ = chosen_stations(self.stations, station)
        return self if chosen == list(range(self.stations.size)) else SpatialResponse(self.spatial.some(chosen))

    def at_instants(self, index: npt.NDArray[np.intp]) -> SpatialResponse:
        """Return the response with some of its instants alone, by number: for what is read of the shells at them."""
        return SpatialResponse(some_instants(self.spatial, index))

    def stations_read(self, station: Any) -> list[tuple[float | None, WallMotion]]:
        """Return what is read at stations, all unless some are named, with their positions (m)."""
        chosen, _ = chosen_stations(self.stations, station)
        return [(float(self.stations[i]), self.motions[i]) for i in chosen]

    def _read(self, station: Any, read: Callable[[WallMotion], xr.DataArray]) -> xr.DataArray:
        """Return what is read at each of some stations, dims (time, station, ...)."""
        chosen, alone = chosen_stations(self.stations, station)
        return joined([read(self.motions[i]) for i in chosen], self.stations, chosen, alone=alone)

    def absorber_displacement(self, station: Any = None) -> xr.DataArray:
        """Return the displacement of the absorbers' masses, m, positive inward.

        Dims (absorber, time) of point absorbers, (absorber, station, time) of line absorbers.
        """
        return absorbers.absorber_displacement(self.spatial, station)

    def absorber_force(self, station: Any = None) -> xr.DataArray:
        """Return the forces of the absorbers on their shells, positive inward.

        N of point absorbers, dims (absorber, side, time); N/m of line absorbers, dims (absorber, side, station, time).
        """
        return absorbers.absorber_force(self.spatial, station)

    def pressure(
        self,
        x: npt.ArrayLike | None = None,
        y: npt.ArrayLike | None = None,
        z: npt.ArrayLike | None = None,
        **options: Unpack[fields.SpatialPressureOptions],
    ) -> xr.DataArray:
        """Return the acoustic pressure, Pa, on a cut or in a volume: dims (time, y, x) at one z, or (time, z, x) at one y.

        All lengths in units of a, z too, unlike the stations' (m); *radius* and *angle* (degrees) may stand for x and y, with several z
        they make a volume, dims (time, z, radius, angle). *time* in transits; *part* is "total", "incident", "diffracted", "radiated" or
        "scattered". The waves of the run are solved once more.
        See :func:`coaxshell.response.fields.spatial_pressure.spatial_pressure`.
        """
        return fields.spatial_pressure(self.spatial, x, y, z, **options)

    def velocity(
        self,
        x: npt.ArrayLike | None = None,
        y: npt.ArrayLike | None = None,
        z: npt.ArrayLike | None = None,
        **options: Unpack[fields.SpatialPartOptions],
    ) -> xr.DataArray:
        """Return the particle velocity, m/s, with a dimension component of three, on the same cuts as the pressure.

        See :func:`coaxshell.response.fields.spatial_pressure.spatial_velocity`.
        """
        return fields.spatial_velocity(self.spatial, x, y, z, **options)

    def intensity(
        self,
        x: npt.ArrayLike | None = None,
        y: npt.ArrayLike | None = None,
        z: npt.ArrayLike | None = None,
        **options: Unpack[fields.SpatialFieldOptions],
    ) -> xr.DataArray:
        """Return the acoustic intensity p v, W/m^2, with a dimension component of three, on the same cuts as the pressure.

        See :func:`coaxshell.response.fields.spatial_pressure.spatial_intensity`.
        """
        return fields.spatial_intensity(self.spatial, x, y, z, **options)

    def cavitation(
        self,
        x: npt.ArrayLike | None = None,
        y: npt.ArrayLike | None = None,
        z: float = 0.0,
        **options: Unpack[fields.CavitationOptions],
    ) -> xr.Dataset:
        """Return where the water outside falls below the pressure of vapour in the cross-section at *z* (in a), as in two dimensions.

        The waves of the run are solved once more. See :func:`coaxshell.response.fields.cavitation.spatial_cavitation`.
        """
        return fields.spatial_cavitation(self.spatial, x, y, z=z, **options)

    def pressure_rms(self, region: str | int, radius: float | None = None, **options: Unpack[fields.SpatialRmsOptions]) -> xr.DataArray:
        """Return the RMS of the total pressure over the cross-section of a region at one *z* (in a, 0 unless given), Pa, dims (time,).

        See :func:`coaxshell.response.fields.spatial_rms.spatial_pressure_rms`.
        """
        return fields.spatial_pressure_rms(self.spatial, region, radius, **options)

    def summary(self, window: Sequence[float] | None = None, *, segment: Segment = None) -> SpatialSummary:  # type: ignore[override]
        """Return peaks, RMS, error estimates and warnings of every station, and the largest over all of them; print it for a table.

        See :class:`coaxshell.response.spatial_summary.SpatialSummary`.
        """
        return summarise_stations(self.spatial, self.motions, window, segment)

    def control_effort(  # type: ignore[override]
        self, *, segment: Segment = None, whole_length: bool = False, progress: Progress | None = None, **limits: float | None
    ) -> SpatialEffort:
        """Return what control costs at every station, as in two dimensions, against limits of material and amplifier.

        *whole_length* adds power and energy over the whole length, for about the work of :meth:`energy`. Print it for a table.
        See :func:`coaxshell.response.spatial_effort.spatial_effort`.
        """
        return spatial_effort(self.spatial, self.motions, segment, whole_length=whole_length, progress=progress, **limits)

    def energy(self, every: int = 10, progress: Progress | None = None) -> xr.Dataset:
        """Return every store, flow and loss of energy over the whole length of the shells and the closure residual, J.

        About half as much work as a two-dimensional balance for each of some 2 c (T + S) k_max/(2 pi) axial wavenumbers, c the speed of
        the fastest wave in c_e, whatever *every* is; *progress* is told how far it is.
        See :func:`coaxshell.response.energy.whole_length.whole_length_energy`.
        """
        return whole_length.whole_length_energy(self.spatial, every, progress)

    def without_transforms(self) -> SpatialResponse:
        """Return the response without the transforms that a run keeps: for keeping many responses at a time.

        Velocities and accelerations then take as long as the run when they are asked for, and the summary and tables leave them out.
        """
        return SpatialResponse(replace(self.spatial, spectra=None, forces=[]))

    def thin(self, every: int = 1, window: Sequence[float] | None = None) -> SpatialResponse:
        """Return the response with every so many instants of a window (start, end) in transits, for a smaller file.

        See :func:`coaxshell.response.thinning.thinned`.
        """
        return SpatialResponse(thinned_stations(self.spatial, every, window))

    def save(self, path: str | Path, *, compression: bool = False) -> Path:
        """Write the run at all its stations to one self-describing NetCDF file, whole or not at all, and return its path.

        See :func:`coaxshell.response.storage.save`.
        """
        return storage.save(self.spatial, path, compression=compression)

    def history_table(self) -> dict[str, FloatArray]:
        """Return all histories at head and tail of all stations as columns by names with z and units; those of absorbers too."""
        table = history_table(self.motions, self.stations)
        if self.system.point_absorbers:
            for number, row in enumerate(self.absorber_displacement().to_numpy()):
                table[f"absorber {number} displacement (m)"] = row
        if self.system.absorber_list:
            for number, rows in enumerate(self.absorber_displacement().to_numpy()):
                for z, row in zip(self.stations, rows, strict=True):
                    table[f"absorber {number} displacement z = {shortest(z)} m (m)"] = row
        return table

    def plot(
        self,
        quantity: str = "stress",
        shell: int | str | Sequence[int | str] | None = None,
        angle: npt.ArrayLike = HEAD_AND_TAIL,
        *,
        station: Any = None,
    ) -> Any:
        """Return a figure of a quantity against time at some stations, at most four; see :meth:`Response.plot`.

        Of more than four, unless they are named, those that are drawn are spread over all of them.
        """
        return supplied("figure_curves")(self, quantity, shell, arguments.angles(angle), station)

    def _repr_html_(self) -> str:
        return station_card(self.summary(), self.system)

    def __repr__(self) -> str:
        plain = super().__repr__().removesuffix(">").replace("<Response", "<SpatialResponse")
        return f"{plain}, {len(self.motions)} station{'s' * (len(self.motions) != 1)}>"
