"""Axial positions and lengths of three-dimensional runs, as people write them: numbers in m, lists, texts with units."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from coaxshell.errors import InputError
from coaxshell.limits import STATIONS
from coaxshell.model.base import shown
from coaxshell.model.paths import within
from coaxshell.model.units import to_si
from coaxshell.numerics.scalars import plain

_EXAMPLE = 'give axial positions in m, such as [0.0, 0.7], or texts such as "70 cm"'


def stations_of(value: Any) -> tuple[float, ...]:
    """Return axial positions z (m) in the order given.

    Parameters
    ----------
    value : float, str, or iterable of them
        One position or several. Commas in a text separate positions, as in "0 m, 70 cm".

    Raises
    ------
    InputError
        There is none, one is no length or stands there twice, or there are too many.
    """
    given = plain(value)
    if isinstance(given, str) and "," in given:
        STATIONS.check(given.count(",") + 1, "stations")
        given = given.split(",")
    if isinstance(given, int | float | str):
        return (_position(given, "stations"),)
    if isinstance(given, Mapping | bytes) or not isinstance(given, Iterable):
        raise InputError("stations", f"{shown(given)} is not allowed", _EXAMPLE)
    positions: list[float] = []
    for number, one in enumerate(given):
        STATIONS.check(number + 1, "stations")
        position = _position(one, f"stations[{number}]")
        if position in positions:
            raise InputError(f"stations[{number}]", f"{position:g} m stands there twice", "give each axial position once")
        positions.append(position)
    if not positions:
        raise InputError("stations", "there is none", _EXAMPLE)
    return tuple(positions)


def axial_length(name: str, value: Any) -> float:
    """Return a length along the axis (m); InputError at *name* if it is none, or not above zero."""
    try:
        length = to_si(value, "length")
    except InputError as error:
        raise within(name, error) from None
    if not length > 0.0:
        raise InputError(name, f"{length:g} m is not allowed", 'give a length greater than 0, in m or as text such as "20 m"')
    return length


def _position(value: Any, where: str) -> float:
    try:
        return to_si(value, "length") + 0.0  # -0 is 0
    except InputError as error:
        raise within(where, error) from None
