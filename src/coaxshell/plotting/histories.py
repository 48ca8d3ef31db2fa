"""One quantity at one point of one shell against time."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import Late
from coaxshell.plotting.style import COLOURS, COLUMN_WIDTH, new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

    from coaxshell.response import Response
    from coaxshell.response import quantities as outputs
else:
    outputs = Late("coaxshell.response.quantities")  # what is drawn is there already; a figure's options are told without it

TIME_LABEL = "time (acoustic transits $a/c_e$)"


@dataclass(frozen=True)
class PlottedQuantity:
    """How a quantity of the response is drawn.

    Attributes
    ----------
    method : str
        Method of the response that gives it in SI.
    label : str
        Name and unit on the axis.
    unit : str
        Unit as drawn.
    per_si : float
        Drawn units per SI unit.
    colour : str
        Colour of the curve.
    options : mapping
        What the method is given beside shell and angle.
    """

    method: str
    label: str
    unit: str
    per_si: float
    colour: str
    options: Mapping[str, Any] = field(default_factory=dict)


class _Drawn(Mapping[str, PlottedQuantity]):
    """How each quantity of the table is drawn, by name."""

    def __getitem__(self, name: str) -> PlottedQuantity:
        quantity = outputs.QUANTITIES[name]
        unit, per_si = quantity.shown
        return PlottedQuantity("history", quantity.axis, unit, per_si, COLOURS[quantity.colour], {"quantity": name})

    def __iter__(self) -> Iterator[str]:
        return iter(outputs.QUANTITIES)

    def __len__(self) -> int:
        return len(outputs.QUANTITIES)


QUANTITIES: Mapping[str, PlottedQuantity] = _Drawn()
"""Quantities that :func:`plot_history` draws, by name: those of the table :mod:`coaxshell.response.quantities`."""


@dataclass(frozen=True)
class History:
    """One curve in drawn units: times in transits, values, and milliseconds per transit."""

    time: FloatArray
    values: FloatArray
    milliseconds: float

    @property
    def peak(self) -> tuple[float, float]:
        """Time and signed value of the largest magnitude."""
        index = int(np.argmax(np.abs(self.values)))
        return float(self.time[index]), float(self.values[index])

    @property
    def still_grows(self) -> bool:
        """Whether the largest magnitude is the last one: the curve ends before it has reached its peak."""
        return bool(len(self.values) > 1 and np.argmax(np.abs(self.values)) == len(self.values) - 1)


def history(response: Response, quantity: str, shell: int | str, angle: float, station: float | None = None) -> History:
    """Return one curve of a response in drawn units, of a station of three dimensions; InputError for an unknown quantity."""
    drawn = _quantity(quantity)
    place = {} if station is None else {"station": station}
    array: Any = getattr(response, drawn.method)(shell, angle=[angle], **drawn.options, **place).isel(angle=0)
    time = np.asarray(array["time"], dtype=np.float64)
    seconds = np.asarray(array["time_seconds"], dtype=np.float64)
    milliseconds = 1e3 * float(seconds[-1] / time[-1]) if time[-1] > 0 else 1.0
    return History(time, drawn.per_si * np.asarray(array, dtype=np.float64), milliseconds)


def at_station(response: Response, station: float | str | None) -> float | None:
    """Return an axial position of a run in three dimensions (m), its first unless one is given; None in two.

    Raises
    ------
    InputError
        The run has no such station, or none at all.
    """
    if response.stations is None:
        if station is not None:
            raise InputError("station", f"{station} belongs to three dimensions", "leave it out for runs in two")
        return None
    if station is None:
        return float(response.stations[0])
    from coaxshell.response.station_choice import chosen_stations

    chosen, _ = chosen_stations(response.stations, station)
    return float(response.stations[chosen[0]])


def plot_history(
    response: Response,
    quantity: str = "stress",
    shell: int | str = "outer",
    angle: float = 0.0,
    ax: Axes | None = None,
    *,
    station: float | None = None,
    **line: Any,
) -> Axes:
    """Draw one quantity at one point of one shell against time.

    Parameters
    ----------
    response : Response
    quantity : str
        One of :data:`QUANTITIES`.
    shell : int or "inner" or "outer"
        Counted from the inside.
    angle : float
        Degrees from the source direction: 0 is the head, 180 the tail.
    ax : Axes, optional
        Where to draw; a new figure when left out.
    station : float, optional
        Of a run in three dimensions, m; its first unless given.
    **line
        Passed to ``ax.plot``.

    Returns
    -------
    Axes
    """
    drawn = _quantity(quantity)
    curve = history(response, quantity, shell, angle, at_station(response, station))
    with style():
        if ax is None:
            ax = new_figure(COLUMN_WIDTH, 2.4).add_subplot()
        ax.plot(curve.time, curve.values, **{"color": drawn.colour, **line})
        ax.set_xlabel(TIME_LABEL)
        ax.set_ylabel(drawn.label)
        ax.set_xlim(float(curve.time[0]), float(curve.time[-1]))
    return ax


def mark_peak(curve: History, ax: Axes, **marker: Any) -> Line2D:
    """Circle the largest magnitude of a curve and return the marker."""
    time, value = curve.peak
    looks = {
        "marker": "o",
        "markersize": 6.0,
        "markerfacecolor": "none",
        "markeredgewidth": 1.2,
        "linestyle": "none",
        "clip_on": False,
        "zorder": 5,
    }
    (mark,) = ax.plot([time], [value], **{**looks, **marker})
    return mark


def _quantity(name: str) -> PlottedQuantity:
    try:
        return QUANTITIES[name]
    except KeyError:
        raise InputError("quantity", f"{name!r} cannot be drawn", f"allowed: {', '.join(QUANTITIES)}") from None
