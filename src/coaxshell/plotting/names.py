"""Names that people give, as they are drawn: letter by letter, never as mathematics."""

from __future__ import annotations

from coaxshell.numerics.texts import visible


def literal(name: str) -> str:
    r"""Return a name as matplotlib draws it as it stands: ``$`` as ``\$``, what cannot be seen as �."""
    return visible(name).replace("$", r"\$")
