"""The pressure around the shells over a whole run: computed once by a worker into a file, and served from there in slices."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from coaxshell.apps.studio import worker
from coaxshell.apps.studio.arrays import Item, Packed, packed
from coaxshell.model import System
from coaxshell.model.places import region_name, shell_phrase
from coaxshell.plotting.energy import group_colours
from coaxshell.plotting.field import absorber_places, wall_radii
from coaxshell.plotting.field_scales import field_scales
from coaxshell.plotting.frames import FieldView, Frames, field_frames, gathered
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
    scales = field_scales([frames])
    largest = float(np.max(np.abs(frames.pressure), initial=0.0)) or 1.0
    pressure = np.empty((len(frames), size, size), np.float16)
    for index in range(len(frames)):
        pressure[index] = frames.field(index) / largest
    with path.open("wb") as file:
        np.save(file, pressure, allow_pickle=False)
    stresses = {i: around.astype(np.float32) for i, around in enumerate(frames.stress) if around is not None}
    about = {
        **_told(system, frames, scales.pressure, scales.stress),
        "every": every,
        "size": size,
        "half_width": half_width,
        "scale": largest,
    }
    return about, stresses


def _told(system: System, frames: Frames, pressure: float, stress: float) -> dict[str, Any]:
    milliseconds = frames.milliseconds
    transit = 1e-3 * float(milliseconds[-1] / frames.time[-1]) if len(frames) > 1 else 0.0
    x, y = absorber_places(system) if system.absorber_list else (np.empty(0), np.empty(0))
    return {
        "frames": len(frames),
        "time": [float(time) for time in frames.time],
        "transit_time_seconds": transit,
        "pressure_limit": float(pressure),
        "stress_limit": float(stress),
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
    """Return the energy balance of a run."""
    with worker.part(0, 2, "solving"):
        response = worker.answer(system, settings)
    with worker.part(1, 2, "integrating the fluids' energy"):
        balance = response.energy(every, worker.report)
    entries = [
        {"name": str(name), "label": str(values.attrs["long_name"]), "role": values.attrs["role"], "group": values.attrs["group"]}
        for name, values in balance.data_vars.items()
    ]
    items = {str(name): Item(np.asarray(values), str(values.attrs["units"])) for name, values in balance.data_vars.items()}
    stacked = {entry["group"] for entry in entries if entry["role"] in ("store", "loss")}
    colours = group_colours(sorted(stacked))
    closure = float(np.max(np.abs(balance["closure_relative"])))
    return packed(
        {"entries": entries, "groups": [{"name": name, "colour": tint} for name, tint in colours.items()], "closure": closure},
        {"time": Item(np.asarray(balance["time"]), "transits"), **items},
    )
