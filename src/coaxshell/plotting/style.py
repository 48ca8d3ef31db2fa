"""Sizes and colours of all figures, applied in a context and never globally; names as they are drawn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from types import MappingProxyType
from typing import TYPE_CHECKING

from coaxshell.numerics.texts import visible

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLUMN_WIDTH = 3.5
"""Width of a figure in one column, inches."""
PAGE_WIDTH = 7.2
"""Width of a figure across the page, inches."""

COLOURS: Mapping[str, str] = MappingProxyType(
    {
        "blue": "#0072B2",
        "orange": "#D55E00",
        "green": "#009E73",
        "purple": "#CC79A7",
        "sky": "#56B4E9",
        "amber": "#E69F00",
        "grey": "#6E6E6E",
    }
)
"""Okabe and Ito's colours, told apart with any kind of colour vision."""

_SETTINGS: Mapping[str, object] = MappingProxyType(
    {
        "font.size": 8.5,
        "axes.titlesize": 9,
        "axes.labelsize": 8.5,
        "axes.linewidth": 0.6,
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.color": "#E3E3E3",
        "grid.linewidth": 0.5,
        "xtick.labelsize": 8,
        "ytick.labelsize": 8,
        "xtick.major.width": 0.6,
        "ytick.major.width": 0.6,
        "legend.fontsize": 8.5,
        "legend.frameon": False,
        "lines.linewidth": 1.1,
        "lines.solid_capstyle": "round",
        "path.simplify_threshold": 0.2,
        "savefig.dpi": 200,
        "svg.fonttype": "none",
        "svg.hashsalt": "coaxshell",
        "pdf.fonttype": 42,
    }
)


@contextmanager
def style() -> Iterator[None]:
    """Draw in the package's style inside a ``with`` block, whatever the user's own settings are; they are as before afterwards."""
    import matplotlib as mpl

    with mpl.rc_context():
        mpl.rcdefaults()  # a matplotlibrc may ask for TeX, other fonts, a transparent ground
        mpl.rcParams.update(_SETTINGS)  # type: ignore[arg-type]
        yield


def new_figure(width: float = PAGE_WIDTH, height: float = 4.6) -> Figure:
    """Return an empty figure of the given size in inches that needs no screen and shows itself in a notebook."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    from coaxshell.plotting.notebook_figure import NotebookFigure

    figure = NotebookFigure(style, figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def literal(name: str) -> str:
    r"""Return a name as matplotlib draws it as it stands: ``$`` as ``\$``, what cannot be seen as �."""
    return visible(name).replace("$", r"\$")
