"""Sources: each a file with its load on the outermost surface, its field where nothing stands in its way, and its load in time."""

from __future__ import annotations

from coaxshell.acoustics.sources.line import LineGeometry
from coaxshell.acoustics.sources.plane import PlaneGeometry
from coaxshell.acoustics.sources.source import (
    FreeField,
    SourceGeometry,
    SpatialField,
    SpatialGeometry,
    SteadyGeometry,
    SurfaceLoad,
    TimeFunction,
)
from coaxshell.acoustics.sources.spherical import SphericalGeometry
from coaxshell.acoustics.sources.spherical_front import SphericalFrontGeometry

__all__ = [
    "FreeField",
    "LineGeometry",
    "PlaneGeometry",
    "SourceGeometry",
    "SpatialField",
    "SpatialGeometry",
    "SphericalFrontGeometry",
    "SphericalGeometry",
    "SteadyGeometry",
    "SurfaceLoad",
    "TimeFunction",
    "source_geometry",
]


def source_geometry(kind: str, distance: float | None, dimensions: int = 2, inclination: float = 0.0, head: float = 1.0) -> SourceGeometry:
    """Return the geometry of a kind of source, "plane", "line" or "spherical", at a distance from the axis in units of a.

    A source of any kind at no distance is a plane wave from infinitely far away. A spherical one is a slice through its wave in two
    dimensions, the wave itself in three. A plane one may be inclined there, in degrees. ``head`` is the radius of the surface that the
    exterior fluid wets, on which the head point lies.
    """
    if distance is None:
        return PlaneGeometry(inclination, head)
    if kind == "line":
        return LineGeometry(distance, head)
    return SphericalGeometry(distance, head) if dimensions == 2 else SphericalFrontGeometry(distance, head)
