"""Displacement of point absorbers and the forces of their links, in three dimensions."""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.absorbers import SIDES
from coaxshell.response.labels import INWARD, angle_coordinate, time_coordinates
from coaxshell.solver.axial.solution import SpatialSolution


def _present(values: FloatArray | None) -> FloatArray:
    if values is None or not len(values):
        raise InputError("absorbers", "this system has none", "give the system point absorbers")
    return values


def _coordinates(spatial: SpatialSolution) -> dict[str, xr.Variable]:
    fitted = spatial.problem.system.point_absorbers
    return {
        **time_coordinates(spatial.at(0)),
        "absorber": xr.Variable("absorber", np.arange(len(fitted))),
        "angle": angle_coordinate(np.array([one.angle for one in fitted]), "absorber"),
        "z": xr.Variable("absorber", np.array([one.z for one in fitted]), {"units": "m", "long_name": "axial position"}),
    }


def point_absorber_displacement(spatial: SpatialSolution) -> xr.DataArray:
    """Return the displacement q_n of the absorbers' masses, m, positive inward; dims (absorber, time).

    Raises
    ------
    InputError
        If the system has no absorbers.
    """
    values = spatial.problem.scales.length * _present(spatial.absorber_displacement)
    attributes = {"units": "m", "long_name": "displacement of the absorber's mass", "sign": INWARD}
    return xr.DataArray(values, dims=("absorber", "time"), coords=_coordinates(spatial), name="absorber_displacement", attrs=attributes)


def point_absorber_force(spatial: SpatialSolution) -> xr.DataArray:
    """Return the forces of the absorbers on the shells they link, N, positive inward; dims (absorber, side, time).

    Raises
    ------
    InputError
        If the system has no absorbers.
    """
    values = spatial.problem.scales.force * _present(spatial.absorber_force)
    side = xr.Variable("side", list(SIDES), {"long_name": "which of the two linked shells the force acts on"})
    attributes = {"units": "N", "long_name": "force of the absorber on the shell", "sign": f"{INWARD} on the shell"}
    coordinates = {**_coordinates(spatial), "side": side}
    return xr.DataArray(values, dims=("absorber", "side", "time"), coords=coordinates, name="absorber_force", attrs=attributes)
