"""Displacement of the absorbers and the forces of their links (Eqs. 6 and 7): of lines, per metre, and of points in three dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber, PointAbsorber
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.labels import INWARD, angle_coordinate, time_coordinates
from coaxshell.solver.solution import ModalSolution

if TYPE_CHECKING:
    from coaxshell.solver.axial.solution import SpatialSolution

SIDES = ("inner", "outer")


def absorber_displacement(solution: ModalSolution | SpatialSolution) -> xr.DataArray:
    """Return the displacement q_n of the absorbers' masses, m, positive inward; dims (absorber, time).

    Raises
    ------
    InputError
        If the system has no absorbers.
    """
    values = solution.problem.scales.length * _present(solution.absorber_displacement)
    attributes = {"units": "m", "long_name": "displacement of the absorber's mass", "sign": INWARD}
    return xr.DataArray(values, dims=("absorber", "time"), coords=_coordinates(solution), name="absorber_displacement", attrs=attributes)


def absorber_force(solution: ModalSolution | SpatialSolution) -> xr.DataArray:
    """Return the forces f_n of the absorbers on the shells they link, positive inward (Eq. 7); dims (absorber, side, time).

    N/m, or N of point absorbers.

    Raises
    ------
    InputError
        If the system has no absorbers.
    """
    scales, points = solution.problem.scales, not isinstance(solution, ModalSolution)
    values = (scales.force if points else scales.line_force) * _present(solution.absorber_force)
    side = xr.Variable("side", list(SIDES), {"long_name": "which of the two linked shells the force acts on"})
    long_name = "force of the absorber on the shell" + ("" if points else ", per metre of length")
    attributes = {"units": "N" if points else "N/m", "long_name": long_name, "sign": f"{INWARD} on the shell"}
    coordinates = {**_coordinates(solution), "side": side}
    return xr.DataArray(values, dims=("absorber", "side", "time"), coords=coordinates, name="absorber_force", attrs=attributes)


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
