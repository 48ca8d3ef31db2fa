"""What a gauge at a place would show in a run: its history at the instants of the run, and between them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.response import Response
from coaxshell.response.strain import hoop_strain


@dataclass(frozen=True)
class Place:
    """Where something is measured, and what; entries as those of :class:`coaxshell.Measurement`."""

    quantity: str
    shell: int | str
    angle: float
    component: str
    depth: float | str | None
    radius: float | None
    station: float | None


@dataclass(frozen=True)
class Shown:
    """What a run shows at the samples of one record, SI, and what it rises by per second there."""

    values: FloatArray
    slope: FloatArray


def predicted(response: Response, one: Place) -> FloatArray:
    """Return the history that a measurement would show, SI, at the instants of a run, shape (T,).

    Raises
    ------
    InputError
        If the system has no such place or quantity.
    """
    angle = [one.angle]
    station: Any = None if response.stations is None else one.station or 0.0
    if one.quantity == "pressure":
        assert one.radius is not None
        scales = response.solution.problem.scales
        found = response.pressure(radius=[one.radius / scales.length], angle=angle, time=response.time)
        return np.asarray(found, dtype=np.float64).reshape(-1)
    shell: Any = one.shell
    if one.quantity == "strain":
        number = response.system.shell_index(shell)
        ((_, motion),) = response.stations_read(station)
        return np.asarray(hoop_strain(motion, number, np.array(angle), one.depth)[:, 0])
    if one.quantity == "stress":
        found = response.stress(shell, angle, depth=one.depth, station=station)
    elif one.quantity == "acceleration":
        found = response.shell_acceleration(shell, angle, one.component, station=station)
    elif one.quantity == "velocity":
        found = response.shell_velocity(shell, angle, one.component, station=station)
    elif one.quantity == "displacement":
        found = response.displacement(shell, angle, one.component, station=station)
    else:
        found = response.sensor_voltage(shell, angle, station=station)
    return np.asarray(found, dtype=np.float64).reshape(-1)


def shown_at(quantity: str, time: FloatArray, values: FloatArray, at: FloatArray) -> Shown:
    """Return a history of a run at other instants (s): between its own by cubic splines, of pressures, whose fronts jump, by lines."""
    from scipy.interpolate import CubicSpline

    at = np.minimum(at, time[-1])
    running = at >= 0.0
    if quantity == "pressure":
        slopes = np.append(np.diff(values) / np.diff(time), 0.0)
        place = np.clip(np.searchsorted(time, at, side="right") - 1, 0, time.size - 1)
        return Shown(np.where(running, np.interp(at, time, values), 0.0), np.where(running, slopes[place], 0.0))
    spline = CubicSpline(time, values)
    return Shown(np.where(running, spline(at), 0.0), np.where(running, spline(at, 1), 0.0))
