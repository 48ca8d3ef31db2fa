"""The paper's Figure 3: stress and displacement at head and tail of the inner and the outer shell."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from coaxshell.errors import InputError
from coaxshell.plotting.histories import QUANTITIES, TIME_LABEL, History, history, mark_peak
from coaxshell.plotting.scales import Scale, common_scales
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from coaxshell.response import Response

_POINTS = ("head", "tail")
_Curves = dict[str, History]


def figure_bare_histories(response: Response) -> Figure:
    """Draw hoop stress and normal displacement at head and tail of the innermost and outermost shell.

    All panels share the same two scales, and the zero lines and grids of both coincide. The circles mark the largest
    magnitudes; the stress at its circle is written above the panel.

    Parameters
    ----------
    response : Response
        Of a system with any number of shells; one with a single shell gives two panels.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        All shells are rigid.
    """
    shells = _shells(response)
    head = response.system.sources[0].angle
    curves = {
        (shell, point): {quantity: history(response, quantity, shell, head + turn) for quantity in ("stress", "displacement")}
        for shell, _ in shells
        for point, turn in zip(_POINTS, (0.0, 180.0), strict=True)
    }
    stress, displacement = _scales(list(curves.values()))
    with style():
        figure = new_figure(PAGE_WIDTH, 1.0 + 2.05 * len(shells))
        axes = figure.subplots(len(shells), 2, squeeze=False, sharex=True)
        for row, (shell, name) in enumerate(shells):
            for column, point in enumerate(_POINTS):
                ax: Axes = axes[row, column]
                panel = curves[shell, point]
                right = _panel(ax, panel, stress, displacement)
                ax.set_title(f"{'abcd'[2 * row + column]}  {name}, {point}", loc="left", fontweight="bold")
                _label_outside(ax, right, first=column == 0, bottom=row == len(shells) - 1)
                if row == 0:
                    _milliseconds(ax, panel["stress"].milliseconds)
        figure.legend(handles=_legend(), loc="outside lower center", ncols=3)
    return figure


def _shells(response: Response) -> list[tuple[int, str]]:
    """Return the innermost and the outermost elastic shell, which may be the same one."""
    elastic = response.system.shell_indices()
    if not elastic:
        raise InputError("shells", "there are only rigid shells, which have no stress", "draw a system with an elastic shell")
    if len(response.system.shells) == 1:
        return [(0, "Shell")]
    names = {elastic[0]: "Inner shell", elastic[-1]: "Outer shell"}
    return list(names.items())


def _scales(curves: list[_Curves]) -> tuple[Scale, Scale]:
    ranges = []
    for quantity in ("stress", "displacement"):
        values = [panel[quantity].values for panel in curves]
        ranges.append((float(min(v.min() for v in values)), float(max(v.max() for v in values))))
    stress, displacement = common_scales(ranges)
    return stress, displacement


def _panel(ax: Axes, curves: _Curves, stress: Scale, displacement: Scale) -> Axes:
    right: Axes = ax.twinx()
    right.grid(visible=False)
    for axis, quantity, scale, width in ((right, "displacement", displacement, 1.0), (ax, "stress", stress, 1.2)):
        drawn, curve = QUANTITIES[quantity], curves[quantity]
        axis.plot(curve.time, curve.values, color=drawn.colour, linewidth=width, linestyle=_dash(quantity))
        mark_peak(curve, axis, color=drawn.colour, markersize=6.0 if quantity == "stress" else 4.5)
        axis.set_ylim(*scale.limits)
        axis.set_yticks(scale.ticks)
        axis.tick_params(axis="y", colors=drawn.colour)
    # Stress is drawn over displacement, and the grid under both.
    ax.set_zorder(right.get_zorder() + 1)
    ax.patch.set_visible(False)
    ax.axhline(0.0, color=COLOURS["grey"], linewidth=0.6, zorder=1)
    curve = curves["stress"]
    ax.set_xlim(float(curve.time[0]), float(curve.time[-1]))
    time, value = curve.peak
    ax.set_title(
        f"{value:.3g} MPa at $t$ = {time:.2f}".replace("-", "\N{MINUS SIGN}"), loc="right", fontsize=8, color=QUANTITIES["stress"].colour
    )
    return right


def _label_outside(ax: Axes, right: Axes, *, first: bool, bottom: bool) -> None:
    if first:
        ax.set_ylabel(QUANTITIES["stress"].label, color=QUANTITIES["stress"].colour)
        right.tick_params(axis="y", labelright=False)
    else:
        right.set_ylabel(QUANTITIES["displacement"].label, color=QUANTITIES["displacement"].colour)
        ax.tick_params(axis="y", labelleft=False)
    if bottom:
        ax.set_xlabel(TIME_LABEL)


def _milliseconds(ax: Axes, per_transit: float) -> None:
    def to_milliseconds(transits: Any) -> Any:
        return transits * per_transit

    def to_transits(milliseconds: Any) -> Any:
        return milliseconds / per_transit

    top = ax.secondary_xaxis("top", functions=(to_milliseconds, to_transits))
    top.set_xlabel("time (ms)")


def _dash(quantity: str) -> Any:
    return "solid" if quantity == "stress" else (0, (4.5, 1.5))


def _legend() -> list[Any]:
    from matplotlib.lines import Line2D

    lines = [
        Line2D([], [], color=QUANTITIES[quantity].colour, linestyle=_dash(quantity), label=label)
        for quantity, label in (("stress", "hoop stress (left)"), ("displacement", "inward displacement (right)"))
    ]
    circle = Line2D([], [], color=COLOURS["grey"], marker="o", markerfacecolor="none", linestyle="none", label="largest magnitude")
    return [*lines, circle]
