"""A solution as one self-describing dataset, and back, bit by bit."""

from __future__ import annotations

import json
import platform
from collections.abc import Mapping
from dataclasses import asdict, fields
from datetime import UTC, datetime
from typing import Any

import numpy as np
import scipy

from coaxshell._version import __version__
from coaxshell.errors import InputError
from coaxshell.model.naming import shell_name
from coaxshell.model.system import System
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.labels import TRANSIT, time_coordinates
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import CAUSES, QUANTITIES, Estimates, ModalSolution

FORMAT_VERSION = 1

MODAL = ("shell", "half", "mode", "time")
ERROR = ("shell", "quantity", "cause")
ERRORS = "estimated error relative to the answer, L2 over the shell's surface and the whole time"

ARRAYS: dict[str, tuple[tuple[str, ...], str, str]] = {
    "normal": (MODAL, "a", "modal normal displacement W, positive inward: w = sum W[0] cos(m theta) + W[1] sin(m theta)"),
    "tangential": (MODAL, "a", "modal tangential displacement V: v = sum V[0] sin(m theta) - V[1] cos(m theta)"),
    "normal_rate": (MODAL, "c_e", "dW/dt"),
    "tangential_rate": (MODAL, "c_e", "dV/dt"),
    "absorber_displacement": (("absorber", "time"), "a", "displacement q of the absorbers' masses, positive inward"),
    "absorber_force": (
        ("absorber", "side", "time"),
        "rho_e c_e^2 a",
        "forces of the absorbers on the inner and outer shell they link, positive inward",
    ),
    "control_correction": (MODAL, "rho_e c_e^2", "modal pressure that saturated actuators lack against the linear control law"),
}
"""Arrays of a solution by name: dimensions, unit, meaning. Those that a solution does not carry are left out of the file."""


def to_dataset(solution: ModalSolution) -> xr.Dataset:
    """Return the solution, its scenario and its circumstances as a dataset; arrays stay dimensionless, as the solver left them."""
    variables: dict[str, xr.Variable] = {
        "scenario": xr.Variable((), solution.problem.system.to_toml_string(), {"long_name": "the whole system as TOML, in SI"}),
        "error_estimate": xr.Variable(ERROR, solution.estimates.by_cause(), {"units": "1", "long_name": ERRORS}),
    }
    for name, (dims, units, long_name) in ARRAYS.items():
        values = getattr(solution, name, None)
        if values is not None:
            variables[name] = xr.Variable(dims, values, {"units": units, "long_name": long_name})
    count = len(solution.problem.shells)
    coordinates: dict[str, xr.Variable] = {
        **time_coordinates(solution),
        "shell": xr.Variable("shell", np.arange(count), {"long_name": ", ".join(shell_name(i, count) for i in range(count))}),
        "quantity": xr.Variable("quantity", list(QUANTITIES)),
        "cause": xr.Variable("cause", list(CAUSES)),
        "mode": xr.Variable("mode", np.arange(solution.normal.shape[2]), {"long_name": "circumferential order m"}),
    }
    return xr.Dataset(variables, coordinates, _attributes(solution))


def _attributes(solution: ModalSolution) -> dict[str, Any]:
    scales = solution.problem.scales
    return {
        "title": solution.problem.system.name or "coaxshell response",
        "source": f"coaxshell {__version__}",
        "coaxshell_format_version": FORMAT_VERSION,
        "coaxshell_version": __version__,
        "numpy_version": np.__version__,
        "scipy_version": scipy.__version__,
        "python_version": platform.python_version(),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "length_scale": scales.length,
        "time_scale": scales.time,
        "pressure_scale": scales.pressure,
        "units_note": f"arrays are dimensionless: lengths in a = length_scale (m), times in {TRANSIT} = time_scale (s), pressures in "
        "rho_e c_e^2 = pressure_scale (Pa)",
        "settings": json.dumps(asdict(solution.settings)),
        "warnings": json.dumps(list(solution.warnings)),
        "timings": json.dumps(solution.timings),
    }


OURS = "give a file written by coaxshell run --output or Response.save"
"""What to do about a file that is not a saved run."""


def format_problem(attributes: Mapping[Any, Any]) -> InputError | None:
    """Return what keeps us from reading a file with these attributes: not ours, or of a newer format; None if nothing does."""
    version = attributes.get("coaxshell_format_version")
    if version is None:
        return InputError("", "was not written by coaxshell", OURS)
    if int(version) > FORMAT_VERSION:
        by = attributes.get("coaxshell_version", "of a newer version")
        return InputError("", f"has format {int(version)} of coaxshell {by}, beyond {FORMAT_VERSION} of this version", "update coaxshell")
    return None


def _estimates(dataset: xr.Dataset) -> Estimates:
    if "error_estimate" in dataset:
        found = dataset["error_estimate"]
        if found.dims != ERROR or found.sizes["quantity"] != len(QUANTITIES):
            raise ValueError(f"error_estimate has the dimensions {found.dims} and the shape {found.shape}")
        return Estimates(*(found.sel(cause=cause).to_numpy() for cause in CAUSES))
    # Files of earlier versions: one number for the time step of all shells, nothing of the march.
    orders = np.stack([dataset[f"modal_{quantity}_estimate"].to_numpy() for quantity in QUANTITIES], axis=1)
    step = np.full(orders.shape, float(dataset.attrs["time_window_estimate"]))
    return Estimates(orders, step, np.full(orders.shape, np.nan))


def from_dataset(dataset: xr.Dataset) -> ModalSolution:
    """Return the solution that a dataset holds.

    Raises
    ------
    InputError
        If the dataset is not ours, of a newer format, or its scenario is not a valid system.
    KeyError, TypeError, ValueError
        If something is missing or does not fit; the reader of files turns these into an InputError.
    """
    problem = format_problem(dataset.attrs)
    if problem is not None:
        raise problem
    known = {field.name for field in fields(ModalSolution)}
    arrays: dict[str, Any] = {name: dataset[name].to_numpy() for name in ARRAYS if name in dataset and name in known}
    for name, values in arrays.items():
        if dataset[name].dims != ARRAYS[name][0]:
            raise ValueError(f"{name} has the dimensions {dataset[name].dims} and the shape {values.shape}")
    system = System.from_toml_string(str(dataset["scenario"].item()))
    if dataset.sizes["shell"] != len(system.shells):
        raise ValueError(f"{dataset.sizes['shell']} shells in the arrays, {len(system.shells)} in the scenario")
    return ModalSolution(
        problem=dimensionless(system),
        settings=Settings(**json.loads(dataset.attrs["settings"])),
        time=dataset["time"].to_numpy(),
        estimates=_estimates(dataset),
        warnings=tuple(json.loads(dataset.attrs["warnings"])),
        timings=json.loads(dataset.attrs["timings"]),
        **arrays,
    )
