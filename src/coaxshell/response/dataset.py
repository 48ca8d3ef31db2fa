"""A solution as one self-describing dataset, with a checksum."""

from __future__ import annotations

import hashlib
import json
import platform
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Any

import numpy as np
import scipy

from coaxshell._version import __version__
from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.identity import NUMERICS_VERSION
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.labels import TRANSIT, time_coordinates
from coaxshell.solver.solution import QUANTITIES, ModalSolution

FORMAT_VERSION, SPATIAL_VERSION = 2, 3
"""Of runs in two and in three dimensions. 1: without a checksum."""

MODAL = ("shell", "half", "mode", "time")
ERROR = ("shell", "quantity", "cause")
ERRORS = "estimated error relative to the answer, L2 over the shell's surface and the whole time"

ARRAYS: dict[str, tuple[tuple[str, ...], str, str]] = {
    "normal": (MODAL, "a", "modal normal displacement W, positive inward: w = sum W[0] cos(m theta) + W[1] sin(m theta)"),
    "tangential": (MODAL, "a", "modal tangential displacement V: v = sum V[0] sin(m theta) - V[1] cos(m theta)"),
    "hoop": (MODAL, "rho_e c_e^2", "modal hoop stress of elastic walls at their design depths, positive in tension; 0 of other walls"),
    "potentials": (("piezoelectric_layer", *MODAL), "V", "modal open-circuit voltages of elastic walls' piezoelectric layers"),
    "normal_rate": (MODAL, "c_e", "dW/dt"),
    "tangential_rate": (MODAL, "c_e", "dV/dt"),
    "absorber_displacement": (("absorber", "time"), "a", "displacement q of the absorbers' masses, positive inward"),
    "absorber_force": (
        ("absorber", "side", "time"),
        "rho_e c_e^2 a",
        "forces of the absorbers on the inner and outer shell they link, positive inward",
    ),
    "control_correction": (MODAL, "rho_e c_e^2", "modal pressure that saturated actuators lack against the linear control law"),
    "control_voltage": (MODAL, "V", "modal voltage that the control law asks for"),
    "segment_voltage": (("shell", "segment", "time"), "V", "voltages of the segments of electrodes"),
}
"""Arrays of a solution by name: dimensions, unit, meaning. Those that a solution does not carry are left out of the file."""

OURS = "give a file written by coaxshell run --output or Response.save"
"""What to do about a file that is not a saved run."""


def to_dataset(solution: ModalSolution) -> xr.Dataset:
    """Return the solution, its scenario and its circumstances as a dataset; arrays stay dimensionless, as the solver left them."""
    arrays = {
        name: xr.Variable(dims, values, {"units": units, "long_name": long_name})
        for name, (dims, units, long_name) in ARRAYS.items()
        if (values := getattr(solution, name, None)) is not None
    }
    return described(solution, arrays, {}, _attributes(solution, FORMAT_VERSION))


def to_spatial_dataset(solution: ModalSolution, arrays: Mapping[str, xr.Variable], station: FloatArray, sampling: str) -> xr.Dataset:
    """Return the arrays of all stations of a run in three dimensions with what describes it.

    Parameters
    ----------
    solution : ModalSolution
        That of one of its stations.
    arrays : mapping of name to Variable
    station : ndarray, shape (stations,)
        z, m.
    sampling : str
        The axial wavenumbers, as JSON.
    """
    axis = {"station": xr.Variable("station", station, {"units": "m", "long_name": "axial position z"})}
    return described(solution, arrays, axis, {**_attributes(solution, SPATIAL_VERSION), "axial_sampling": sampling})


def described(
    solution: ModalSolution, arrays: Mapping[str, xr.Variable], axes: Mapping[str, xr.Variable], attributes: Mapping[str, Any]
) -> xr.Dataset:
    """Return arrays with the scenario, estimates and coordinates of a solution, further *axes*, attributes and a checksum over all."""
    variables: dict[str, xr.Variable] = {
        "scenario": xr.Variable((), solution.problem.system.to_toml_string(), {"long_name": "the whole system as TOML, in SI"}),
        "error_estimate": xr.Variable(ERROR, solution.estimates.by_cause(), {"units": "1", "long_name": ERRORS}),
        **arrays,
    }
    count = len(solution.problem.shells)
    coordinates: dict[str, xr.Variable] = {
        **time_coordinates(solution),
        "shell": xr.Variable("shell", np.arange(count), {"long_name": ", ".join(shell_name(i, count) for i in range(count))}),
        "quantity": xr.Variable("quantity", list(QUANTITIES)),
        "cause": xr.Variable("cause", list(solution.estimates.causes)),
        "mode": xr.Variable("mode", np.arange(solution.normal.shape[2]), {"long_name": "circumferential order m"}),
        **axes,
    }
    dataset = xr.Dataset(variables, coordinates, attributes)
    sealed = {name: dataset[name].to_numpy() for name in ("time", "error_estimate", *axes, *arrays)}
    dataset.attrs["checksum"] = checksum(sealed, str(dataset["scenario"].item()), dataset.attrs)
    return dataset


def checksum(arrays: Mapping[str, FloatArray], scenario: str, attributes: Mapping[Any, Any]) -> str:
    """Return the digest of all that a run consists of: arrays bit by bit, the scenario, settings, estimates and warnings."""
    digest = hashlib.sha256()
    texts = {"scenario": scenario, **{name: attributes[name] for name in ("settings", "warnings", "axial_sampling") if name in attributes}}
    digest.update(json.dumps(texts, sort_keys=True).encode())
    for name in sorted(arrays):
        values = np.ascontiguousarray(arrays[name], "<f8")
        digest.update(f"{name} {values.shape}".encode())
        digest.update(values.data)
    return f"sha256 {digest.hexdigest()}"


def _attributes(solution: ModalSolution, version: int) -> dict[str, Any]:
    scales = solution.problem.scales
    return {
        "title": solution.problem.system.name or "coaxshell response",
        "source": f"coaxshell {__version__}",
        "coaxshell_format_version": version,
        "coaxshell_version": __version__,
        "numerics_version": NUMERICS_VERSION,
        "numpy_version": np.__version__,
        "scipy_version": scipy.__version__,
        "python_version": platform.python_version(),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "length_scale": scales.length,
        "time_scale": scales.time,
        "pressure_scale": scales.pressure,
        "units_note": f"arrays are dimensionless: lengths in a = length_scale (m), times in {TRANSIT} = time_scale (s), pressures in "
        "rho_e c_e^2 = pressure_scale (Pa)",
        "settings": json.dumps(solution.settings.arguments()),
        "warnings": json.dumps(list(solution.warnings)),
        "timings": json.dumps(solution.timings),
    }
