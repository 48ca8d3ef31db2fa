"""Histories at head and tail as one table of columns."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.model import RigidShell
from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.response.quantities import Quantity, columns

if TYPE_CHECKING:
    from coaxshell.response.response import Response


_POINTS = (("head", 0.0), ("tail", 180.0))


def history_table(response: Response) -> dict[str, FloatArray]:
    """Return all histories at head and tail as columns: names with units, each of shape (T,).

    Time in transits and in seconds; for each elastic shell the quantities of the table that have columns (stress, displacement, ...) and,
    where it has them, sensor and actuator voltage, at the head (the first source's direction) and at the tail; displacement of each
    absorber.
    """
    width = 2 + 2 * len(list(columns())) * len(response.system.shells) + len(response.system.absorber_list)
    Cost(48.0 * width * response.time.size).require(
        f"a table of {width} columns and {response.time.size:,} rows", "run a coarser step or fewer absorbers"
    )
    found = {
        "time (a/c)": np.asarray(response.time, dtype=np.float64),
        "time (s)": np.asarray(response.time_seconds, dtype=np.float64),
    }
    for shell, label in _elastic(response):
        for quantity in quantities_of(response, shell):
            values = at_ends(response, quantity, shell)
            for column, (point, _) in enumerate(_POINTS):
                found[f"{label} {quantity.words} {point} ({quantity.unit})"] = values[:, column]
    if response.system.absorber_list:
        for number, row in enumerate(np.asarray(response.absorber_displacement(), dtype=np.float64)):
            found[f"absorber {number} displacement (m)"] = row
    return found


def _elastic(response: Response) -> list[tuple[int, str]]:
    """Return number and name of each elastic shell."""
    shells = response.system.shells
    return [(i, shell_name(i, len(shells))) for i, shell in enumerate(shells) if not isinstance(shell, RigidShell)]


def quantities_of(response: Response, shell: int) -> list[Quantity]:
    """Return the quantities with columns that a shell has: voltages only where it has the layers and the control."""
    return [quantity for quantity in columns() if quantity.given(response.motion, shell)]


def at_ends(response: Response, quantity: Quantity, shell: int) -> FloatArray:
    """Return a quantity at head and tail of a shell, SI, shape (T, 2)."""
    head = response.system.sources[0].angle
    return np.asarray(response.history(shell, [head + turn for _, turn in _POINTS], quantity.name), dtype=np.float64)
