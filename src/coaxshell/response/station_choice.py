"""Which stations of a three-dimensional run are asked for."""

from __future__ import annotations

from typing import Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.stations import stations_of

SAME = 1e-9
"""Of a station's position, in m, within which it is found."""


def chosen_stations(known: FloatArray, station: Any) -> tuple[list[int], bool]:
    """Return which of the stations of a run are asked for, by number, and whether it is one alone.

    Parameters
    ----------
    known : ndarray, shape (stations,)
        m.
    station : float, str, iterable of them, or None
        Axial positions, m or text; None for all.

    Raises
    ------
    InputError
        One is no position, or the run has no such station.
    """
    if station is None:
        return list(range(known.size)), False
    try:
        asked = stations_of(station)
    except InputError as error:
        raise InputError(error.where.replace("stations", "station"), error.problem, error.remedy) from None
    chosen = []
    for z in asked:
        near = int(np.abs(known - z).argmin())
        if abs(known[near] - z) > SAME:
            listed = ", ".join(f"{one:g}" for one in known[:8]) + (", ..." if known.size > 8 else "")
            raise InputError("station", f"{z:g} m is none of the run's", f"it has {listed} m; name others in stations= of the run")
        chosen.append(near)
    return chosen, np.ndim(station) == 0 and len(chosen) == 1
