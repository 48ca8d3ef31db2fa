"""What sources do at the head point: pressure against time, and the impulse that it adds up to."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from coaxshell.acoustics.pulse_histories import pulse_history, pulse_impulse
from coaxshell.model.prefixes import PREFIXES, exponent_of
from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.style import COLOURS, PAGE_WIDTH, literal, new_figure, style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from coaxshell.model import System

_COLOURS = ("blue", "orange", "green", "purple", "sky", "amber")
_POINTS = 2001


def load_histories(system: System, duration: float) -> dict[str, FloatArray]:
    """Return time (s), free-field pressure (Pa) and impulse (Pa s) of each source at its head point, as columns by name with unit.

    Parameters
    ----------
    system : System
    duration : float
        How long, s.
    """
    time = np.linspace(0.0, duration, _POINTS)
    table = {"time (s)": time}
    for number, source in enumerate(system.sources):
        name = f"source {number + 1} " if len(system.sources) > 1 else ""
        table[f"{name}pressure (Pa)"] = pulse_history(source.pulse, time - source.delay, 1.0, 1.0)
        table[f"{name}impulse (Pa s)"] = pulse_impulse(source.pulse, time - source.delay, 1.0, 1.0)
    return table


def figure_loads(system: System, duration: float) -> Figure:
    """Draw pressure and impulse of each source at its head point, as if nothing were in the water.

    Parameters
    ----------
    system : System
    duration : float
        How long, s.
    """
    table = load_histories(system, duration)
    time = table.pop("time (s)")
    t = exponent_of(duration)
    with style():
        figure = new_figure(PAGE_WIDTH, 2.2)
        panels = figure.subplots(1, 2)
        for ax, what, unit in zip(panels, ("pressure", "impulse"), ("Pa", "Pa s"), strict=True):
            curves = {name.removesuffix(f"{what} ({unit})").strip(): values for name, values in table.items() if what in name}
            power = exponent_of(max(float(np.abs(values).max()) for values in curves.values()) or 1.0)
            for colour, (name, values) in zip(_COLOURS, curves.items(), strict=False):
                ax.plot(time / 10.0**t, values / 10.0**power, color=COLOURS[colour], label=literal(name) or None)
            ax.axhline(0.0, color=COLOURS["grey"], linewidth=0.5, zorder=1)
            ax.set_xlim(0.0, duration / 10.0**t)
            ax.set_xlabel(f"time ({PREFIXES[t]}s)")
            ax.set_ylabel(f"{what} ({PREFIXES[power]}{unit})")
        if len(system.sources) > 1:
            panels[0].legend(loc="best")
    return figure
