"""The sea around a system: how deep it lies, which way the surface is, whether there is a bottom, and what stands there at rest."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, TypeVar

from coaxshell.errors import InputError
from coaxshell.model.base import Described
from coaxshell.model.units import Angle, Length

if TYPE_CHECKING:
    from coaxshell.numerics.arrays import FloatArray

Heights = TypeVar("Heights", float, "FloatArray")

ATMOSPHERE = 101_325.0
"""Pressure of the standard atmosphere, Pa (ISO 2533)."""
GRAVITY = 9.80665
"""Standard acceleration of gravity, m/s^2 (ISO 80000-3)."""
VAPOUR_PRESSURE = 2339.0
"""Pressure of water vapour over water at 20 degrees Celsius, Pa (IAPWS-95); at 4 degrees 814 Pa."""


class Sea(Described):
    """Describe the sea: waves are reflected by its surface with opposite sign, and by a rigid bottom with the same sign.

    Surface and bottom are planes along the axis. At rest the water stands under the atmosphere and its own weight; that this presses
    on the shells beforehand is not part of the model, which tells the motion that the shock adds.
    """

    depth: Length
    """Depth of the axis below the surface (m)."""
    up: Angle = 90.0
    """Direction from the axis to the surface (degrees, from theta = 0, where a source lies unless it has an angle)."""
    bottom: Length | None = None
    """Distance of a rigid bottom below the axis (m); none unless given."""
    surface: bool = True
    """Whether the surface reflects; without, the depth counts for the pressure at rest alone."""
    hydrostatic: bool = True
    """Whether the weight of the water adds to the pressure at rest; without, it is that of the atmosphere everywhere."""

    def at_rest(self, height: Heights, density: float) -> Heights:
        """Return the pressure of the water at rest, Pa: p_atm + rho g (depth - height).

        Parameters
        ----------
        height : float or ndarray
            Above the axis, in the direction *up*, m.
        density : float
            Of the water, kg/m^3.
        """
        weight = density * GRAVITY if self.hydrostatic else 0.0
        return ATMOSPHERE + weight * (self.depth - height)

    def height_of(self, distance: float | None, angle: float) -> float:
        """Return the height of a point above the axis, m: distance cos(angle - up).

        Parameters
        ----------
        distance : float or None
            From the axis, m. None: infinitely far away, which is +-infinity but for a direction along the surface, where it is 0.
        angle : float
            Degrees.
        """
        cosine = exact_cosine(angle - self.up)
        if distance is None:
            return math.copysign(math.inf, cosine) if abs(cosine) > 1e-12 else 0.0
        return distance * cosine


def exact_cosine(angle: float) -> float:
    """Return the cosine of an angle in degrees, exact at multiples of 90: what is symmetric stays so."""
    turn = angle % 360.0
    return {0.0: 1.0, 90.0: 0.0, 180.0: -1.0, 270.0: 0.0}.get(turn, math.cos(math.radians(turn)))


def require_possible(sea: Sea, radius: float, sources: list[tuple[str, float | None, float, bool]]) -> None:
    """Refuse what cannot be: shells or sources above the surface, or below the bottom.

    Parameters
    ----------
    sea : Sea
    radius : float
        Outermost radius of the shells, m.
    sources : list of (path, distance, angle, plane)
        Distance from the axis in m, None for plane waves, with their direction in degrees.

    Raises
    ------
    InputError
        With both numbers.
    """
    if sea.depth <= radius:
        problem = f"{sea.depth:g} m lets the shells, of outer radius {radius:g} m, rise above the surface"
        raise InputError("sea.depth", problem, f"must be greater than {radius:g} m")
    if sea.bottom is not None and sea.bottom <= radius:
        problem = f"{sea.bottom:g} m lets the shells, of outer radius {radius:g} m, reach into the bottom"
        raise InputError("sea.bottom", problem, f"must be greater than {radius:g} m")
    for where, distance, angle, plane in sources:
        height = sea.height_of(distance, angle)
        if plane:
            _require_wave_in_water(sea, where, height, angle)
            continue
        if height >= sea.depth:
            problem = f"{height:g} m above the axis it lies above the surface, which is {sea.depth:g} m above it"
            raise InputError(where, problem, "lay the axis deeper, or the source further down (angle, distance, sea.up)")
        if sea.bottom is not None and height <= -sea.bottom:
            problem = f"{-height:g} m below the axis it lies below the bottom, which is {sea.bottom:g} m below it"
            raise InputError(where, problem, "raise the source (angle, distance, sea.up), or leave the bottom out")


def _require_wave_in_water(sea: Sea, where: str, height: float, angle: float) -> None:
    """Refuse plane waves from above a reflecting surface or below a bottom, and along the surface, which would cancel them."""
    remedy = "give it an angle from below, sea.up + 90 to sea.up + 270 degrees, or a distance (spherical-shock, line-shock)"
    if sea.surface and height == 0.0:
        problem = f"a plane wave at {angle:g} degrees runs along the surface, whose reflection cancels it everywhere"
        raise InputError(f"{where}.angle", problem, remedy)
    if sea.surface and height > 0.0:
        raise InputError(f"{where}.angle", f"a plane wave at {angle:g} degrees comes from above the surface", remedy)
    if sea.bottom is not None and height < 0.0:
        problem = f"a plane wave at {angle:g} degrees comes from below the bottom"
        raise InputError(f"{where}.angle", problem, "give it an angle from above, leave the bottom out, or give the source a distance")
