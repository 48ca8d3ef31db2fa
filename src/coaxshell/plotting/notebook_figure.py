"""A figure that needs no screen and yet shows itself in a notebook."""

from __future__ import annotations

from io import BytesIO

from matplotlib.figure import Figure

from coaxshell.plotting.style import style


class NotebookFigure(Figure):
    """A matplotlib figure outside pyplot: as the last line of a notebook's cell it appears as an image."""

    def _repr_png_(self) -> bytes:
        target = BytesIO()
        with style():
            self.savefig(target, format="png", dpi=self.dpi)
        return target.getvalue()
