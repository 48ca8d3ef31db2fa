"""Displacement of the absorbers and the forces of their links (Eqs. 6 and 7): of lines, per metre, and of points in three dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeGuard

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber, PointAbsorber
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.labels import INWARD, angle_coordinate, time_coordinates
from coaxshell.response.station_choice import chosen_stations
from coaxshell.solver.solution import ModalSolution

if TYPE_CHECKING:
    from coaxshell.solver.axial.solution import SpatialSolution

SIDES = ("inner", "outer")


def absorber_displacement(solution: ModalSolution | SpatialSolution, station: Any = None) -> xr.DataArray:
    """Return the displacement q_n of the absorbers' masses, m, positive inward; dims (absorber, time).

    Of line absorbers in three dimensions (absorber, station, time), at all stations or at some (m or text).

    Raises
    ------
    InputError
        If the system has no absorbers, or the run no such station.
    """
    attributes = {"units": "m", "long_name": "displacement of the absorber's mass", "sign": INWARD}
    if of_lines(solution):
        found = solution.problem.scales.length * _present(solution.line_displacement)
        return _along(solution, station, found.swapaxes(0, 1), ("absorber",), {}, "absorber_displacement", attributes)
    values = solution.problem.scales.length * _present(solution.absorber_displacement)
    return xr.DataArray(values, dims=("absorber", "time"), coords=_coordinates(solution), name="absorber_displacement", attrs=attributes)


def absorber_force(solution: ModalSolution | SpatialSolution, station: Any = None) -> xr.DataArray:
    """Return the forces f_n of the absorbers on the shells they link, positive inward (Eq. 7); dims (absorber, side, time).

    N/m, or N of point absorbers. Of line absorbers in three dimensions (absorber, side, station, time), at all stations or at some.

    Raises
    ------
    InputError
        If the system has no absorbers.
    """
    points = not isinstance(solution, ModalSolution) and not of_lines(solution)
    side = xr.Variable("side", list(SIDES), {"long_name": "which of the two linked shells the force acts on"})
    long_name = "force of the absorber on the shell" + ("" if points else ", per metre of length")
    attributes = {"units": "N" if points else "N/m", "long_name": long_name, "sign": f"{INWARD} on the shell"}
    if of_lines(solution):
        found = np.moveaxis(force_values(solution), 0, 2)
        return _along(solution, station, found, ("absorber", "side"), {"side": side}, "absorber_force", attributes)
    values = force_values(solution)
    coordinates = {**_coordinates(solution), "side": side}
    return xr.DataArray(values, dims=("absorber", "side", "time"), coords=coordinates, name="absorber_force", attrs=attributes)


def force_values(solution: ModalSolution | SpatialSolution) -> FloatArray:
    """Return the forces f_n of the absorbers on the shells they link without labels, which take longer to import than a preview may take.

    N/m, or N of point absorbers, (absorber, side, time); of line absorbers in three dimensions N/m, (station, absorber, side, time).

    Raises
    ------
    InputError
        If the system has no absorbers.
    """
    scales = solution.problem.scales
    if of_lines(solution):
        return scales.line_force * _present(solution.line_force)
    unit = scales.line_force if isinstance(solution, ModalSolution) else scales.force
    return unit * _present(solution.absorber_force)


def of_lines(solution: ModalSolution | SpatialSolution) -> TypeGuard[SpatialSolution]:
    """Return whether a solution is one of three dimensions whose absorbers, if it has any, are lines."""
    return not isinstance(solution, ModalSolution) and bool(solution.problem.system.absorber_list)


def _along(
    solution: SpatialSolution,
    station: Any,
    values: FloatArray,
    dims: tuple[str, ...],
    coordinates: dict[str, xr.Variable],
    name: str,
    attributes: dict[str, str],
) -> xr.DataArray:
    """Return values (..., station, time) of line absorbers at the stations asked for; of one alone without that dimension."""
    chosen, alone = chosen_stations(solution.stations, station)
    z = {"units": "m", "long_name": "axial position"}
    places = solution.stations[chosen]
    along = xr.Variable((), places[0], z) if alone else xr.Variable("station", places, z)
    kept = values[..., chosen[0], :] if alone else values[..., chosen, :]
    known = {**time_coordinates(solution.at(0)), **_places(solution.problem.system.absorber_list), **coordinates, "station": along}
    return xr.DataArray(kept, dims=(*dims, *([] if alone else ["station"]), "time"), coords=known, name=name, attrs=attributes)


def _present(values: FloatArray | None) -> FloatArray:
    if values is None or not len(values):
        raise InputError("absorbers", "this system has none", "give the system absorbers")
    return values


def _coordinates(solution: ModalSolution | SpatialSolution) -> dict[str, xr.Variable]:
    system = solution.problem.system
    if isinstance(solution, ModalSolution):
        return {**time_coordinates(solution), **_places(system.absorber_list)}
    z = np.array([one.z for one in system.point_absorbers])
    along = {"z": xr.Variable("absorber", z, {"units": "m", "long_name": "axial position"})}
    return {**time_coordinates(solution.at(0)), **_places(system.point_absorbers), **along}


def _places(fitted: Sequence[Absorber | PointAbsorber]) -> dict[str, xr.Variable]:
    angle = angle_coordinate(np.array([one.angle for one in fitted]), "absorber")
    return {"absorber": xr.Variable("absorber", np.arange(len(fitted))), "angle": angle}
