"""Displacement of the absorbers and the forces of their links (Eqs. 6 and 7)."""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.labels import INWARD, angle_coordinate, time_coordinates
from coaxshell.solver.solution import ModalSolution

SIDES = ("inner", "outer")


def _present(values: FloatArray | None) -> FloatArray:
    if values is None or not len(values):
        raise InputError("absorbers", "this system has none", "give the system absorbers")
    return values


def _coordinates(solution: ModalSolution) -> dict[str, xr.Variable]:
    fitted = solution.problem.system.absorber_list
    return {
        **time_coordinates(solution),
        "absorber": xr.Variable("absorber", np.arange(len(fitted))),
        "angle": angle_coordinate(np.array([absorber.angle for absorber in fitted]), "absorber"),
    }


def absorber_displacement(solution: ModalSolution) -> xr.DataArray:
    """Return the displacement q_n of the absorbers' masses, m, positive inward; dims (absorber, time).

    Raises
    ------
    InputError
        If the system has no absorbers.
    """
    values = solution.problem.scales.length * _present(solution.absorber_displacement)
    attributes = {"units": "m", "long_name": "displacement of the absorber's mass", "sign": INWARD}
    return xr.DataArray(values, dims=("absorber", "time"), coords=_coordinates(solution), name="absorber_displacement", attrs=attributes)


def absorber_force(solution: ModalSolution) -> xr.DataArray:
    """Return the line forces f_n of the absorbers on the shells they link, N/m, positive inward (Eq. 7); dims (absorber, side, time).

    Raises
    ------
    InputError
        If the system has no absorbers.
    """
    values = solution.problem.scales.line_force * _present(solution.absorber_force)
    side = xr.Variable("side", list(SIDES), {"long_name": "which of the two linked shells the force acts on"})
    attributes = {"units": "N/m", "long_name": "force of the absorber on the shell, per metre of length", "sign": f"{INWARD} on the shell"}
    coordinates = {**_coordinates(solution), "side": side}
    return xr.DataArray(values, dims=("absorber", "side", "time"), coords=coordinates, name="absorber_force", attrs=attributes)
