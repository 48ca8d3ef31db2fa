"""Figures as files, never half written."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

from coaxshell.errors import InputError
from coaxshell.numerics.files import replacing
from coaxshell.plotting.style import style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FIGURE_SUFFIXES = (".png", ".pdf", ".svg")
"""Kinds of file that a figure can be saved as."""

_NO_DATE = {".png": {"Software": None}, ".pdf": {"CreationDate": None}, ".svg": {"Date": None}}


def save_figure(figure: Figure, path: str | Path) -> Path:
    """Save a figure; the same figure gives the same bytes. Written whole or not at all.

    Parameters
    ----------
    figure : matplotlib Figure
    path : str or Path
        Where to; the ending tells the kind, one of :data:`FIGURE_SUFFIXES`.

    Raises
    ------
    InputError
        The ending is not one of them, or the file cannot be written.
    """
    target = Path(path)
    suffix = known_suffix(target, FIGURE_SUFFIXES)
    made = io.BytesIO()  # a disk that is full while a PDF is written leaves it open behind an error of zlib's
    with style():
        figure.savefig(made, format=suffix[1:], metadata=_NO_DATE[suffix])
    with replacing(target) as partial:
        partial.write_bytes(made.getbuffer())
    return target


def known_suffix(path: Path, suffixes: tuple[str, ...]) -> str:
    """Return the ending of a file's name in small letters; InputError if it is not one of the given ones."""
    suffix = path.suffix.lower()
    if suffix not in suffixes:
        raise InputError("path", f"{str(path)!r} has no known ending", f"allowed: {', '.join(suffixes)}")
    return suffix
