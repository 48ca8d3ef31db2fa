"""The stress of a shell of a three-dimensional run at one instant on the wall laid flat: angle across, axial position up."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model.places import shell_phrase
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.plotting.field import time_stamp
from coaxshell.plotting.field_scales import STRESS_COLOURS, DrawnUnit, add_colour_bar, mappable, stress_unit
from coaxshell.plotting.frames import Frames, instants
from coaxshell.plotting.scales import round_up
from coaxshell.plotting.style import new_figure, style
from coaxshell.response.arguments import one_of
from coaxshell.response.components import STRESSES

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
    require_grid(response)
    number = response.system.shell_index(shell)
    index = int(instants(response, [time])[0])
    z, stress = along_stations(response, number, ANGLES, index, component)
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
            add_colour_bar(ax.inset_axes((1.04, 0.0, 0.04, 1.0)), limit, component_unit(component, limit), STRESS_COLOURS)
    return ax


def require_stations(response: Response) -> None:
    """Raise InputError for a run in two dimensions."""
    if response.stations is None:
        raise InputError("response", "is of a run in two dimensions", "run with dimensions=3 and a grid of stations")


def require_grid(response: SpatialResponse) -> None:
    """Raise InputError for a run of a single station."""
    if mirrored_stations(response)[0].size < 2:
        raise InputError("stations", "there is one alone", "run with a grid of them, such as stations=np.linspace(0, 3, 61)")


def stress_component(name: str) -> str:
    """Return the name of a component of the stress, words joined by - or _; InputError for an unknown one."""
    return one_of("component", name.replace("-", "_"), (*STRESSES, "von_mises"))


def component_unit(component: str, limit: float) -> DrawnUnit:
    """Return the unit of the colour bar of a component of the stress."""
    unit = stress_unit(limit)
    return DrawnUnit(unit.label.replace("hoop", component.replace("von_mises", "von Mises")), unit.per_pascal)


def along_stations(
    response: SpatialResponse, shell: int, angles: Sequence[float] | FloatArray, index: int | None, component: str = "hoop"
) -> tuple[FloatArray, FloatArray]:
    """Return axial positions in a, ascending, and the stress there, mirrored where sources are alike on both sides.

    Shape (positions, angles) at an instant by its number, (instants, positions, angles) for None. The shear stress changes its sign with
    z, the others do not.
    """
    found = response.stress(shell, angles, component=component)
    found = found if index is None else found.isel(time=[index])
    z, sign = mirrored_stations(response)
    stress = np.asarray(found, dtype=np.float64)[:, np.abs(sign) - 1]
    if component == "shear":
        stress = stress * np.sign(sign)[:, None]
    return z, stress if index is None else stress[0]


def mirrored_stations(response: SpatialResponse) -> tuple[FloatArray, npt.NDArray[np.int64]]:
    """Return axial positions in a, ascending, with the number of the station, from 1, that each is; negative where it is its image.

    Stations have images where sources are alike on both sides of z = 0.
    """
    z, number = response.stations / response.system.reference_radius, np.arange(1, response.stations.size + 1)
    if alike_on_both_sides(response.system):
        z, number = np.concatenate([z, -z]), np.concatenate([number, -number])
    z, first = np.unique(z + 0.0, return_index=True)
    return z, number[first]


def alike_on_both_sides(system: System) -> bool:
    """Return whether nothing tells z from -z."""
    beside = any(getattr(source, name, 0.0) for source in system.sources for name in ("z", "inclination"))
    return not beside and not system.point_absorbers
