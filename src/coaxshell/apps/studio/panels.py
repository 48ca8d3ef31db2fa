"""What panels beside the curves show of a run: loops of feedback with their margins, spectra, and where a wall is stressed most."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from coaxshell.apps.studio import worker
from coaxshell.apps.studio.arrays import Item, Packed, packed
from coaxshell.errors import InputError, PhysicsWarning
from coaxshell.model import RigidShell, Shell, System
from coaxshell.model.places import shell_name, shell_phrase
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response import Response
from coaxshell.response.margins import worst_loops
from coaxshell.solver.settings import Settings

QUANTITIES = ("stress", "shell_acceleration", "shell_velocity", "displacement")
"""Of whose histories the Fourier transform is shown."""
COMPONENTS = ("von_mises", "hoop", "axial")
NODES = 1_500
"""Points of a loop that are drawn, about."""
_MARGINS = ("gain_margin", "lesser_gain_margin", "phase_margin", "delay_margin")


def require_controlled(system: System) -> None:
    """Raise InputError for a run without a loop that could be drawn."""
    if system.control is None:
        raise InputError("control", "nothing is fed back", "choose a kind of control")


def require_stressed(system: System, shell: int) -> None:
    """Raise InputError for the number of a shell that is not there or cannot be stressed."""
    if shell >= len(system.shells) or isinstance(system.shells[shell], RigidShell):
        raise InputError("shell", f"{shell} is no shell that can be stressed", f"give the number of one, below {len(system.shells)}")


def loops(system: System, settings: Settings) -> Packed:
    """Return margins by order, and L over frequency of the order of each shell's loop that stands the least delay.

    In three dimensions the least over the axial wavenumbers, and L of a wave.
    """
    worker.report(0.0, "margins")
    margins, worst = worst_loops(system, settings, worker.report)
    shells, items = [], {"order": Item(margins["order"].to_numpy(), "1")}
    for place, loop in enumerate(worst):
        each = margins.isel(shell=place)
        items[f"delay_margin/{place}"] = Item(_bounded(_least_of_waves(each["delay_margin"].to_numpy())), "s")
        there = loop.frequency > 0.0
        some = slice(None, None, max(1, int(np.count_nonzero(there)) // NODES))
        for name, values in (("frequency", loop.frequency), ("real", loop.values.real), ("imaginary", loop.values.imag)):
            items[f"{name}/{place}"] = Item(values[there][some], "Hz" if name == "frequency" else "1")
        wave = {"wavenumber": float(loop.wavenumber)} if "wavenumber" in margins.coords else {}
        shells.append({"name": str(loop.shell), "order": int(loop.order), **wave, **{kind: _worst(each, kind) for kind in _MARGINS}})
    return packed({"shells": shells}, items)


def _worst(margins: Any, kind: str) -> dict[str, Any] | None:
    """Return the least of a margin over all orders, and axial wavenumbers (1/m), with its unit and frequency (Hz); None where none has one.

    NaN stands for waves that a run has not.
    """
    values = margins[kind].to_numpy()
    at = np.unravel_index(int(np.nanargmax(values) if kind == "lesser_gain_margin" else np.nanargmin(values)), values.shape)
    if not np.isfinite(values[at]) or values[at] == 0.0:
        return None
    frequency = f"{kind}_frequency"
    hertz = float(margins[frequency].to_numpy()[at]) if frequency in margins else None
    along = {"wavenumber": float(margins["wavenumber"].to_numpy()[at[0]])} if "wavenumber" in margins.coords else {}
    order = int(margins["order"].to_numpy()[at[-1]])
    return {"value": float(values[at]), "unit": margins[kind].attrs["units"], "order": order, "frequency": hertz, **along}


def _least_of_waves(values: FloatArray) -> FloatArray:
    """Return a margin of each order, the least of all axial wavenumbers where there are several; infinite where a run has none."""
    return values if values.ndim == 1 else np.where(np.isnan(values), np.inf, values).min(axis=0)


def _bounded(values: FloatArray) -> FloatArray:
    """Return margins with 0 in the place of those that are infinite."""
    return np.where(np.isfinite(values), values, 0.0)


def spectra(system: System, settings: Settings, shell: int, quantity: str, station: float | None) -> Packed:
    """Return at head and tail of a shell its shock response spectrum (pseudo-velocity, Q = 10) and the Fourier transform of a history."""
    response = _answer(system, settings)
    ends = [system.sources[0].angle, system.sources[0].angle + 180.0]
    shock = response.shock_spectrum(shell, ends, station=station)
    hertz = shock["frequency"].to_numpy()
    worker.report(0.7, "Fourier transform")
    with warnings.catch_warnings(record=True) as remarks:  # told on the page, not in the terminal
        warnings.simplefilter("always", PhysicsWarning)
        found = response.spectrum(quantity, shell, ends, hertz, station=station)
    header = {"shell": shell, "quantity": quantity, "label": str(found.attrs.get("long_name", quantity)), "station": station}
    header["warnings"] = [str(one.message) for one in remarks]
    unit = str(found.attrs.get("units", ""))
    return packed(
        {**header, "name": shell_phrase(shell, len(system.shells))},
        {
            "frequency": Item(hertz, "Hz"),
            "shock": Item(shock.to_numpy().T, "m/s"),
            "fourier": Item(np.abs(found.to_numpy()).T, unit),
        },
    )


def stressed(system: System, settings: Settings, shell: int, component: str) -> Packed:
    """Return the largest magnitude of a stress over time at every angle and depth of a wall, layer by layer, and its peak."""
    from coaxshell.plotting.wall_stress import mapped_walls

    response = _answer(system, settings)
    worker.report(0.6, "stress through the wall")
    ((wall,),) = mapped_walls(response, [shell], component).values()
    described, peak = system.shells[shell], wall.peak
    assert isinstance(described, Shell)
    items = {"angle": Item(wall.maps[0][0], "deg")}
    for number, (_, depths, values) in enumerate(wall.maps):
        items |= {f"depth/{number}": Item(depths, "m"), f"stress/{number}": Item(values, "Pa")}
    layers = [{"material": layer.material.name, "role": layer.role, "strength": layer.material.strength} for layer in described.layers]
    told = {name: getattr(peak, name) for name in ("value", "time", "angle", "depth", "layer", "material", "station", "margin")}
    header = {
        "shell": shell,
        "name": shell_name(shell, len(system.shells)),
        "component": component,
        "layers": layers[: len(wall.maps)],
        "peak": {name: float(value) if isinstance(value, np.floating) else value for name, value in told.items()},
        "transit_time_seconds": system.transit_time,
    }
    return packed(header, items)


def _answer(system: System, settings: Settings) -> Response:
    with worker.part(0, 2, "solving"):
        return worker.answer(system, settings)
