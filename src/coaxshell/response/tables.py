"""Histories at head and tail as one table of columns."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.model import RigidShell
from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost

if TYPE_CHECKING:
    from coaxshell.response.response import Response


_POINTS = (("head", 0.0), ("tail", 180.0))
UNITS = {"stress": "Pa", "displacement": "m", "sensor_voltage": "V", "actuator_voltage": "V"}
"""Quantities of a shell that a table holds, and their units."""


def history_table(response: Response) -> dict[str, FloatArray]:
    """Return all histories at head and tail as columns: names with units, each of shape (T,).

    Time in transits and in seconds; for each elastic shell hoop stress, inward displacement and, where it has them, sensor and
    actuator voltage, at the head (the first source's direction) and at the tail; displacement of each absorber.
    """
    width = 2 + 8 * len(response.system.shells) + len(response.system.absorber_list)
    Cost(48.0 * width * response.time.size).require(
        f"a table of {width} columns and {response.time.size:,} rows", "run a coarser step or fewer absorbers"
    )
    head = response.system.sources[0].angle
    angles = [head + turn for _, turn in _POINTS]
    columns = {
        "time (a/c)": np.asarray(response.time, dtype=np.float64),
        "time (s)": np.asarray(response.time_seconds, dtype=np.float64),
    }
    for shell, label in _elastic(response):
        for quantity in quantities_of(response, shell):
            values = np.asarray(getattr(response, quantity)(shell, angle=angles), dtype=np.float64)
            for column, (point, _) in enumerate(_POINTS):
                columns[f"{label} {quantity.replace('_', ' ')} {point} ({UNITS[quantity]})"] = values[:, column]
    if response.system.absorber_list:
        for number, row in enumerate(np.asarray(response.absorber_displacement(), dtype=np.float64)):
            columns[f"absorber {number} displacement (m)"] = row
    return columns


def _elastic(response: Response) -> list[tuple[int, str]]:
    """Return number and name of each elastic shell."""
    shells = response.system.shells
    return [(i, shell_name(i, len(shells))) for i, shell in enumerate(shells) if not isinstance(shell, RigidShell)]


def quantities_of(response: Response, shell: int) -> list[str]:
    """Return what an elastic shell has: stress and displacement always, voltages where it has the layers and the control."""
    described = response.system.shells[shell]
    roles = set() if isinstance(described, RigidShell) else {layer.role for layer in described.layers}
    found = ["stress", "displacement"]
    if "sensor" in roles:
        found.append("sensor_voltage")
    if shell in response.system.controlled_shells and {"sensor", "actuator"} <= roles:
        found.append("actuator_voltage")
    return found
