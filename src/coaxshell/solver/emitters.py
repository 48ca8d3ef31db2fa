"""What sends waves: the sources of a system, and their images in the surface and the bottom of the sea, each as a source of its own.

An image of a source at R_0 lies further from the axis, at R_0'. Its wave is that of the source itself, p = (S/R) f(t - (R - S)) where it is
spherical, R from the image and S = R_0 - b as before: for a source at R_0' the pulse (S/S') f, which reaches its own head point
R_0' - R_0 later. That of a line has a wake that knows S too, and keeps it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, NamedTuple

from coaxshell.acoustics.images import Image, Planes
from coaxshell.acoustics.sources import LineGeometry, SourceGeometry, source_geometry
from coaxshell.model.pulses import Pulse, Sampled
from coaxshell.model.sea import exact_cosine
from coaxshell.model.sources import LineWave, PlaneWave, Source, SphericalWave
from coaxshell.model.system import System


class Emitter(NamedTuple):
    """A source, or an image of one as the source that it is like, and its geometry in units of a."""

    source: Source
    geometry: SourceGeometry


def planes_of(system: System) -> Planes | None:
    """Return the reflecting planes of a system in units of a; None where nothing reflects."""
    sea, a = system.sea, system.reference_radius
    if sea is None or not (sea.surface or sea.bottom is not None):
        return None
    return Planes(sea.depth / a if sea.surface else None, None if sea.bottom is None else sea.bottom / a, sea.up)


def emitters(system: System, dimensions: int, duration: float) -> tuple[Emitter, ...]:
    """Return the sources of a system, and after them the images whose waves are in the water within a run.

    Parameters
    ----------
    system : System
    dimensions : int
    duration : float
        Transits.
    """
    found = [Emitter(source, _geometry(system, source, dimensions)) for source in system.sources]
    planes = planes_of(system)
    if planes is None:
        return tuple(found)
    for source, geometry in tuple(found):
        found += _images(system, planes, source, geometry, dimensions, duration - source.delay / system.transit_time)
    return tuple(found)


def _geometry(system: System, source: Source, dimensions: int) -> SourceGeometry:
    distance = system.source_distance(source)
    inclination = getattr(source, "inclination", 0.0) if dimensions == 3 else 0.0
    a = system.reference_radius
    return source_geometry(source.geometry, None if distance is None else distance / a, dimensions, inclination, system.head_radius / a)


def _images(system: System, planes: Planes, source: Source, geometry: SourceGeometry, dimensions: int, lasting: float) -> Iterator[Emitter]:
    """Yield the images of one source that are heard in the water within so many transits after its front reaches the head."""
    up, across = exact_cosine(source.angle - planes.up), exact_cosine(source.angle - planes.up - 90.0)
    if geometry.distance is None:
        yield from _plane_images(system, planes, source, up, dimensions)
        return
    start = geometry.distance - geometry.head
    height, aside = geometry.distance * up, geometry.distance * across
    for image in planes.images(lasting + start + planes.furthest + abs(height)):
        above = image.height(height)
        if planes.beyond(above) - start >= lasting:
            continue
        distance, angle = math.hypot(above, aside), planes.up + math.degrees(math.atan2(aside, above))
        yield _image(system, source, geometry, image, distance, math.remainder(angle, 360.0))


def _image(system: System, source: Source, geometry: SourceGeometry, image: Image, distance: float, angle: float) -> Emitter:
    """Return the image of a source near by."""
    assert geometry.distance is not None
    start, away = geometry.distance - geometry.head, distance - geometry.head
    place: dict[str, Any] = {"angle": angle, "distance": distance * system.reference_radius}
    if isinstance(geometry, LineGeometry):
        like: Source = LineWave(**place, delay=source.delay, pulse=times(source.pulse, image.sign))
        return Emitter(like, replace(geometry, distance=distance, reference=start))
    later = source.delay + (distance - geometry.distance) * system.transit_time
    z = getattr(source, "z", 0.0)
    like = SphericalWave(**place, z=z, delay=later, pulse=times(source.pulse, image.sign * start / away))
    return Emitter(like, replace(geometry, distance=distance))  # type: ignore[type-var]


def _plane_images(system: System, planes: Planes, source: Source, up: float, dimensions: int) -> Iterator[Emitter]:
    """Yield the image of a plane wave, p = f(t - (b - x cos alpha)): from 2 beta + 180 - angle, later by 2 d |cos(angle - beta)| cos alpha.

    One that runs along a rigid bottom satisfies it as it is.
    """
    inclination = getattr(source, "inclination", 0.0) if dimensions == 3 else 0.0
    for image in planes.images(0.0) if abs(up) > 1e-12 else ():
        later = abs(image.shift * up) * math.cos(math.radians(inclination)) * system.transit_time
        angle = math.remainder(2.0 * planes.up + 180.0 - source.angle, 360.0)
        pulse = times(source.pulse, image.sign)
        like = PlaneWave(angle=angle, delay=source.delay + later, inclination=getattr(source, "inclination", 0.0), pulse=pulse)
        yield Emitter(like, _geometry(system, like, dimensions))


_LEVELS = ("peak_pressure", "pressure")


def times(pulse: Pulse, factor: float) -> Pulse:
    """Return a pulse of so many times the pressure."""
    if isinstance(pulse, Sampled):
        return pulse.replace(scale=factor * pulse.scale, offset=factor * pulse.offset)
    return pulse.replace(**{name: factor * getattr(pulse, name) for name in _LEVELS if name in type(pulse).model_fields})
