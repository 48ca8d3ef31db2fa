"""Texts from elsewhere, made fit to be shown."""

from __future__ import annotations

import re
import unicodedata

_MINUS = re.compile(r"(?<![\w.)])-(?=\d)")
_MINUS_ZERO = re.compile(r"(?<![\w.)])[-−](?=0(?:\.0+)?(?![\de]|\.\d))")
_EXPONENT = re.compile(r"(?<=\d)e(?:\+0*|(-)0*)(?=\d)")
_POWERS = {f"^{power}": raised for power, raised in zip("234", "²³⁴", strict=True)}
_TURNING = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""What turns the direction of writing, and so can make a name look like another."""


def rounded(value: float, digits: int) -> str:
    """Return a number with so many digits, as 0.12, 8.4 or 110: up to a million without an exponent."""
    return f"{float(f'{value:.{digits}g}'):g}"


def percent(share: float, decimals: int = 1, *, signed: bool = False) -> str:
    """Return a share as a percentage; what rounds to 0 has no sign."""
    value = round(100.0 * share, decimals) + 0.0
    return f"{value:{'+' if signed and value else ''}.{decimals}f} %"


def typeset(text: str) -> str:
    """Return a text as it is printed: minus signs for hyphens before numbers but 0, 1e8 for 1e+08, N/m³ for N/m^3."""
    text = _MINUS_ZERO.sub("", text)
    for plain, raised in _POWERS.items():
        text = text.replace(plain, raised)
    return _EXPONENT.sub(lambda found: f"e{found[1] or ''}", _MINUS.sub("−", text))


def visible(text: str, keep: str = "") -> str:
    """Return a text with � for every character that is a command rather than a letter, but for those to *keep*."""
    return "".join(letter if letter in keep or _is_seen(letter) else "�" for letter in text)


def _is_seen(letter: str) -> bool:
    return unicodedata.category(letter) not in ("Cc", "Cs") and letter not in _TURNING
