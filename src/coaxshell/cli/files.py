"""What a command is going to write: refused before the work starts. One rule: nothing that exists is overwritten without --force."""

from __future__ import annotations

import os
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from coaxshell.cli.values import named_as_options
from coaxshell.errors import InputError
from coaxshell.numerics.files import free_file, free_folder

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Outputs:
    """The files and folders that one command is to write, each claimed before the computation.

    Parameters
    ----------
    force : bool
        Whether what exists may be replaced.
    """

    def __init__(self, force: bool) -> None:
        self.force = force
        self._claimed: dict[str, str] = {}

    def file(self, path: Path, option: str, suffixes: Sequence[str]) -> Path:
        """Claim a file of one of the kinds and return its path; InputError if it cannot be written, or is claimed already."""
        if path.suffix.lower() not in suffixes:
            raise InputError(option, f"{str(path)!r} has no known ending", f"allowed: {', '.join(suffixes)}")
        free_file(path, option, force=self.force)
        self._claim(path, option)
        return path

    def figure(self, path: Path | None, option: str = "--figure") -> None:
        """Claim a figure, if there is to be one."""
        if path is not None:
            from coaxshell.plotting.saving import FIGURE_SUFFIXES

            self.file(path, option, FIGURE_SUFFIXES)

    def folder(self, path: Path, option: str, parts: Collection[str]) -> Path:
        """Claim a folder that will hold a result of some parts and return its path."""
        free_folder(path, parts, option, force=self.force)
        self._claim(path, option)
        return path

    def _claim(self, path: Path, option: str) -> None:
        other = self._claimed.setdefault(os.path.realpath(path), option)
        if other != option:
            raise InputError(option, f"{str(path)!r} is what {other} writes already", "give each its own name")


def write_figure(figure: Figure, path: Path, option: str = "--figure") -> None:
    """Save a figure; InputError names the option that told where to."""
    from coaxshell.plotting.saving import save_figure

    with named_as_options(path=option.removeprefix("--")):
        save_figure(figure, path)
