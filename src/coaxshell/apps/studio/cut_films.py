"""The pressure of a run in three dimensions over the whole run, across the axis at a station or along it, and what it costs beforehand."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from coaxshell.apps.studio import limits, worker
from coaxshell.apps.studio.fields import Stresses, told_of, written
from coaxshell.errors import InputError
from coaxshell.model import System
from coaxshell.model.absorbers import drawn_radii
from coaxshell.numerics.cost import Cost
from coaxshell.plotting.cut_frames import Shown, shown_runs
from coaxshell.plotting.frames import FieldView, gathered
from coaxshell.plotting.panels import AlongAxis
from coaxshell.response.energy.whole_length import whole_length_cost
from coaxshell.response.spatial import SpatialResponse
from coaxshell.solver.settings import Settings

PLANES = ("along", "across")
"""The plane y = 0 along the axis, and the cross-section at a station."""


def cut_film(
    system: System, settings: Settings, plane: str, station: float, every: int, size: int, half_width: float, path: Path
) -> tuple[dict[str, Any], Stresses]:
    """Write the field on a cut at every so many instants to a file, as :func:`coaxshell.apps.studio.fields.film` does of a plane run.

    The stress along the axis is that of head and tail of each shell in turn, (K, rows) at the rows of pixels that stations cover.
    """
    with worker.part(0, 10, "solving"):
        response = _answer(system, settings)
    view, times = FieldView(half_width, size), response.time[::every]
    shown = _shown(response, plane, station)
    limits.require_small(shown.cost(len(times), view), "the pressure on this cut")
    with worker.part(1, 10, "field", 9):  # the run is there already as a rule
        frames = gathered(parts[0] for parts in shown.solved(times, view, worker.report).frames(None))
    about, stresses = told_of(system, frames), written(frames, path)
    panel = shown.panels[0]
    if isinstance(panel, AlongAxis):
        heights = panel.covered(view)
        rows = [int(np.searchsorted(view.centres, heights[0] - 0.5 * view.pixel)), int(heights.size)] if heights.size else [0, 0]
        sides = [{"from": left, "to": right, "rigid": rigid} for left, right, rigid in panel.sides]
        about |= {"sides": sides, "rows": rows, "absorbers": _in_the_plane(system)}
    return {**about, "plane": plane, "station": station, "every": every, "size": size, "half_width": half_width}, stresses


def costs(system: System, settings: Settings, every: int, size: int, half_width: float) -> dict[str, Any]:
    """Return what the films of both planes and the energy of a run cost, as plain data; null for an energy that there is not."""
    response = _answer(system, settings)
    view, count = FieldView(half_width, size), len(response.time[::every])
    found = {plane: _plain(_shown(response, plane, response.stations[0]).cost(count, view)) for plane in PLANES}
    try:
        return {**found, "energy": _plain(whole_length_cost(response.spatial))}
    except InputError as error:
        return {**found, "energy": None, "energy_refused": {"where": error.where, "problem": error.problem, "remedy": error.remedy}}


def _plain(cost: Cost) -> dict[str, Any]:
    return {"seconds": cost.seconds, "duration": cost.duration, "memory": cost.memory}


def _answer(system: System, settings: Settings) -> SpatialResponse:
    response = worker.answer(system, settings)
    assert isinstance(response, SpatialResponse)
    return response


def _shown(response: SpatialResponse, plane: str, station: float) -> Shown:
    (both,) = shown_runs([response], [""], station)
    return both.along() if plane == "along" else both.across()


def _in_the_plane(system: System) -> list[list[float]]:
    """Return x and z (in a) of the absorbers at points that lie near the plane y = 0."""
    found, radii = [], [shell.radius for shell in system.shells]
    for point in system.point_absorbers:
        across = np.cos(np.radians(point.angle))
        if abs(across) > 0.99:
            found.append([float(across * drawn_radii(point, radii, radii)[1]), point.z])
    return [[x / system.reference_radius, z / system.reference_radius] for x, z in found]
