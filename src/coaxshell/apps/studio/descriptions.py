"""From what a page sends to a system, and back: JSON or TOML, normalised, with the numbers that follow from it at once."""

from __future__ import annotations

import math
from typing import Any

from coaxshell.apps.studio import limits, refusals
from coaxshell.apps.studio.record_views import viewed
from coaxshell.errors import InputError
from coaxshell.model import RigidShell, System
from coaxshell.model.places import shell_phrase
from coaxshell.model.toml import loads
from coaxshell.studies.metrics import metric_names, without_shell
from coaxshell.studies.reading import absorber_mass, shell_mass


def system_of(data: dict[str, Any]) -> System:
    """Return the system of a request's ``system`` (table) or ``toml`` (text); InputError when it is not one or too large."""
    text = data.get("toml")
    if isinstance(text, str):
        return system_from(loads(text))
    return system_from(data.get("system"))


def system_from(table: object) -> System:
    """Return the system of a table of its entries; InputError when it is not one or too large."""
    if not isinstance(table, dict):
        raise InputError("system", "is missing" if table is None else f"{table!r:.60} is not a system", "give a table of its entries")
    limits.check_raw(table)
    with refusals.readable("system"):
        system = System.model_validate(table)
    limits.check_system(system)
    return system


def normalised(system: System) -> dict[str, Any]:
    """Return a system as plain JSON in SI, from which an equal one is read."""
    return dict(system.model_dump(mode="json"))


def told(system: System, dimensions: int = 2) -> dict[str, Any]:
    """Return the answer to a valid description, with the metrics of runs in so many dimensions."""
    plain = {"system": normalised(system), "toml": system.to_toml_string()}
    metrics = {"metrics": metric_names(system, dimensions), "metric_units": metric_units(system)}
    return {"ok": True, **plain, "derived": derived(system), **metrics, "records": viewed(system)}


def metric_units(system: System) -> dict[str, str]:
    """Return the units of what is asked of the absorbers and the system: those of absorbers at points are others than those of lines."""
    return {f"{place}.{name}": entry.units for place, entries in without_shell(system).items() for name, entry in entries.items()}


def derived(system: System) -> list[dict[str, Any]]:
    """Return what follows from a description without solving it: name, label, value, unit."""
    transit = system.reference_radius / system.exterior.sound_speed
    rows = [("transit_time", "transit time a/c", transit, "s")]
    count = len(system.shells)
    shells_mass = 0.0
    for index, shell in enumerate(system.shells):
        name = shell_phrase(index, count)
        if isinstance(shell, RigidShell):
            continue
        mass = shell_mass(shell)
        shells_mass += mass
        rows += [
            (f"mass/{index}", f"mass of the {name}", mass, "kg/m"),
            (f"thickness/{index}", f"thickness of the {name}", shell.thickness, "m"),
        ]
        rows += [(f"slenderness/{index}", f"radius by thickness of the {name}", shell.radius / shell.thickness, "")]
    added, points = absorber_mass(system), bool(system.point_absorbers)
    rows += [("shell_mass", "mass of all shells", shells_mass, "kg/m")]
    rows += [("absorber_mass", "mass of all absorbers", added, "kg" if points else "kg/m")]
    if shells_mass and not points:
        rows.append(("absorber_share", "absorbers by shells", added / shells_mass, ""))
    for index, source in enumerate(system.sources):
        of = "" if len(system.sources) == 1 else f" of source {index}"
        rows.append((f"peak_pressure/{index}", f"free-field peak at the head{of}", _peak(source.pulse), "Pa"))
        distance = system.source_distance(source)
        if distance is not None:
            rows.append((f"distance/{index}", f"distance from the axis{of}", distance, "m"))
    return [{"name": name, "label": label, "value": value, "unit": unit} for name, label, value, unit in rows if math.isfinite(value)]


def _peak(pulse: Any) -> float:
    return float(pulse.peak)
