"""Numbers that people read: SI prefixes, and how one magnitude stands to another."""

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


def against(value: float | None, reference: float | None, decimals: int = 1) -> str:
    """Return in words how a magnitude stands to another.

    ``smaller by 40.1 %``, ``larger by 25.0 %``, ``3.06 times as large`` or ``the same``; from twice as large on it is the ratio that
    people grasp. A dash where there is no magnitude, or none to compare with.
    """
    if value is None or reference is None or not (value >= 0 and reference > 0):
        return "-"
    ratio = value / reference
    if ratio >= 2:
        return f"{f'{ratio:#.3g}'.rstrip('.') if ratio < 999.5 else f'{ratio:.3g}'} times as large"
    share = f"{100.0 * abs(ratio - 1):.{decimals}f}"
    return f"{'smaller' if ratio < 1 else 'larger'} by {share} %" if float(share) else "the same"
