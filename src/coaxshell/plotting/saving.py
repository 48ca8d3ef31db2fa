"""Figures to files, never half written."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from coaxshell.errors import InputError
from coaxshell.plotting.style import style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FIGURE_SUFFIXES = (".png", ".pdf", ".svg")
"""Kinds of file that a figure can be saved as."""

_NO_DATE = {".png": {"Software": None}, ".pdf": {"CreationDate": None}, ".svg": {"Date": None}}


def save_figure(figure: Figure, path: str | Path) -> Path:
    """Save a figure; the same figure gives the same bytes. Written beside its final name first, then renamed.

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
    suffix = target.suffix.lower()
    if suffix not in FIGURE_SUFFIXES:
        raise InputError("path", f"{str(target)!r} has no known ending", f"allowed: {', '.join(FIGURE_SUFFIXES)}")
    partial = target.with_name(f".{target.stem}.{os.getpid()}.part{suffix}")
    try:
        with style():
            figure.savefig(partial, metadata=_NO_DATE[suffix])
        partial.replace(target)
    except OSError as error:
        raise InputError("path", f"cannot write {str(target)!r}: {error.strerror or error}", "give a place that you may write to") from None
    finally:
        partial.unlink(missing_ok=True)
    return target
