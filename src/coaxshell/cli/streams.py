"""What reaches the terminal: in letters that it can write, without commands to it, and no fuss when nobody reads."""

from __future__ import annotations

import codecs
import io
import os
import sys

from coaxshell.numerics.texts import visible

_PLAIN = {
    "µ": "u",
    "μ": "u",
    "°": " deg",
    "²": "^2",
    "³": "^3",
    "·": "*",
    "×": "x",
    "–": "-",
    "—": "-",
    "−": "-",
    "…": "...",
    "→": "->",
    "ζ": "zeta",
    "θ": "theta",
    "ρ": "rho",
    "α": "alpha",
    "π": "pi",
    "Δ": "Delta",
    "≤": "<=",
    "≥": ">=",
    "±": "+-",
    "√": "sqrt",
}
_HANDLER = "coaxshell"


def _spelled(error: UnicodeError) -> tuple[str, int]:
    """Spell what an encoding lacks: µ as u, any other letter as a question mark."""
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(_PLAIN.get(letter, "?") for letter in error.object[error.start : error.end]), error.end


codecs.register_error(_HANDLER, _spelled)


def prepare_streams() -> None:
    """Make stdout and stderr take any text; one that was closed becomes one that nobody reads."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115 - open as long as the process
        elif isinstance(stream, io.TextIOWrapper) and stream.errors == "strict":
            stream.reconfigure(errors=_HANDLER)


def give_up_stdout() -> None:
    """Send what is still to be written nowhere: the reader of a pipe has gone."""
    try:
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)
    except (OSError, ValueError):  # no file of the system's behind it
        sys.stdout = io.StringIO()


def printable(text: str) -> str:
    """Return a text without what a terminal would obey."""
    return visible(text, keep="\n\t")


def echo(text: str = "", *, aside: bool = False) -> None:
    """Print a text and the end of a line on stdout, or on stderr if it is an aside to a document for programs."""
    stream = sys.stderr if aside else sys.stdout
    stream.write(printable(text) + "\n")
    stream.flush()
