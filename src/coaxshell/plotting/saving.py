"""Figures and other files, never half written."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
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
    suffix = known_suffix(target, FIGURE_SUFFIXES)
    with replacing(target) as partial, style():
        figure.savefig(partial, metadata=_NO_DATE[suffix])
    return target


def known_suffix(path: Path, suffixes: tuple[str, ...]) -> str:
    """Return the ending of a file's name in small letters; InputError if it is not one of the given ones."""
    suffix = path.suffix.lower()
    if suffix not in suffixes:
        raise InputError("path", f"{str(path)!r} has no known ending", f"allowed: {', '.join(suffixes)}")
    return suffix


@contextmanager
def replacing(target: Path) -> Iterator[Path]:
    """Yield a hidden name beside *target* to write to; it is renamed at the end, or removed when something goes wrong.

    Raises
    ------
    InputError
        The file cannot be written there.
    """
    partial = target.with_name(f".{target.stem}.{os.getpid()}.part{target.suffix.lower()}")
    try:
        yield partial
        partial.replace(target)
    except OSError as error:
        raise InputError("path", f"cannot write {str(target)!r}: {error.strerror or error}", "give a place that you may write to") from None
    finally:
        partial.unlink(missing_ok=True)
