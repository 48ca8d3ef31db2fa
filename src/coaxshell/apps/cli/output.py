"""What a command says and writes: text that any terminal can take, tables, documents for programs, files that replace nothing unasked.

Text goes out in letters that the stream can write, without commands to the terminal, and with no fuss when nobody reads. Tables are drawn
on a terminal, plain aligned text elsewhere; ``--json`` prints one document on stdout instead, in SI, with the units beside it. Warnings
go to stderr, each once. What a command is going to write is refused before the work starts; one rule: nothing that exists is overwritten
without --force.
"""

from __future__ import annotations

import codecs
import io
import json
import math
import os
import sys
import warnings
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, TextIO, overload

from coaxshell.apps.cli.options import named_as_options
from coaxshell.errors import InputError, PhysicsWarning
from coaxshell.numerics.files import free_file, free_folder
from coaxshell.numerics.texts import visible

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from rich.table import Table

    from coaxshell.response import Response
    from coaxshell.response.peaks import Peak
    from coaxshell.response.summary import Summary


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


@contextmanager
def plain_physics_warnings() -> Iterator[None]:
    """Show physics warnings as ``warning: ...`` on stderr; leave all other warnings as they were."""
    said: set[str] = set()
    with warnings.catch_warnings():
        usual = warnings.showwarning

        def show(
            message: Warning | str, category: type[Warning], filename: str, lineno: int, file: TextIO | None = None, line: str | None = None
        ) -> None:
            if not issubclass(category, PhysicsWarning):
                usual(message, category, filename, lineno, file, line)
                return
            text = " ".join(str(message).split())
            if text not in said:
                said.add(text)
                sys.stderr.write(printable(f"warning: {text}\n"))

        warnings.simplefilter("always", PhysicsWarning)
        warnings.showwarning = show
        yield


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

    @overload
    def figure_or_table(self, path: Path) -> Path: ...
    @overload
    def figure_or_table(self, path: Path | None) -> Path | None: ...
    def figure_or_table(self, path: Path | None) -> Path | None:
        """Claim a figure, or a .csv, if there is to be one, and return its path."""
        from coaxshell.plotting.saving import FIGURE_SUFFIXES

        return None if path is None else self.file(path, "--output", (*FIGURE_SUFFIXES, ".csv"))

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


def print_summary(response: Response) -> None:
    """Print the summary of a run on stdout and its warnings on stderr."""
    from coaxshell.response.summary import Summary

    whole = response.summary()
    summary = whole.without_warnings()
    if sys.stdout.isatty() and isinstance(summary, Summary):
        from rich.console import Console

        from coaxshell.response.summary_text import notes

        console = Console()
        console.print(summary_table(summary))
        console.print("\n".join(printable(note) for note in notes(summary.to_dict())), markup=False, highlight=False)
    else:
        echo(str(summary).rstrip())
    tell_warnings(whole.warnings)


def tell_warnings(texts: Iterable[str]) -> None:
    """Tell the warnings of a run."""
    for text in texts:
        warnings.warn(PhysicsWarning(text), stacklevel=2)


def summary_table(summary: Summary) -> Table:
    """Return the summary as a table with one section for each shell."""
    from rich import box
    from rich.markup import escape
    from rich.table import Table

    from coaxshell.response.quantities import summary_rows

    title, run, *_ = printable(str(summary)).splitlines()
    table = Table(title=f"{escape(title)}\n[not bold]{escape(run)}[/]", title_justify="left", title_style="bold", box=box.SIMPLE_HEAD)
    table.add_column("shell", style="bold")
    table.add_column("largest magnitude")
    for heading in ("value", "t (a/c)", "angle (°)"):
        table.add_column(heading, justify="right", no_wrap=True)
    for shell in summary.shells:
        rows = [(label, cells) for key, label, unit in summary_rows() if (cells := _cells(getattr(shell, key), unit))]
        for number, (label, cells) in enumerate(rows):
            table.add_row(shell.name if number == 0 else "", label, *cells, end_section=number == len(rows) - 1)
    return table


def _cells(value: Peak | float | None, unit: str) -> tuple[str, ...]:
    """Return value, time and angle as text; nothing at all for what a shell does not have."""
    from coaxshell.model.prefixes import engineering
    from coaxshell.response.summary_text import when

    if value is None:
        return ()
    if isinstance(value, int | float):
        return engineering(value, unit), "", ""
    return engineering(value.value, unit), when(asdict(value)), f"{value.angle:.4g}"


def print_document(content: Mapping[str, Any]) -> None:
    """Print plain data as one JSON document; what is not finite becomes null."""
    sys.stdout.write(json.dumps(_plain(content), indent=2, ensure_ascii=False, allow_nan=False) + "\n")
    sys.stdout.flush()


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
