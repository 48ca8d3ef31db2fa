"""Where, when and how deeply the water around the shells would cavitate, at points outside."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, Self, TypedDict

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model.sea import VAPOUR_PRESSURE
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.fields.evaluate import pressure_at
from coaxshell.response.fields.grids import Grid, coordinates, grid_of
from coaxshell.response.fields.mirrored import in_water
from coaxshell.response.fields.request import positive, when_of
from coaxshell.response.fields.spatial_pressure import spatial_pressure
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.axial.solve import laplace_grid
from coaxshell.solver.cavitation import least_pressure
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solved_spectra import SolvedSpectra


class CavitationOptions(TypedDict, total=False):
    """Keyword arguments of a map of cavitation beside x and y, and z of three dimensions."""

    radius: npt.ArrayLike | None
    angle: npt.ArrayLike | None
    time: npt.ArrayLike | None
    vapour_pressure: float


INSTANTS = 200
"""Default number of instants, at most."""
SIDE = 81
"""Points along a side of the default grid."""
REACH = 3.0
"""Half the side of the default grid, in a."""
_BLOCK = 25
"""Instants whose fields are solved at a time."""


def cavitation(
    spectra: SolvedSpectra,
    x: npt.ArrayLike | None = None,
    y: npt.ArrayLike | None = None,
    *,
    radius: npt.ArrayLike | None = None,
    angle: npt.ArrayLike | None = None,
    time: npt.ArrayLike | None = None,
    vapour_pressure: float = VAPOUR_PRESSURE,
) -> xr.Dataset:
    """Return where the absolute pressure of the water outside falls below that of its vapour, as the linear run has it.

    p_atm + rho g (d - h) + p < p_vapour, h the height above the axis; beyond the first such instant a run overstates tension, because
    water that cavitates bears none.

    Parameters
    ----------
    spectra : SolvedSpectra
        Of a run whose system has a sea.
    x, y, radius, angle : array_like, optional
        A Cartesian or a polar grid as for the pressure, in units of a; by default a square of 6 by 6 of 81 by 81 points.
    time : array_like, optional
        Instants in transits; by default up to 200 of the run.
    vapour_pressure : float
        Pa.

    Returns
    -------
    xarray.Dataset
        ``first`` (s, the first instant, NaN where there is none), ``lowest_pressure`` (absolute, Pa), ``lasting`` (s, how long in all); NaN
        where there is no water outside. Attributes ``first_time`` (s), ``first_place`` (m, x and y, or a text that there is none), ``area``
        (m^2, of all that ever cavitates, of Cartesian grids) and ``vapour_pressure``.

    Raises
    ------
    InputError
        The system has no sea, or an argument is not allowed.
    """
    asked = _Asked.of(spectra.problem, spectra.grid.time, (x, y, radius, angle), time, vapour_pressure)
    return asked.map(pressure_at(spectra, asked.grid, asked.when[block]) for block in _blocks(asked.when.size))


def spatial_cavitation(
    spatial: SpatialSolution,
    x: npt.ArrayLike | None = None,
    y: npt.ArrayLike | None = None,
    *,
    z: float = 0.0,
    radius: npt.ArrayLike | None = None,
    angle: npt.ArrayLike | None = None,
    time: npt.ArrayLike | None = None,
    vapour_pressure: float = VAPOUR_PRESSURE,
) -> xr.Dataset:
    """Return the same of a run in three dimensions, over the cross-section at *z* (in a): its waves are solved once more for all instants.

    Arguments, answer and errors are those of :func:`cavitation`.
    """
    run_time = laplace_grid(spatial.settings).time
    asked = _Asked.of(spatial.problem, run_time, (x, y, radius, angle), time, vapour_pressure)
    first, second = asked.grid.along
    if asked.grid.polar:
        found = spatial_pressure(spatial, z=z, radius=first, angle=second, time=asked.when)
    else:
        found = spatial_pressure(spatial, second, first, z, time=asked.when)
    values = found.transpose("time", *asked.grid.dims).to_numpy().reshape(asked.when.size, -1)
    return asked.map(values[block] for block in _blocks(asked.when.size)).assign_coords(z=found["z"])


@dataclass(frozen=True, eq=False)
class _Asked:
    """Points and instants of a map.

    Attributes
    ----------
    problem : Problem
    grid : Grid
    when : ndarray
        Transits.
    vapour : float
        Pa.
    """

    problem: Problem
    grid: Grid
    when: FloatArray
    vapour: float

    @classmethod
    def of(cls, problem: Problem, run_time: FloatArray, places: tuple[Any, Any, Any, Any], time: Any, vapour_pressure: float) -> Self:
        """Return what is asked for, x and y or radius and angle, with the defaults; InputError if something is not allowed."""
        if problem.system.sea is None:
            raise InputError("sea", "is not described: the pressure at rest is unknown", "give the system one, sea=cx.Sea(depth=...)")
        vapour = positive("vapour_pressure", vapour_pressure, "Pa")
        if all(one is None for one in places):
            across = np.linspace(-REACH, REACH, SIDE)
            places = across, across, None, None
        step = max(1, -(-(run_time.size - 1) // INSTANTS))
        when = np.atleast_1d(when_of(run_time[::step] if time is None else time, float(run_time[-1]), problem.scales))
        if when.size < 2 or np.any(np.diff(when) <= 0.0):
            raise InputError("time", "needs two or more instants that follow each other", "leave it out, or give several")
        return cls(problem, grid_of(*places), when, vapour)

    def map(self, pressures: Iterable[FloatArray]) -> xr.Dataset:
        """Return the map from the acoustic pressures at blocks of the instants, each (instants, points)."""
        grid, when, turn = self.grid, self.when, np.radians(self.grid.angle)
        least = least_pressure(self.problem, grid.radius * np.cos(turn), grid.radius * np.sin(turn), self.vapour)
        wet = (grid.radius >= self.problem.head) & in_water(self.problem, grid.radius, grid.angle)
        lowest, first, lasting = np.full(wet.size, np.inf), np.full(wet.size, np.nan), np.zeros(wet.size)
        duration = np.gradient(when)
        for block, pressure in zip(_blocks(when.size), pressures, strict=True):
            excess = pressure - least
            below = excess < 0.0
            lasting += duration[block] @ below
            new = np.isnan(first) & below.any(axis=0)
            first[new] = when[block][below[:, new].argmax(axis=0)]
            lowest = np.minimum(lowest, excess.min(axis=0) + self.vapour)
        return _labelled(self.problem, grid, self.vapour, wet, (first, lowest, lasting))


def _blocks(count: int) -> Iterator[slice]:
    return (slice(start, min(start + _BLOCK, count)) for start in range(0, count, _BLOCK))


def _labelled(
    problem: Problem, grid: Grid, vapour: float, wet: np.ndarray, values: tuple[FloatArray, FloatArray, FloatArray]
) -> xr.Dataset:
    scales, shape = problem.scales, tuple(axis.size for axis in grid.along)
    first, lowest, lasting = (np.where(wet, one, np.nan) for one in values)
    texts = {
        "first": ("first instant below the pressure of vapour", "s", first * scales.time),
        "lowest_pressure": ("lowest absolute pressure", "Pa", lowest),
        "lasting": ("time below the pressure of vapour", "s", lasting * scales.time),
    }
    variables = {
        name: xr.Variable(grid.dims, found.reshape(shape), {"long_name": text, "units": unit})
        for name, (text, unit, found) in texts.items()
    }
    told: dict[str, object] = {"vapour_pressure": vapour, "first_time": "never", "first_place": "nowhere"}
    torn = np.isfinite(first)
    if torn.any():
        at = int(np.nanargmin(first))
        turn = np.radians(grid.angle[at])
        told["first_time"] = float(first[at] * scales.time)
        told["first_place"] = [float(scales.length * grid.radius[at] * part) for part in (np.cos(turn), np.sin(turn))]
    if not grid.polar and all(axis.size > 1 for axis in grid.axes):
        told["area"] = float(torn.sum() * np.prod([np.ptp(axis) / (axis.size - 1) * scales.length for axis in grid.axes]))
    places = {name: variable for name, variable in coordinates(scales, grid, np.zeros(())).items() if not name.startswith("time")}
    return xr.Dataset(variables, places, told)
