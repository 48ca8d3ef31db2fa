"""Where the shock comes from: its geometry, its direction, and its pressure history.

In every geometry the pulse is the free-field pressure at the head point, the point of the outermost shell nearest to
the source, and its clock starts when the front gets there (plus *delay*). Distances are measured from the shells' axis.

In three dimensions the head point lies at the axial position of a spherical source, and at z = 0 for the others: waves of lines, which
are parallel to the axis, and plane waves, whose front may be inclined.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import lru_cache
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, Self, get_args

from pydantic import BeforeValidator, Field, model_validator

from coaxshell.errors import InputError
from coaxshell.model.base import Described, shown
from coaxshell.model.bubble import largest_radius, similitude_period, whole_pulse
from coaxshell.model.explosives import EXPLOSIVES, Explosive
from coaxshell.model.naming import lookup
from coaxshell.model.pulses import AnyPulse, Exponential, Sampled
from coaxshell.model.units import Angle, Delay, Inclination, Length, Mass, Position, Pressure, Time, whole

Geometry = Literal["spherical", "plane", "line"]
OFF_THE_PLANE = ("z", "inclination")
"""What takes a source out of the cross-section's plane: 0 in two dimensions, and left out of descriptions where it is 0."""


class _Directed(Described):
    """Hold what all sources share: direction and delay."""

    angle: Angle = 0.0
    """Direction of the source seen from the axis (degrees)."""
    delay: Delay = 0.0
    """Time by which its front reaches the head point later than t = 0 (s)."""


class _Placed(Described):
    """Hold what point sources have beyond other ones."""

    z: Position = 0.0
    """Axial position of the source (m); 0 in two dimensions."""


class _Inclined(Described):
    """Hold what plane waves have beyond other ones."""

    inclination: Inclination = 0.0
    """Angle by which the direction of travel leaves the cross-section's plane towards +z (degrees); 0 in two dimensions."""


class _Shock(_Directed):
    peak_pressure: Pressure
    """Free-field pressure of the front at the head point (Pa)."""
    decay_time: Time
    """Time to fall by a factor e (s)."""

    @property
    def pulse(self) -> Exponential:
        """The exponential history at the head point."""
        return Exponential(peak_pressure=self.peak_pressure, decay_time=self.decay_time)


class SphericalShock(_Placed, _Shock):
    """Describe the paper's source (Eq. 2): a spherical front with an exponential tail and its afterflow."""

    geometry: ClassVar[Geometry] = "spherical"
    type: Literal["spherical-shock"] = "spherical-shock"
    distance: Length
    """Distance of the source from the axis (m)."""


class PlaneShock(_Inclined, _Shock):
    """Describe a plane front with an exponential tail: a spherical shock from infinitely far away."""

    geometry: ClassVar[Geometry] = "plane"
    distance: ClassVar[None] = None
    type: Literal["plane-shock"] = "plane-shock"


class LineShock(_Shock):
    """Describe a true two-dimensional line source, parallel to the axis, with an exponential history at the head point."""

    geometry: ClassVar[Geometry] = "line"
    type: Literal["line-shock"] = "line-shock"
    distance: Length
    """Distance of the line from the axis (m)."""


class SphericalWave(_Placed, _Directed):
    """Describe a spherical wave of any history."""

    geometry: ClassVar[Geometry] = "spherical"
    type: Literal["spherical-wave"] = "spherical-wave"
    distance: Length
    """Distance of the source from the axis (m)."""
    pulse: AnyPulse
    """Free-field pressure at the head point."""


class PlaneWave(_Inclined, _Directed):
    """Describe a plane wave of any history."""

    geometry: ClassVar[Geometry] = "plane"
    distance: ClassVar[None] = None
    type: Literal["plane-wave"] = "plane-wave"
    pulse: AnyPulse
    """Free-field pressure at the head point."""


class LineWave(_Directed):
    """Describe a two-dimensional line source of any history."""

    geometry: ClassVar[Geometry] = "line"
    type: Literal["line-wave"] = "line-wave"
    distance: Length
    """Distance of the line from the axis (m)."""
    pulse: AnyPulse
    """Free-field pressure at the head point."""


def as_explosive(name: Any) -> str:
    """Return the listed name of an explosive; InputError with the names otherwise."""
    return lookup(EXPLOSIVES, str(name), "explosive").name


class Bubble(NamedTuple):
    """The bubble of a charge by similitude: its largest radius (m) and the time to its first pulse (s)."""

    largest_radius: float
    period: float


@lru_cache(maxsize=64)
def _with_bubble(*shock_and_bubble: Any) -> Sampled:
    """Return the history of a shock wave and its bubble, see :func:`coaxshell.model.bubble.whole_pulse`; kept, as its transforms are."""
    time, pressure = whole_pulse(*shock_and_bubble)
    return Sampled(time=time, pressure=pressure, reference="shock wave and bubble by similitude")


