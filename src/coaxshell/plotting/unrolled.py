"""The stress of a shell of a three-dimensional run at one instant on the wall laid flat: angle across, axial position up."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.places import shell_phrase
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.field import time_stamp
from coaxshell.plotting.field_scales import STRESS_COLOURS, DrawnUnit, add_colour_bar, mappable, stress_unit
from coaxshell.plotting.frames import Frames, instants
from coaxshell.plotting.scales import round_up
from coaxshell.plotting.style import new_figure, style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from coaxshell.response import Response
    from coaxshell.response.spatial import SpatialResponse

ANGLES: FloatArray = np.arange(-180.0, 181.0, 2.0)
"""Where the stress is taken around the shell."""
_SHARE = 0.999


def plot_unrolled(
    response: SpatialResponse,
    shell: int | str,
    time: float,
    ax: Axes | None = None,
    *,
    component: str = "hoop",
    stress_limit: float | None = None,
    colour_bar: bool = True,
) -> Axes:
    """Draw a component of the stress of a shell's mid-surface at one instant over angle and axial position, at the run's stations.

    Between stations and angles colours are interpolated: run with a grid of them, ``stations=np.linspace(0, 3, 61)``. Where sources are
    alike on both sides of z = 0, stations count for both.

    Parameters
    ----------
    response : SpatialResponse
        Of at least two stations.
    shell : int or str
    time : float
        In transits; the run's nearest instant is drawn.
    ax : Axes, optional
        Where to draw; a new figure when left out.
    component : str
        "hoop", "axial", "shear" or "von_mises".
    stress_limit : float, optional
        End of the colour scale, Pa; chosen from this instant when left out.
    colour_bar : bool
        Add the colour bar to the right.

    Returns
    -------
    Axes

    Raises
    ------
    InputError
        There is one station alone, the shell or the component is unknown, or the time is outside the run.
    """
    require_stations(response)
    number = response.system.shell_index(shell)
    index = int(instants(response, [time])[0])
    z, stress = along_stations(response, number, ANGLES, index, component)
    if z.size < 2:
        raise InputError("stations", "there is one alone", "run with a grid of them, such as stations=np.linspace(0, 3, 61)")
    limit = stress_limit or round_up(float(np.quantile(abs(stress), _SHARE)))
    image: Any = mappable(limit, STRESS_COLOURS)
    with style():
        if ax is None:
            ax = new_figure(4.8, 3.6).add_subplot()
        ax.pcolormesh(ANGLES, z, stress, cmap=image.cmap, norm=image.norm, shading="gouraud", rasterized=True)
        ax.set_xticks(np.arange(-180, 181, 90))
        ax.set_xlabel("angle from the source direction (degrees)")
        ax.set_ylabel("$z/a$")
        ax.grid(visible=False)
        moment = np.asarray(response.time)[[index]], 1e3 * np.asarray(response.time_seconds)[[index]]
        stamp = time_stamp(Frames(*moment, np.zeros((1, 1, 1), np.float32), ()), 0)
        ax.set_title(f"{shell_phrase(number, len(response.system.shells))}, {stamp}")
        if colour_bar:
            unit = stress_unit(limit)
            told = unit.label.replace("hoop", "von Mises" if component == "von_mises" else component)
            add_colour_bar(ax.inset_axes((1.04, 0.0, 0.04, 1.0)), limit, DrawnUnit(told, unit.per_pascal), STRESS_COLOURS)
    return ax


def require_stations(response: Response) -> None:
    """Raise InputError for a run in two dimensions."""
    if response.stations is None:
        raise InputError("response", "is of a run in two dimensions", "run with dimensions=3 and a grid of stations")


def along_stations(
    response: SpatialResponse, shell: int, angles: Sequence[float] | FloatArray, index: int, component: str = "hoop"
) -> tuple[FloatArray, FloatArray]:
    """Return axial positions in a, ascending, and the stress there at an instant, (positions, angles), mirrored where sources are alike.

    The shear stress changes its sign with z, the others do not.
    """
    found = response.stress(shell, angles, component=component).isel(time=index)
    z, stress = response.stations / response.system.reference_radius, np.asarray(found, dtype=np.float64)
    if alike_on_both_sides(response.system):
        z, stress = np.concatenate([z, -z]), np.concatenate([stress, -stress if component == "shear" else stress])
    z, first = np.unique(z + 0.0, return_index=True)
    return z, stress[first]


def alike_on_both_sides(system: System) -> bool:
    """Return whether nothing tells z from -z."""
    beside = any(getattr(source, name, 0.0) for source in system.sources for name in ("z", "inclination"))
    return not beside and not system.point_absorbers
