"""The sea in pictures of fields: its surface and bottom, and where the water cavitates."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from coaxshell.model.sea import VAPOUR_PRESSURE
from coaxshell.plotting.frames import FieldView

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from coaxshell.model import System

SURFACE_COLOUR, BOTTOM_COLOUR = "#2F7FC1", "#6B5B3E"
CAVITATION_COLOUR = "#C2189A"
"""Of the line around water below the pressure of vapour: apart from both ends of the pressure's colours."""
_THINNEST = 2
"""Pixels on either side that what cavitates covers at least: thinner lines run along fronts, whose rise is that of the band."""


def draw_planes(ax: Axes, system: System, view: FieldView, zoom: float = 1.0) -> None:
    """Draw air above the surface, white under its line, and a hatched bottom, as far as they are seen."""
    from matplotlib.patches import Polygon

    sea, a = system.sea, system.reference_radius
    if sea is None:
        return
    turn, far = np.radians(sea.up), 3.0 * view.half_width
    up, along = np.array([np.cos(turn), np.sin(turn)]), np.array([-np.sin(turn), np.cos(turn)])
    planes = [(sea.depth / a, 1.0, SURFACE_COLOUR, "white", "")] if sea.surface else []
    planes += [(-sea.bottom / a, -1.0, BOTTOM_COLOUR, "#E8E2D6", "///")] if sea.bottom is not None else []
    for height, side, line, ground, hatch in planes:
        if abs(height) > 1.5 * view.half_width:
            continue
        edge = [height * up - far * along, height * up + far * along]
        beyond = [edge[1] + side * far * up, edge[0] + side * far * up]
        ax.add_patch(Polygon([*edge, *beyond], facecolor=ground, edgecolor=line, linewidth=1.2 * zoom, hatch=hatch, zorder=1.5))


def cavitating(system: System, pressure: npt.NDArray[np.floating], view: FieldView) -> npt.NDArray[np.floating] | None:
    """Return the absolute pressure less that of vapour on the pixels of a square, Pa, NaN but in the water outside; None without a sea.

    Parameters
    ----------
    system : System
    pressure : ndarray, shape (pixels, pixels)
        Acoustic, Pa, rows from the lowest y upward.
    view : FieldView
    """
    sea, a = system.sea, system.reference_radius
    if sea is None:
        return None
    x, y = np.meshgrid(view.centres, view.centres)
    turn = np.radians(sea.up)
    height = a * (np.cos(turn) * x + np.sin(turn) * y)
    left = sea.at_rest(height, system.exterior.density) + pressure - VAPOUR_PRESSURE
    outside = a * np.hypot(x, y) >= system.head_radius
    water = outside & (height < sea.depth) & (height > (-np.inf if sea.bottom is None else -sea.bottom))
    torn = water & (left < 0.0)
    thin = torn & ~ndimage.binary_opening(torn, np.ones((3, 3), dtype=bool), iterations=_THINNEST)
    return np.where(water, np.where(thin, -left, left), np.nan)


def draw_cavitation(ax: Axes, system: System, pressure: npt.NDArray[np.floating], view: FieldView) -> None:
    """Draw a line around the water that cavitates."""
    left = cavitating(system, pressure, view)
    if left is not None and np.nanmin(left) < 0.0:
        ax.contour(view.centres, view.centres, left, levels=[0.0], colors=[CAVITATION_COLOUR], linewidths=0.9, zorder=2.5)


def rim(left: npt.NDArray[np.floating]) -> npt.NDArray[np.bool_]:
    """Return the pixels at the edge of the water that cavitates."""
    torn = left < 0.0
    inside = torn.copy()
    inside[1:-1, 1:-1] &= torn[:-2, 1:-1] & torn[2:, 1:-1] & torn[1:-1, :-2] & torn[1:-1, 2:]
    edge: npt.NDArray[np.bool_] = torn & ~inside
    return edge
