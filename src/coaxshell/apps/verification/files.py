"""The report's files, each written whole or not at all."""

from __future__ import annotations

from pathlib import Path

from coaxshell.apps.verification.markdown import markdown
from coaxshell.apps.verification.page import page
from coaxshell.apps.verification.suite import Report
from coaxshell.errors import InputError
from coaxshell.numerics.files import reason, write_text

NAMES = ("report.md", "report.html")


def prepare(folder: Path, option: str = "--output") -> Path:
    """Make the folder if it is not there, so that a long run does not end with nowhere to write; InputError if that fails."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            option, f"cannot make the folder {str(folder)!r}: {reason(error)}", "give a folder that you may write to"
        ) from None
    return folder


def write_report(report: Report, folder: str | Path) -> tuple[Path, ...]:
    """Write report.md and report.html into a folder, made if need be, and return their paths.

    Raises
    ------
    InputError
        The folder cannot be made or written to.
    """
    target = prepare(Path(folder))
    paths = tuple(target / name for name in NAMES)
    for path, text in zip(paths, (markdown(report), page(report)), strict=True):
        write_text(path, text)
    return paths