class UnderwaterExplosion(_Placed, _Directed):
    """Describe the shock of an underwater charge by similitude: p = K1 (W^(1/3)/S)^A1, theta = K2 W^(1/3) (W^(1/3)/S)^A2.

    W is *charge_mass* (kg) and S *stand_off* (m). With *bubble_pulses* the oscillating bubble follows
    (:mod:`coaxshell.model.bubble`). The distance from the axis needs the outermost radius: ask :func:`source_distance` or
    ``System.source_distances``.
    """

    geometry: ClassVar[Geometry] = "spherical"
    distance: ClassVar[None] = None
    type: Literal["underwater-explosion"] = "underwater-explosion"
    charge_mass: Mass
    """Mass of the charge (kg)."""
    stand_off: Length
    """Distance of the charge from the head point of the outermost shell (m)."""
    explosive: Annotated[str, BeforeValidator(as_explosive)] = "TNT"
    """Name of the explosive."""
    bubble_pulses: Annotated[int, Field(ge=0, le=10), BeforeValidator(whole)] = 0
    """Pulses of the oscillating bubble that follow the shock wave; 0 leaves the bubble out. TNT, HBX-1 and PETN have the constants."""
    charge_depth: Length | None = None
    """Depth of the charge below the surface (m), on which the bubble depends."""

    @model_validator(mode="after")
    def _bubble(self) -> Self:
        if self.bubble_pulses == 0:
            if self.charge_depth is not None:
                raise InputError("charge_depth", "has no effect without a bubble", "give bubble_pulses, or leave it out")
            return self
        if self.charge_depth is None:
            raise InputError("charge_depth", "is missing: a bubble depends on it", "give the depth of the charge below the surface (m)")
        if self.constants.bubble_radius is None:
            known = " or ".join(repr(name) for name, one in EXPLOSIVES.items() if one.bubble_radius is not None)
            raise InputError(
                "bubble_pulses", f"{self.explosive} has no sourced constants of its bubble", f"use {known}, or bubble_pulses = 0"
            )
        largest = largest_radius(self.charge_mass, self.charge_depth, self.constants.bubble_radius)
        if largest >= self.charge_depth:
            problem = f"{self.charge_depth:g} m lets the bubble, of up to {largest:.3g} m radius, break through the surface"
            raise InputError("charge_depth", problem, "lay the charge deeper, or leave the bubble out")
        return self

    @property
    def bubble(self) -> Bubble | None:
        """Largest radius (m) and period (s) of the bubble by similitude; None without one."""
        radius, period = self.constants.bubble_radius, self.constants.bubble_period
        if self.bubble_pulses == 0 or self.charge_depth is None or radius is None or period is None:
            return None
        return Bubble(
            largest_radius(self.charge_mass, self.charge_depth, radius), similitude_period(self.charge_mass, self.charge_depth, period)
        )

    @property
    def constants(self) -> Explosive:
        """The similitude constants of the explosive, with their source."""
        return EXPLOSIVES[self.explosive]

    @property
    def peak_pressure(self) -> float:
        """Peak free-field pressure at the head point (Pa)."""
        return float(self.constants.peak_factor * (self._scale / self.stand_off) ** self.constants.peak_exponent)

    @property
    def decay_time(self) -> float:
        """Decay time at the head point (s)."""
        return float(self.constants.decay_factor * self._scale * (self._scale / self.stand_off) ** self.constants.decay_exponent)

    @property
    def pulse(self) -> Exponential | Sampled:
        """The exponential history at the head point, for about one decay time of the similitude; with bubble pulses a sampled one."""
        factor = self.constants.bubble_radius
        if self.bubble_pulses == 0 or self.charge_depth is None or factor is None:
            return Exponential(peak_pressure=self.peak_pressure, decay_time=self.decay_time)
        shock = self.peak_pressure, self.decay_time, self.stand_off
        return _with_bubble(*shock, self.charge_mass, self.charge_depth, factor, self.bubble_pulses)

    @property
    def hull_shock_factor(self) -> float:
        """Hull shock factor sqrt(W)/S (kg^(1/2)/m): W the mass of the charge as it is, S its distance from the head point.

        Reid, The Response of Surface Ships to Underwater Explosions, DSTO-GD-0109 (1996). Factors in lb^(1/2)/ft are 0.4526 times as
        large; of an explosive other than TNT custom takes the mass of TNT that is its equal, which is not done here.
        """
        return float(math.sqrt(self.charge_mass) / self.stand_off)

    def keel_shock_factor(self, up: float = 90.0) -> float:
        """Return the keel shock factor, sqrt(W)/S (1 + sin beta)/2 (kg^(1/2)/m), beta the angle of the charge below the horizontal.

        As large as the hull shock factor for a charge straight below, half of it for one abeam (Reid, as above).

        Parameters
        ----------
        up : float
            Direction of the surface seen from the axis, degrees as those of the source.
        """
        below = -math.cos(math.radians(self.angle - up))
        return self.hull_shock_factor * (1.0 + below) / 2.0

    @property
    def within_fit(self) -> bool:
        """Whether the peak pressure lies in the range that the constants were fitted to."""
        return self.constants.lowest <= self.peak_pressure <= self.constants.highest

    @property
    def _scale(self) -> float:
        return float(self.charge_mass ** (1 / 3))


Source = SphericalShock | PlaneShock | LineShock | SphericalWave | PlaneWave | LineWave | UnderwaterExplosion
SOURCES: dict[str, type[Source]] = {kind.model_fields["type"].default: kind for kind in get_args(Source)}
"""Kinds of source by the ``type`` that names them in a file."""


def source_distance(source: Source, outer_radius: float) -> float | None:
    """Return the distance of the source from the axis (m), given the outermost radius (m); None for a plane wave."""
    return source.stand_off + outer_radius if isinstance(source, UnderwaterExplosion) else source.distance


def as_source(value: Any) -> Source:
    """Return a source from an instance or a mapping whose ``type`` names it."""
    if isinstance(value, Source):
        return value
    if isinstance(value, Mapping):
        if "type" not in value:
            raise InputError("type", "is missing", "must be one of " + ", ".join(SOURCES))
        kind = lookup(SOURCES, str(value["type"]), "kind of source", "type")
        return kind.model_validate({**value, "type": kind.model_fields["type"].default})
    raise InputError("", f"{shown(value)} is not a source", "give one of " + ", ".join(kind.__name__ for kind in SOURCES.values()))
