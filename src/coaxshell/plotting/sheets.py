"""The layout of a sheet of square panels: groups of panels in rows, headings above, colour bars in what is left."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from coaxshell.plotting.style import literal, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Inches.
PANEL = 1.78
_GAP, _GROUP_GAP = 0.08, 0.2
_TITLE, _HEADING = 0.25, 0.24
_LEFT, _RIGHT, _BOTTOM, _TOP = 0.45, 0.12, 0.42, 0.05
_BAR_HEIGHT, _BAR_PITCH, _BAR_LEAST, _BAR_MOST = 0.11, 0.62, 1.5, 3.0


@dataclass(frozen=True)
class Sheet:
    """Where the panels of a sheet lie.

    Attributes
    ----------
    groups : int
        Groups of panels, one an instant, in reading order.
    members : int
        Panels of a group, side by side: one a system.
    columns : int
        Groups in a row.
    upward : str
        Label of the axes that point upward.
    """

    groups: int
    members: int
    columns: int
    upward: str = "$y/a$"

    @property
    def rows(self) -> int:
        """Number of rows."""
        return -(-self.groups // self.columns)

    @property
    def group_width(self) -> float:
        """Width of a group, inches."""
        return self.members * PANEL + (self.members - 1) * _GAP

    @property
    def pitch(self) -> float:
        """From the left edge of a group to that of the next, inches."""
        return self.group_width + (_GROUP_GAP if self.members > 1 else _GAP)

    @property
    def bars_below(self) -> bool:
        """Whether the last row is full, so that the colour bars need a strip of their own."""
        return self.groups % self.columns == 0

    @property
    def size(self) -> tuple[float, float]:
        """Width and height of the page, inches."""
        width = _LEFT + self.columns * self.pitch - (self.pitch - self.group_width) + _RIGHT
        heading = _HEADING if self.members > 1 else 0.0
        return width, _TOP + heading + self.rows * (PANEL + _TITLE) + _BOTTOM + self._foot

    def new_figure(self) -> Figure:
        """Return an empty figure of the sheet's size whose axes stay where they are put."""
        figure = new_figure(*self.size)
        figure.set_layout_engine("none")
        return figure

    def panel(self, figure: Figure, group: int, member: int) -> Axes:
        """Add and return the axes of one panel; only those at the left and at the bottom are labelled."""
        row, column = divmod(group, self.columns)
        left = _LEFT + column * self.pitch + member * (PANEL + _GAP)
        ax = self._axes(figure, left, self._row_bottom(row), PANEL, PANEL)
        leftmost, lowest = column == 0 and member == 0, group + self.columns >= self.groups
        ax.tick_params(labelleft=leftmost, left=leftmost, labelbottom=lowest, bottom=lowest, length=2.5, pad=2)
        if leftmost:
            ax.set_ylabel(self.upward, labelpad=1)
        if lowest:
            ax.set_xlabel("$x/a$", labelpad=1)
        return ax

    def title(self, figure: Figure, group: int, text: str) -> None:
        """Write above the panels of a group."""
        row, column = divmod(group, self.columns)
        self._text(figure, _LEFT + column * self.pitch + 0.5 * self.group_width, self._row_bottom(row) + PANEL + 0.05, text)

    def headings(self, figure: Figure, names: list[str]) -> None:
        """Write the names of the members above their columns."""
        height = self._row_bottom(0) + PANEL + _TITLE + 0.04
        for column in range(self.columns):
            for member, name in enumerate(names):
                centre = _LEFT + column * self.pitch + member * (PANEL + _GAP) + 0.5 * PANEL
                self._text(figure, centre, height, literal(name), weight="bold")

    def bars(self, figure: Figure) -> list[Axes]:
        """Add and return the axes of two horizontal colour bars: one above the other in the free cells, or side by side below."""
        width, _ = self.size
        if self.bars_below and self._stacked:
            length = min(_BAR_MOST, width - 0.6)
            return [self._axes(figure, 0.5 * (width - length), height, length, _BAR_HEIGHT) for height in (0.42 + _BAR_PITCH, 0.42)]
        if self.bars_below:
            length = min(_BAR_MOST, 0.5 * (width - _LEFT - _RIGHT) - 0.3)
            centres = (_LEFT + (width - _LEFT - _RIGHT) * share for share in (0.25, 0.75))
            return [self._axes(figure, centre - 0.5 * length, 0.42, length, _BAR_HEIGHT) for centre in centres]
        start = _LEFT + (self.groups % self.columns) * self.pitch
        free = width - _RIGHT - start
        length = min(_BAR_MOST, max(_BAR_LEAST, free - 0.5))
        bottom = self._row_bottom(self.rows - 1)
        return [self._axes(figure, start + 0.5 * (free - length), bottom + height, length, _BAR_HEIGHT) for height in (1.05, 0.3)]

    @property
    def _stacked(self) -> bool:
        """Whether the page is too narrow for two colour bars side by side."""
        return self.columns * self.members <= 2

    @property
    def _foot(self) -> float:
        """Height of the strip of the colour bars."""
        return 0.0 if not self.bars_below else (2 if self._stacked else 1) * _BAR_PITCH

    def _row_bottom(self, row: int) -> float:
        return self._foot + _BOTTOM + (self.rows - 1 - row) * (PANEL + _TITLE)

    def _axes(self, figure: Figure, left: float, bottom: float, width: float, height: float) -> Axes:
        across, up = self.size
        return figure.add_axes((left / across, bottom / up, width / across, height / up))

    def _text(self, figure: Figure, x: float, y: float, text: str, weight: str = "normal") -> None:
        across, up = self.size
        figure.text(x / across, y / up, text, ha="center", va="bottom", fontsize=8.5, fontweight=weight)
