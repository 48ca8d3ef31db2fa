"""Put names, units and coordinates on arrays."""

from __future__ import annotations

import numpy as np

from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.finite import require_finite
from coaxshell.numerics.late import xarray as xr
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.solution import ModalSolution

TRANSIT = "a/c_e"
"""Unit of dimensionless time: one acoustic transit of the outermost radius in the exterior fluid."""

INWARD = "positive inward"
TENSION = "positive in tension"
COUNTERCLOCKWISE = "positive towards increasing angle"
ALONG_AXIS = "positive towards increasing z"


def time_coordinates(solution: ModalSolution | SpatialSolution) -> dict[str, xr.Variable]:
    """Return the coordinates ``time`` (transits) and ``time_seconds`` of a run, both along the dimension time."""
    seconds = solution.time * solution.problem.scales.time
    return {
        "time": xr.Variable("time", solution.time, {"units": TRANSIT, "long_name": "time in acoustic transits of the outer radius"}),
        "time_seconds": xr.Variable("time", seconds, {"units": "s", "long_name": "time"}),
    }


def angle_coordinate(angle: FloatArray, dimension: str = "angle") -> xr.Variable:
    """Return an angle coordinate in degrees, a scalar one for a single angle."""
    attributes = {"units": "degree", "long_name": "angle from the source direction"}
    return xr.Variable(() if angle.ndim == 0 else (dimension,), angle, attributes)


def history(
    solution: ModalSolution, values: FloatArray, angle: FloatArray, shell: int, *, name: str, long_name: str, units: str, sign: str
) -> xr.DataArray:
    """Return histories at angles on a shell as a labelled array.

    Parameters
    ----------
    solution : ModalSolution
    values : ndarray, shape (T, A)
    angle : ndarray, shape () or (A,)
        Degrees; a single angle leaves no dimension, only a scalar coordinate.
    shell : int
    name, long_name, units, sign : str
        Go into the name and the attributes; *sign* says which direction counts positive.

    Returns
    -------
    DataArray, dims (time, angle) or (time,)
    """
    require_finite(values, name, [("time", solution.time), ("angle", np.atleast_1d(angle))], "look for extreme layers or materials")
    dims = ("time", "angle") if angle.ndim else ("time",)
    label = shell_name(shell, len(solution.problem.shells))
    return xr.DataArray(
        values if angle.ndim else values[:, 0],
        dims=dims,
        coords={**time_coordinates(solution), "angle": angle_coordinate(angle)},
        name=name,
        attrs={"units": units, "long_name": long_name, "sign": sign, "shell": shell, "shell_name": label},
    )


def modal_array(
    solution: ModalSolution, values: FloatArray, shell: int, *, name: str, long_name: str, units: str, parities: tuple[str, str]
) -> xr.DataArray:
    """Return modal amplitudes of shape (parities, M + 1, T) as a labelled array, dims (half, mode, time)."""
    mode = xr.Variable("mode", np.arange(values.shape[1]), {"long_name": "circumferential order m"})
    half = xr.Variable("half", list(parities[: values.shape[0]]), {"long_name": "circumferential function of m theta"})
    return xr.DataArray(
        values,
        dims=("half", "mode", "time"),
        coords={**time_coordinates(solution), "mode": mode, "half": half},
        name=name,
        attrs={"units": units, "long_name": long_name, "shell": shell, "shell_name": shell_name(shell, len(solution.problem.shells))},
    )
