"""Histories at head and tail as one table of columns."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coaxshell.model import RigidShell
from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.cost import Cost
from coaxshell.response.absorbers import absorber_displacement
from coaxshell.response.histories import of_quantity
from coaxshell.response.quantities import Quantity, columns
from coaxshell.response.wall_motion import WallMotion

_POINTS = (("head", 0.0), ("tail", 180.0))


def history_table(motions: Sequence[WallMotion], stations: FloatArray | None = None) -> dict[str, FloatArray]:
    """Return all histories of a run at head and tail as columns: names with units, each of shape (T,).

    Time in transits and in seconds; for each elastic shell the quantities of the table that have columns (stress, displacement, ...) and,
    where it has them, sensor and actuator voltage, at the head (the first source's direction) and at the tail; displacement of each
    absorber. In three dimensions those of all stations, with z in their names.

    Parameters
    ----------
    motions : sequence of WallMotion
        One, or one a station.
    stations : ndarray, shape (stations,), or None
        z, m, in three dimensions.
    """
    solution = motions[0].solution
    system, time = solution.problem.system, solution.time
    many, dimensions = len(motions), 2 if stations is None else 3
    width = 2 + 2 * many * len(list(columns(dimensions))) * len(system.shells) + many * len(system.absorber_list)
    fewer = "run a coarser step or fewer absorbers" if stations is None else "run a coarser step, or name fewer stations"
    Cost(48.0 * width * time.size).require(f"a table of {width} columns and {time.size:,} rows", fewer)
    found = {"time (a/c)": np.asarray(time, dtype=np.float64), "time (s)": np.asarray(time * solution.problem.scales.time)}
    for number, motion in enumerate(motions):
        at = "" if stations is None else f" z = {shortest(stations[number])} m"
        found |= _at_station(motion, at)
    if system.absorber_list and stations is None:
        for number, row in enumerate(np.asarray(absorber_displacement(solution), dtype=np.float64)):
            found[f"absorber {number} displacement (m)"] = row
    return found


def _at_station(motion: WallMotion, at: str) -> dict[str, FloatArray]:
    """Return the columns of one section, whose place stands in their names."""
    system, found = motion.solution.problem.system, {}
    for shell, described in enumerate(system.shells):
        if isinstance(described, RigidShell):
            continue
        label = shell_name(shell, len(system.shells))
        for quantity in quantities_of(motion, shell):
            values = at_ends(motion, quantity, shell)
            for column, (point, _) in enumerate(_POINTS):
                found[f"{label} {quantity.words} {point}{at} ({quantity.unit})"] = values[:, column]
    return found


def shortest(z: float) -> str:
    """Return an axial position with all its digits and no more."""
    return repr(float(z)).removesuffix(".0")


def quantities_of(motion: WallMotion, shell: int) -> list[Quantity]:
    """Return the quantities with columns that a shell has: voltages only where it has the layers and the control."""
    return [quantity for quantity in columns(3) if quantity.given(motion, shell)]


def at_ends(motion: WallMotion, quantity: Quantity, shell: int) -> FloatArray:
    """Return a quantity at head and tail of a shell, SI, shape (T, 2)."""
    head = motion.solution.problem.system.sources[0].angle
    return np.asarray(of_quantity(motion, shell, quantity.name, [head + turn for _, turn in _POINTS]), dtype=np.float64)
