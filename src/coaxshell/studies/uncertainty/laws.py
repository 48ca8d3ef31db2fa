"""Probability distributions of one number: uniform, normal, lognormal; read from tables, told apart from impossible ones."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

from scipy.special import ndtr, ndtri

from coaxshell.errors import InputError
from coaxshell.model.base import shown

REMEDY = (
    "write {normal = {mean, deviation}}, {uniform = {from, to}}, {lognormal = {median, factor}}, {relative = 0.1} for a normal one "
    "about the nominal value, or two ends [low, high]"
)


@dataclass(frozen=True)
class Uniform:
    """Equally likely between two ends, in SI or text with a unit; with ``relative=True`` factors of the nominal value.

    With ``log=True`` its logarithm is: for what is known to within decades.
    """

    low: Any
    high: Any
    relative: bool = False
    log: bool = False

    def quantile(self, share: float) -> float:
        """Return the value below which a share of the distribution lies."""
        if self.log:
            return float(self.low * (self.high / self.low) ** share)
        return float(self.low + share * (self.high - self.low))

    def share(self, value: float) -> float:
        """Return the share of the distribution below a value."""
        if self.log:
            value = math.log(max(value, self.low) / self.low) / math.log(self.high / self.low)
        else:
            value = (value - self.low) / (self.high - self.low)
        return min(max(value, 0.0), 1.0)


@dataclass(frozen=True)
class Normal:
    """Normal with a mean and a standard deviation; with ``relative=True`` factors of the nominal value, as ``Normal(1, 0.05, True)``."""

    mean: Any
    deviation: Any
    relative: bool = False

    def quantile(self, share: float) -> float:
        """Return the value below which a share of the distribution lies."""
        return float(self.mean + self.deviation * ndtri(share))

    def share(self, value: float) -> float:
        """Return the share of the distribution below a value."""
        return float(ndtr((value - self.mean) / self.deviation))


@dataclass(frozen=True)
class LogNormal:
    """The logarithm is normal: *median*, and *factor* > 1 within which (times or over) 68 % lie; may be relative."""

    median: Any
    factor: float
    relative: bool = False

    def quantile(self, share: float) -> float:
        """Return the value below which a share of the distribution lies."""
        return float(self.median * self.factor ** ndtri(share))

    def share(self, value: float) -> float:
        """Return the share of the distribution below a value."""
        return float(ndtr(math.log(value / self.median) / math.log(self.factor))) if value > 0 else 0.0


Distribution = Uniform | Normal | LogNormal

ENTRIES: dict[str, tuple[type[Distribution], tuple[str, str]]] = {
    "uniform": (Uniform, ("from", "to")),
    "normal": (Normal, ("mean", "deviation")),
    "lognormal": (LogNormal, ("median", "factor")),
}
"""Kinds of distributions: class, and the names of the two numbers in a table."""
LAWS = frozenset({"from", "to", "relative", *ENTRIES})
"""Entries by which a table is known as a distribution."""


def law_of(given: Any, where: str) -> Distribution:
    """Return the distribution that is given as an object, a table, or two ends; its numbers are still as the user wrote them.

    Raises
    ------
    InputError
        It is none of them, or an entry is missing or unknown.
    """
    if isinstance(given, Uniform | Normal | LogNormal):
        return given
    if isinstance(given, Sequence) and not isinstance(given, str) and len(given) == 2:
        return Uniform(given[0], given[1])
    if not isinstance(given, Mapping):
        raise InputError(where, f"{shown(given)} is not a distribution", REMEDY)
    if "from" in given or "to" in given:
        return _named("uniform", given, relative=False, where=where)
    relative = given.get("relative", False)
    if set(given) == {"relative"} and not isinstance(relative, bool):
        return Normal(1.0, relative, relative=True)
    kinds = [key for key in given if key in ENTRIES]
    if len(kinds) != 1 or set(given) - {*kinds, "relative"} or not isinstance(relative, bool):
        raise InputError(where, f"{shown(given)} is not a distribution", REMEDY)
    return _named(kinds[0], given[kinds[0]], relative=relative, where=f"{where}.{kinds[0]}")


def _named(kind: str, given: Any, *, relative: bool, where: str) -> Distribution:
    law, names = ENTRIES[kind]
    if isinstance(given, Sequence) and not isinstance(given, str) and len(given) == 2:
        return law(given[0], given[1], relative)
    if not isinstance(given, Mapping):
        raise InputError(where, f"{shown(given)} is not a {kind} distribution", f"give {names[0]} and {names[1]}")
    allowed = (*names, "scale") if kind == "uniform" else names
    for name in given:
        if name not in allowed:
            raise InputError(f"{where}.{name}", f"is not an entry of a {kind} distribution", f"allowed: {', '.join(allowed)}")
    for name in names:
        if name not in given:
            raise InputError(f"{where}.{name}", "is missing", f"a {kind} distribution needs {names[0]} and {names[1]}")
    if law is Uniform:
        scale = given.get("scale", "linear")
        if scale not in ("linear", "log"):
            raise InputError(f"{where}.scale", f"{shown(scale)} is not allowed", 'must be "linear" or "log"')
        return Uniform(given["from"], given["to"], relative, scale == "log")
    return law(given[names[0]], given[names[1]], relative)


def check(law: Distribution, where: str) -> None:
    """Refuse a distribution in numbers that is empty or degenerate; InputError says why."""
    first, second = (getattr(law, entry.name) for entry in fields(law)[:2])
    if isinstance(law, Uniform) and not first < second:
        raise InputError(where, f"the range from {first!r} to {second!r} is empty", "the first must be less than the second")
    if isinstance(law, Uniform) and law.log and not first > 0:
        raise InputError(where, f"{first!r} has no logarithm", 'must be greater than 0 with scale = "log"')
    if isinstance(law, Normal) and not second > 0:
        raise InputError(where, f"a standard deviation of {second!r} is not allowed", "must be greater than 0")
    if isinstance(law, LogNormal) and not (first > 0 and second > 1):
        problem = f"a median of {first!r} with a factor of {second!r} is not allowed"
        raise InputError(where, problem, "the median must be greater than 0, the factor than 1")
