"""What a report is made of: pictures with their data, tables, texts, sections."""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from coaxshell.response import Response

Columns = Mapping[str, npt.NDArray[np.float64]]
MOST_ROWS = 5001
"""Rows of a table of data: of more every so many are kept."""
MOST_SHELLS = 3
"""Shells that are drawn: of more those that are stressed most."""


@dataclass(frozen=True)
class Picture:
    """A figure: its bytes, "png" or "svg+xml", what it shows for those who cannot see it, a caption, and the data drawn."""

    name: str
    form: str
    content: bytes
    alt: str
    caption: str
    data: Columns = field(default_factory=dict)

    @property
    def table(self) -> str:
        """The data as CSV text, names and units in the first row, six digits; "" if there are none."""
        if not self.data:
            return ""
        every = -(-max(len(values) for values in self.data.values()) // MOST_ROWS)
        columns = [[f"{value:.6g}" for value in values[::every].tolist()] for values in self.data.values()]
        head = ",".join(name.replace(",", ";") for name in self.data)
        return "\n".join([head, *map(",".join, zip(*columns, strict=True))]) + "\n"


@dataclass(frozen=True)
class Table:
    """A table of texts: what it holds, its headings, its rows; the first *words* columns hold words, the others numbers."""

    caption: str
    headings: Sequence[str]
    rows: Sequence[Sequence[str]]
    words: int = 1


@dataclass(frozen=True)
class Code:
    """Text to be copied: a command, a scenario; *name* is that of the file it can be saved as, *printed* whether paper shows it too."""

    text: str
    name: str = ""
    printed: bool = True


@dataclass(frozen=True)
class Listed:
    """Sentences one below the other."""

    items: Sequence[str]


@dataclass(frozen=True)
class Drawing:
    """An ``<svg>`` element that stands in the page as it is, and its caption."""

    svg: str
    caption: str


@dataclass(frozen=True)
class Beside:
    """A drawing on the left, and what stands beside it."""

    drawing: Drawing
    items: Sequence[str | Table]


Item = str | Picture | Table | Code | Listed | Drawing | Beside
"""What stands in a section, a text being a paragraph."""


@dataclass(frozen=True)
class Section:
    """A section: its title and what stands in it."""

    title: str
    items: Sequence[Item]


@dataclass(frozen=True)
class Subject:
    """What a report is about.

    Attributes
    ----------
    runs : mapping of str to Response
        The run, and the one that it is compared with if there is one, at what can be compared.
    shells : list of int
        Those of the run that are drawn.
    """

    runs: Mapping[str, Response]
    shells: Sequence[int]

    @property
    def name(self) -> str:
        """Name of the run."""
        return next(iter(self.runs))

    @property
    def run(self) -> Response:
        """The run."""
        return next(iter(self.runs.values()))

    @property
    def labelled(self) -> dict[str, Response]:
        """The runs by the names of legends, "" where there is one alone."""
        return dict(self.runs) if len(self.runs) > 1 else {"": self.run}

    def of(self, response: Response) -> list[int]:
        """Return the drawn shells that a run has and that are elastic."""
        return [shell for shell in response.system.shell_indices(None) if shell in self.shells]


def lower(figure: Figure, height: float) -> Figure:
    """Return a figure made as high as given, inches, its width as it was; long labels of its upright axes take two lines."""
    figure.set_size_inches(figure.get_size_inches()[0], height)
    for ax in figure.axes:
        ax.set_ylabel(ax.get_ylabel().replace(", ", ",\n"))
    return figure


def drawn(figure: Figure, name: str, alt: str, caption: str, data: Columns | None = None, *, form: str = "svg") -> Picture:
    """Return a figure as a picture: "svg" with its letters as outlines, which look alike everywhere, or "png" of 150 dots an inch."""
    from coaxshell.plotting.style import style

    made = io.BytesIO()
    with style():
        import matplotlib as mpl

        mpl.rcParams["svg.fonttype"] = "path"
        figure.savefig(made, format=form, dpi=150, metadata={"Date": None} if form == "svg" else {"Software": None})
    return Picture(name, "svg+xml" if form == "svg" else form, made.getvalue(), alt, caption, data or {})
