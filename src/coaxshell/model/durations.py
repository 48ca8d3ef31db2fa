"""Times of a run: in acoustic transits a/c_e as plain numbers, or as text with a unit of time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coaxshell.errors import InputError
from coaxshell.limits import QUANTITY
from coaxshell.model.units import to_si

if TYPE_CHECKING:
    from coaxshell.model.system import System

_WORDS = ("transits", "transit")


def transits(value: float | str, system: System | None, where: str = "duration") -> float:
    """Return a time in transits of the outermost radius in the fluid outside.

    Parameters
    ----------
    value : float or str
        Transits, or text: "3 ms" is a time, "5" and "5 transits" are transits.
    system : System or None
        Without one, only transits have a meaning.
    where : str
        The argument that an error names.

    Raises
    ------
    InputError
        If a text is not a time, or is one though there is no system.
    """
    if not isinstance(value, str):
        return value
    QUANTITY.check(len(value), where)
    text = value.strip()
    for word in _WORDS:
        text = text.removesuffix(word).rstrip()
    try:
        return float(text)
    except ValueError:
        pass
    try:
        seconds = to_si(text, "time")
    except InputError as error:
        remedy = 'give transits a/c_e as a number, or a time as text such as "3 ms"'
        raise InputError(where, error.problem, remedy) from None
    if system is None:
        raise InputError(where, f"{value!r} has no meaning without a system", "give transits, or make them by Settings.of(system, ...)")
    return seconds / system.transit_time
