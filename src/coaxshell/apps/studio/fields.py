"""The pressure around the shells over a whole run: computed once by a worker into a file, and served from there in slices."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from coaxshell.apps.studio import limits, worker
from coaxshell.apps.studio.arrays import Item, Packed, packed
from coaxshell.model import System
from coaxshell.model.places import region_name, shell_phrase
from coaxshell.plotting.energy import group_colours
from coaxshell.plotting.field import absorber_places, wall_radii
from coaxshell.plotting.field_scales import field_scales
from coaxshell.plotting.frames import FieldView, Frames, field_frames, gathered
from coaxshell.response.energy.whole_length import whole_length_cost
from coaxshell.response.spatial import SpatialResponse
from coaxshell.solver.settings import Settings

Stresses = dict[int, npt.NDArray[np.float32]]
"""Stress by number of the shell."""

LEVELS = 127
"""Steps of a byte on either side of no pressure."""


def film(system: System, settings: Settings, every: int, size: int, half_width: float, path: Path) -> tuple[dict[str, Any], Stresses]:
    """Write the field at every so many instants of a run to a file; return what the page needs to play it, and the shells' stress.

    The file is a .npy of the pressure over ``scale`` as float16, shape (K, size, size); the stress is in Pa, shape (K, 360) each.
    """
    with worker.part(0, 2, "solving"):
        response = worker.answer(system, settings)
    view = FieldView(half_width, size)
    with worker.part(1, 2, "field"):
        frames = gathered(field_frames(response, response.time[::every], view, progress=worker.report))
    return {**told_of(system, frames), "every": every, "size": size, "half_width": half_width}, written(frames, path)


def written(frames: Frames, path: Path) -> Stresses:
    """Write the pressure over its largest magnitude to a file as float16, shape (K, size, size), and return the shells' stress."""
    largest, size = _largest(frames), frames.field(0).shape[0]
    pressure = np.empty((len(frames), size, size), np.float16)
    for index in range(len(frames)):
        pressure[index] = frames.field(index) / largest
    with path.open("wb") as file:
        np.save(file, pressure, allow_pickle=False)
    return {i: around.astype(np.float32) for i, around in enumerate(frames.stress) if around is not None}


def _largest(frames: Frames) -> float:
    return float(np.max(np.abs(frames.pressure), initial=0.0)) or 1.0


def told_of(system: System, frames: Frames) -> dict[str, Any]:
    """Return what a page needs to know of frames to play them."""
    milliseconds, scales = frames.milliseconds, field_scales([frames])
    transit = 1e-3 * float(milliseconds[-1] / frames.time[-1]) if len(frames) > 1 else 0.0
    x, y = absorber_places(system) if system.absorber_list else (np.empty(0), np.empty(0))
    return {
        "frames": len(frames),
        "time": [float(time) for time in frames.time],
        "transit_time_seconds": transit,
        "pressure_limit": float(scales.pressure),
        "stress_limit": float(scales.stress),
        "scale": _largest(frames),
        "radii": [float(radius) for radius in wall_radii(system)],
        "absorbers": [[float(a), float(b)] for a, b in zip(x, y, strict=True)],
    }


def frames_of(path: Path, about: dict[str, Any], stresses: Stresses, start: int, count: int, limit: float | None) -> Packed:
    """Return a slice of a film as ``uint8``, whose ends stand for the limit (Pa), or as ``float16`` without a limit."""
    chosen = slice(start, min(start + count, about["frames"]))
    held: npt.NDArray[np.float16] = np.load(path, mmap_mode="r", allow_pickle=False)[chosen]
    scale = about["scale"]
    pressure: npt.NDArray[Any] = np.array(held)
    if limit is not None:
        scale = limit / LEVELS
        pressure = bytes_of(np.asarray(held, dtype=np.float32) * (about["scale"] / scale))
    time = np.asarray(about["time"][chosen])
    items = {"pressure": Item(pressure, "Pa", {"scale": scale}), "time": Item(time, "transits")}
    items |= {f"stress/{i}": Item(around[chosen], "Pa") for i, around in stresses.items()}
    return packed({"start": start, "frames": len(time), "half_width": about["half_width"]}, items)


def bytes_of(levels: npt.NDArray[np.floating[Any]]) -> npt.NDArray[np.uint8]:
    """Return q = 128 + level, rounded and kept within 1 to 255."""
    return np.asarray(np.clip(np.rint(levels), -LEVELS, LEVELS) + 128, dtype=np.uint8)


def point(system: System, settings: Settings, x: float, y: float) -> Packed:
    """Return the pressure history at a point, lengths in a."""
    response = worker.answer(system, settings)
    pressure = np.asarray(response.pressure(x=[x], y=[y], time=response.time, progress=worker.report)).reshape(-1)
    return packed(
        {"x": x, "y": y, "region": _place(system, float(np.hypot(x, y)) * system.reference_radius)},
        {"time": Item(response.time, "transits"), "pressure": Item(pressure, "Pa")},
    )


def _place(system: System, radius: float) -> str:
    """Return the name of the fluid, or of the wall between its wetted faces, at a distance from the axis (m)."""
    count = len(system.shells)
    for number, shell in enumerate(system.shells):
        inner, outer = shell.wetted_radii
        if inner < radius < outer:
            return f"wall of the {shell_phrase(number, count)}"
    return region_name(sum(radius >= shell.wetted_radii[1] for shell in system.shells), count)


def energy(system: System, settings: Settings, every: int) -> Packed:
    """Return the energy balance of a run, of one in three dimensions over the whole length of the shells."""
    with worker.part(0, 10, "solving"):
        response = worker.answer(system, settings)
    if isinstance(response, SpatialResponse):
        limits.require_small(whole_length_cost(response.spatial), "the energy over the whole length")
    with worker.part(1, 10, "integrating the fluids' energy", 9):
        balance = response.energy(every, worker.report)
    entries = [
        {"name": str(name), "label": str(values.attrs["long_name"]), "role": values.attrs["role"], "group": values.attrs["group"]}
        for name, values in balance.data_vars.items()
    ]
    items = {str(name): Item(np.asarray(values), str(values.attrs["units"])) for name, values in balance.data_vars.items()}
    stacked = {entry["group"] for entry in entries if entry["role"] in ("store", "loss")}
    colours = group_colours(sorted(stacked))
    closure, extent = np.max(np.abs(balance["closure_relative"])), balance.attrs.get("extent", "per metre of length")
    told = {"closure": float(closure), "extent": extent}
    return packed(
        {"entries": entries, "groups": [{"name": name, "colour": tint} for name, tint in colours.items()], **told},
        {"time": Item(np.asarray(balance["time"]), "transits"), **items},
    )
