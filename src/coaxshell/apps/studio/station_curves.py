"""A response in three dimensions as the arrays and bars that the page draws: at every station, and the largest over all."""

from __future__ import annotations

from typing import Any

import numpy as np

from coaxshell.apps.studio.arrays import Item, Packed, packed
from coaxshell.apps.studio.curves import absorber_bars, absorbers_of, bars_of, given, header_of
from coaxshell.response.absorbers import force_values
from coaxshell.response.spatial import SpatialResponse
from coaxshell.response.spatial_summary import summarise_stations


def station_curves(response: SpatialResponse, seconds: float) -> Packed:
    """Return header and arrays of a run as docs/studio-api.md says, without errors and warnings, which take as long as the run."""
    summary = summarise_stations(response.spatial, response.motions, judged=False)
    points = response.system.point_absorbers
    each = [bars_of(response, one, 3) for one in summary.each]
    absorbers = {**absorbers_of(response, response.system.absorber_list or points), "z": [point.z for point in points]}
    unit = "N" if points else "N/m"
    header = {
        **header_of(response, seconds),
        "stations": list(summary.stations),
        "absorbers": absorbers,
        "bars": [*_largest(each, summary.stations), *absorber_bars(summary.absorber_displacement, summary.absorber_force, unit)],
        "station_bars": each,
    }
    return packed(header, {"time": Item(response.time, "transits"), **_histories(response), **_forces(response, absorbers, unit)})


def _largest(each: list[list[dict[str, Any]]], stations: tuple[float, ...]) -> list[dict[str, Any]]:
    """Return of the bars of all stations, which are alike, the largest of each kind with its station (m)."""
    found = []
    for alike in zip(*each, strict=True):
        largest = max(range(len(alike)), key=lambda i: alike[i]["value"] or 0.0)
        found.append({**alike[largest], "station": stations[largest]})
    return found


def _histories(response: SpatialResponse) -> dict[str, Item]:
    """Return all histories at the ends of the shells, (stations, 2, instants)."""
    head = response.system.sources[0].angle
    ends, items = np.array([head, head + 180.0]), {}
    for index in range(len(response.system.shells)):
        for quantity in given(response.motions[0], index):
            values = [np.asarray(quantity.at(motion, index, ends), dtype=np.float32).T for motion in response.motions]
            items[f"{quantity.name}/{index}"] = Item(np.stack(values), quantity.unit)
    return items


def _forces(response: SpatialResponse, absorbers: dict[str, Any], unit: str) -> dict[str, Item]:
    """Return the forces of the absorbers nearest to head and tail on their shells: of points (2, instants), of lines at every station."""
    if absorbers["head"] is None:
        return {}
    forces = force_values(response.spatial)[..., [absorbers["head"], absorbers["tail"]], :, :]
    pairs = {(absorbers["inner_shells"][absorbers[end]], absorbers["outer_shells"][absorbers[end]]) for end in ("head", "tail")}
    if len(pairs) > 1:  # between different shells
        return {}
    return {f"absorber_force/{shell}": Item(forces[..., side, :], unit) for side, shell in enumerate(pairs.pop()) if shell >= 0}
