"""A run in three dimensions as arrays of a file, and back: the fields at its stations, and the transforms that rates are read from."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.late import xarray as xr
from coaxshell.response import restored
from coaxshell.response.dataset import ERROR, checksum, to_spatial_dataset
from coaxshell.response.thinning import with_missing
from coaxshell.solver.axial.normals import piezoelectric_layers
from coaxshell.solver.axial.sampling import MOST_WAVES, AxialSampling
from coaxshell.solver.axial.solution import LINES, SpatialSolution, StationSpectra
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solid_spectra import band
from coaxshell.solver.solution import QUANTITIES, Estimates
from coaxshell.structure.shell_model import SOLID_STRESSES

if TYPE_CHECKING:
    from coaxshell.response.foreign import ForeignFile

SPATIAL_MODAL = ("station", "shell", "half", "mode", "time")
TRANSFORM = ("station", "shell", "half", "mode", "node", "part")

FIELDS: dict[str, tuple[str, str, str]] = {
    "normal": ("w", "a", "modal normal displacement W, positive inward: w = sum W[0] cos(m theta) + W[1] sin(m theta)"),
    "tangential": ("v", "a", "modal tangential displacement V: v = sum V[0] sin(m theta) - V[1] cos(m theta)"),
    "axial": ("u", "a", "modal axial displacement U, positive towards increasing z: u = sum U[0] cos(m theta) + U[1] sin(m theta)"),
    "normal_z": ("w_z", "1", "dW/dz"),
    "normal_zz": ("w_zz", "1/a", "d2W/dz2"),
    "tangential_z": ("v_z", "1", "dV/dz"),
    "axial_z": ("u_z", "1", "dU/dz"),
    **{
        f"{name}_stress": (
            name,
            "rho_e c_e^2",
            f"modal {name.replace('_', ' ')} stress of elastic walls at their design depths; 0 of others",
        )
        for name in SOLID_STRESSES
    },
}
"""Arrays of a file by name: field of the solution, unit, meaning. Those that are zero at all stations are left out."""
VOLTAGES = {
    "potential": ("V", "modal open-circuit voltage of piezoelectric layer {} of each wall, counted from the inside"),
    "potential_rate": ("V c_e/a", "derivative of potential_{} by time"),
}
TRANSFORMS = ("normal_transform", "tangential_transform")
ABSORBERS: dict[str, tuple[tuple[str, ...], str, str]] = {
    "absorber_displacement": (("absorber", "time"), "a", "displacement q of the point absorbers' masses, positive inward"),
    "absorber_force": (
        ("absorber", "side", "time"),
        "rho_e c_e^2 a^2",
        "forces of the point absorbers on the inner and outer shell they link, positive inward",
    ),
    "line_displacement": (("station", "absorber", "time"), "a", "displacement q of the line absorbers' masses, positive inward"),
    "line_force": (
        ("station", "absorber", "side", "time"),
        "rho_e c_e^2 a",
        "forces of the line absorbers, per length, on the inner and outer shell they link, positive inward",
    ),
}
"""Arrays of runs with absorbers."""
_KINDS = ("point absorbers", "line absorbers")
_CAUSES = 4


def to_dataset(solution: SpatialSolution) -> xr.Dataset:
    """Return the fields at all stations, the scenario and the circumstances of a run as a dataset."""
    arrays: dict[str, xr.Variable] = {}
    for name, values in solution.fields.items():
        written, units, long_name = _told(name)
        arrays[written] = xr.Variable(SPATIAL_MODAL, values, {"units": units, "long_name": long_name})
    for name, (dims, units, long_name) in ABSORBERS.items():
        if (found := getattr(solution, name)) is not None:
            arrays[name] = xr.Variable(dims, found, {"units": units, "long_name": long_name})
    if solution.spectra is not None:
        for name, spectrum in zip(TRANSFORMS, solution.spectra[1:], strict=True):
            parts = np.ascontiguousarray(spectrum).view(np.float64).reshape(*spectrum.shape, 2)
            about = f"real and imaginary part of the Laplace transform of {name.removesuffix('_transform')}, at the nodes of the run"
            arrays[name] = xr.Variable(TRANSFORM, parts, {"units": "a^2/c_e", "long_name": about})
    return to_spatial_dataset(solution.at(0), arrays, solution.stations, json.dumps(asdict(solution.sampling)))


def _told(field: str) -> tuple[str, str, str]:
    """Return the name of a field in a file, its unit and its meaning."""
    kind, _, number = field.partition(" ")
    if number:
        units, long_name = VOLTAGES[kind]
        return f"{kind}_{number}", units, long_name.format(number)
    return next((name, units, text) for name, (field, units, text) in FIELDS.items() if field == kind)


def dimensions_of(file: ForeignFile) -> dict[str, tuple[str, ...]]:
    """Return the arrays of fields and transforms that a file may hold, and their dimensions."""
    names = [*FIELDS, *(f"{kind}_{number}" for kind in VOLTAGES for number in range(_layers_in(file)))]
    of_absorbers = {name: dims for name, (dims, _, _) in ABSORBERS.items()}
    return {**dict.fromkeys(names, SPATIAL_MODAL), **of_absorbers, **dict.fromkeys(TRANSFORMS, TRANSFORM)}


def sizes_of(file: ForeignFile) -> dict[str, int]:
    """Return the size of each dimension, the same in all arrays; nothing is read, ValueError if they do not fit."""
    always = {"time": ("time",), "station": ("station",), "error_estimate": ERROR}
    return restored.agreed_sizes(file, always | dimensions_of(file), (*always, "normal", "tangential"))


def solution_of(file: ForeignFile) -> SpatialSolution:
    """Return the solution that a file holds; see :func:`coaxshell.response.restored.solution_of`."""
    told = restored.described(file)
    sizes = sizes_of(file)
    grid = LaplaceGrid(told.settings.time_step / told.settings.refinement, told.settings.steps * told.settings.refinement)
    problem = dimensionless(told.system, dimensions=3, settings=told.settings).resolving(band(grid))
    sampling = _sampling(told.about["axial_sampling"], problem, told.settings)
    _agree(sizes, file, problem, told.settings, grid)
    arrays = {name: file.array(name) for name in ("time", "error_estimate", "station", *dimensions_of(file)) if name in file}
    if not np.array_equal(arrays["station"], told.settings.stations):
        raise ValueError("its stations are not those of its settings")
    solution = SpatialSolution(
        problem,
        told.settings,
        arrays["time"],
        sampling,
        {_field(name): values for name, values in arrays.items() if dimensions_of(file).get(name) == SPATIAL_MODAL},
        Estimates(*np.moveaxis(arrays["error_estimate"], -1, 0)),
        told.warnings,
        told.timings,
        absorber_displacement=arrays.get("absorber_displacement"),
        absorber_force=arrays.get("absorber_force"),
        line_displacement=arrays.get("line_displacement"),
        line_force=arrays.get("line_force"),
    )
    restored.judge_instants(solution.time, solution.settings)
    if not file.sealed and solution.whole and told.about["checksum"] != checksum(arrays, told.text, told.about):
        raise ValueError("its checksum is another: it was changed after it was saved")
    if solution.whole and all(name in arrays for name in TRANSFORMS):
        normal, tangential = (_complex(arrays[name]) for name in TRANSFORMS)
        solution = replace(solution, spectra=StationSpectra(grid, normal, tangential))
    return replace(solution, warnings=with_missing(solution))


def _absorbers_in(file: ForeignFile, name: str) -> int:
    """Return of how many absorbers an array of a file is."""
    return file.shape(name)[ABSORBERS[name][0].index("absorber")] if name in file else 0


def _absorbers_of(problem: Problem, name: str) -> int:
    """Return of how many absorbers it is to be."""
    return len(problem.system.absorber_list if name in LINES else problem.system.point_absorbers)


def _layers_in(file: ForeignFile) -> int:
    number = 0
    while f"potential_{number}" in file:
        number += 1
    return number


def _field(name: str) -> str:
    """Return the field that an array of a file is."""
    return FIELDS[name][0] if name in FIELDS else " ".join(name.rsplit("_", 1))


def _complex(parts: FloatArray) -> ComplexArray:
    return np.ascontiguousarray(parts).view(np.complex128)[..., 0]


def _agree(sizes: Mapping[str, int], file: ForeignFile, problem: Problem, settings: Settings, grid: LaplaceGrid) -> None:
    """Refuse arrays that are not those of the scenario and the settings."""
    for found, expected, what, where in (
        (sizes["shell"], len(problem.shells), "shells", "scenario"),
        (_layers_in(file), piezoelectric_layers(problem), "voltages of piezoelectric layers", "scenario"),
        (sizes["station"], len(settings.stations), "stations", "settings"),
        *((_absorbers_in(file, name), _absorbers_of(problem, name), _KINDS[name in LINES], "scenario") for name in ABSORBERS),
        (sizes["mode"] - 1, settings.modes, "as highest order", "settings"),
        (sizes.get("node", grid.samples // 2 + 1), grid.samples // 2 + 1, "Laplace nodes", "settings"),
    ):
        if found != expected:
            raise ValueError(f"{found} {what} in the arrays, {expected} in the {where}")
    if any(f"potential_rate_{number}" in file for number in range(_layers_in(file))) != (f"potential_rate_{_layers_in(file) - 1}" in file):
        raise ValueError("rates of some layers only")
    fixed = {"quantity": len(QUANTITIES), "cause": _CAUSES, "part": 2, "side": 2}
    if sizes["half"] not in (1, 2) or any(sizes.get(dim, size) != size for dim, size in fixed.items()):
        raise ValueError("arrays of another shape than ours")


def _sampling(text: Any, problem: Problem, settings: Settings) -> AxialSampling:
    """Return the axial wavenumbers of a run; ValueError if they are not those of its settings."""
    table, order = restored.table(text), settings.modes
    period, highest = restored.finite(table["period"]), restored.finite(table["highest"])
    length = settings.axial_period
    if settings.dimensions != 3 or length is None or order == "auto" or table["max_order"] != order or highest != settings.axial_modes:
        raise ValueError("axial wavenumbers that are not those of its settings")
    if not math.isclose(period * problem.scales.length, length, rel_tol=1e-9) or highest * period > 2.0 * math.pi * MOST_WAVES:
        raise ValueError("an axial period that is not that of its settings")
    return AxialSampling(period, order, highest)
