"""A figure that needs no screen and yet shows itself in a notebook."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from io import BytesIO
from typing import Any

from matplotlib.figure import Figure


class NotebookFigure(Figure):
    """A matplotlib figure outside pyplot: as the last line of a notebook's cell it appears as an image, in its own style."""

    def __init__(self, style: Callable[[], AbstractContextManager[None]], **options: Any) -> None:
        super().__init__(**options)
        self._style = style

    def _repr_png_(self) -> bytes:
        target = BytesIO()
        with self._style():
            self.savefig(target, format="png", dpi=self.dpi)
        return target.getvalue()
