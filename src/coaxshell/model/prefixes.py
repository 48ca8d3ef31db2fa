"""SI prefixes, for numbers that people read."""

from __future__ import annotations

PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "µ", -9: "n", -12: "p"}
"""Prefix of each power of ten, largest first."""


def exponent_of(magnitude: float) -> int:
    """Return the power of ten whose prefix leaves four digits of *magnitude* between 1 and 1000; 0 below all of them."""
    return next((e for e in PREFIXES if abs(magnitude) >= 0.99995 * 10.0**e), 0)


def engineering(value: float, unit: str) -> str:
    """Return a value with four digits and the SI prefix that fits: 181500 Pa is ``181.5 kPa``."""
    exponent = exponent_of(value)
    digits = f"{value / 10.0**exponent:#.4g}".rstrip(".") if value else "0"
    return f"{digits} {PREFIXES[exponent]}{unit}"
