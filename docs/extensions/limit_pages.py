"""What data from outside may cost, as one table."""

from __future__ import annotations

from coaxshell.limits import TABLE

HEAD = """# What data from outside may cost

Texts, files and requests are measured before they are parsed, and what is larger than this is refused in one line that names both
numbers. The studio has bounds of its own on what one request may compute; it tells them beside the field.

| what | at most | |
|---|---:|---|
"""


def limit_table() -> str:
    """Return the page: one row for each bound."""
    return HEAD + "".join(f"| {limit.what} | {limit.value:,} | {limit.unit} |\n" for limit in TABLE)
