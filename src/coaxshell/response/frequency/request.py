"""What is asked for at given frequencies: its quantities, and checks of the arguments that belong to them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal, TypedDict

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.fluids import Vacuum
from coaxshell.model.loading import SystemLike
from coaxshell.model.places import region_name, region_number
from coaxshell.model.system import System
from coaxshell.model.units import to_si
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.scalars import plain
from coaxshell.response import arguments
from coaxshell.response.labels import COUNTERCLOCKWISE, INWARD, TENSION
from coaxshell.solver.steady import LineForce

Kind = Literal["shell", "field", "absorbers", "target", "through", "point"]
"""What a quantity is read of: a shell at angles, a fluid at points, the absorbers, the echo, the way in, a shell under a force."""
Per = Literal["incident", "absolute"]
LONGEST = 500.0
"""Highest frequency allowed, omega a/c_e."""


@dataclass(frozen=True)
class SteadyQuantity:
    """One quantity that a system has at a frequency.

    Attributes
    ----------
    name, unit, long_name : str
        The unit is that of the quantity itself, without what it is per.
    kind : str
    component : str
        Of a motion, "normal" or "tangential".
    rate : int
        Time derivative of the motion, 0, 1 or 2.
    sign : str
        Which direction counts positive.
    """

    name: str
    unit: str
    long_name: str
    kind: Kind
    component: str = "normal"
    rate: int = 0
    sign: str = ""


def _motions() -> list[SteadyQuantity]:
    found = []
    for rate, (stem, unit) in enumerate((("displacement", "m"), ("shell_velocity", "m/s"), ("shell_acceleration", "m/s^2"))):
        noun = stem.removeprefix("shell_")
        found.append(SteadyQuantity(stem, unit, f"normal {noun}", "shell", "normal", rate, INWARD))
        found.append(SteadyQuantity(f"tangential_{stem}", unit, f"tangential {noun}", "shell", "tangential", rate, COUNTERCLOCKWISE))
    for rate, (name, unit) in enumerate((("receptance", "m^2/N"), ("mobility", "m^2/(N s)"), ("accelerance", "m^2/(N s^2)"))):
        long_name = f"{name}, normal {('displacement', 'velocity', 'acceleration')[rate]} per line force"
        found.append(SteadyQuantity(name, unit, long_name, "point", "normal", rate, INWARD))
    return found


_TABLE = [
    *_motions(),
    SteadyQuantity("stress", "Pa", "stress", "shell", sign=TENSION),
    SteadyQuantity("sensor_voltage", "V", "open-circuit voltage of the sensor", "shell", sign="of phi_s in Eq. 20"),
    SteadyQuantity("actuator_voltage", "V", "control voltage on the actuator", "shell", sign="of u in Eq. 17"),
    SteadyQuantity("pressure", "Pa", "pressure", "field"),
    SteadyQuantity("absorber_displacement", "m", "displacement of the absorbers' masses", "absorbers", sign=INWARD),
    SteadyQuantity("absorber_force", "N/m", "force of the absorbers on their shells", "absorbers", sign=INWARD),
    SteadyQuantity("form_function", "1", "form function", "target"),
    SteadyQuantity("target_strength", "dB", "target strength", "target"),
    SteadyQuantity("scattering_width", "m", "scattering width", "target"),
    SteadyQuantity("extinction_width", "m", "extinction width", "target"),
    SteadyQuantity("absorption_width", "m", "absorption width", "target"),
    SteadyQuantity("transmission_loss", "dB", "transmission loss", "through"),
    SteadyQuantity("insertion_loss", "dB", "insertion loss", "through"),
]
STEADY = {quantity.name: quantity for quantity in _TABLE}
"""All quantities at a frequency, by name."""
WIDTHS = ("scattering_width", "extinction_width", "absorption_width")


class SteadyOptions(TypedDict, total=False):
    """Options of a frequency response by name; see :func:`coaxshell.frequency_response`."""

    shell: int | str
    angle: npt.ArrayLike
    depth: float | str
    component: str
    radius: npt.ArrayLike
    part: str
    region: int | str
    z: float
    force: tuple[int | str, float]
    source: int
    per: Per
    length: float | str
    against: SystemLike


_BELONGS: dict[str, tuple[Kind, ...]] = {
    "shell": ("shell", "point"),
    "angle": ("shell", "field", "target", "point"),
    "depth": ("shell",),
    "component": ("shell",),
    "radius": ("field",),
    "part": ("field",),
    "region": ("through",),
    "z": ("shell", "field"),
    "force": ("shell", "field", "absorbers", "point"),
    "source": ("shell", "field", "absorbers", "target", "through"),
    "per": ("shell", "field", "absorbers"),
    "length": ("target",),
    "against": ("through",),
}


@dataclass(frozen=True)
class Asked:
    """A quantity with its checked arguments.

    Attributes
    ----------
    quantity : SteadyQuantity
    shell : int
    theta : ndarray, shape () or (A,)
        Degrees.
    radii : ndarray, shape () or (r,)
        In a.
    part, component : str
    depth : object
    region : int or None
        Over which a mean is taken; None for the axis.
    z : float
        Position along the axis, m.
    force : LineForce or None
    source : int or None
        The one that is meant; None for all together, with their own spectra.
    per : str
    length : float or None
        m.
    """

    quantity: SteadyQuantity
    shell: int
    theta: FloatArray
    radii: FloatArray
    part: str
    component: str
    depth: object
    region: int | None
    z: float
    force: LineForce | None
    source: int | None
    per: str
    length: float | None


def asked(system: System, quantity: str, options: SteadyOptions) -> Asked:
    """Return what is asked for; InputError if a name is unknown or an argument does not belong to the quantity."""
    what = STEADY[arguments.one_of("quantity", quantity, STEADY)]
    for name in options:
        if name not in _BELONGS:
            raise InputError(name, "is no argument of a frequency response", f"allowed: {', '.join(_BELONGS)}")
        if what.kind not in _BELONGS[name] or (name in ("depth", "component") and what.name not in ("stress", *_with_depth(name))):
            raise InputError(name, f"has no effect on {quantity}", "leave it out")
    shell = system.shell_index(options.get("shell", "outer"))
    source = _source(system, options, what)
    theta = _angles(system, options, what, source)
    force = _force(system, options, what, shell, theta)
    radii = _radii(options.get("radius", 0.0)) if what.kind == "field" else np.zeros(0)
    per = "incident" if force is not None else arguments.one_of("per", options.get("per", "incident"), ("incident", "absolute"))
    part = arguments.one_of("part", options.get("part", "total"), ("total", "incident", "scattered"))
    if force is not None and part == "incident":
        raise InputError("part", "a force sends no incident wave", 'use part="total"')
    if what.name == "insertion_loss" and "against" not in options:
        raise InputError("against", "is missing", "give the system without the coating, or whatever else is compared")
    if what.name != "insertion_loss" and "against" in options:
        raise InputError("against", f"has no effect on {quantity}", "use insertion_loss")
    region = _region(system, options.get("region")) if what.kind == "through" else None
    length, z = _length(options, what), _position(options.get("z", 0.0))
    component = options.get("component", "hoop" if what.name == "stress" else what.component)
    return Asked(what, shell, theta, radii, part, component, options.get("depth"), region, z, force, source, per, length)


def _with_depth(name: str) -> tuple[str, ...]:
    return ("displacement", "shell_velocity", "shell_acceleration") if name == "component" else ("displacement", "tangential_displacement")


def _source(system: System, options: SteadyOptions, what: SteadyQuantity) -> int | None:
    """Return the number of the source that is meant; None where all act together."""
    count = len(system.sources)
    if "source" in options:
        number = plain(options["source"])
        if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < count:
            raise InputError("source", f"{shown(options['source'])} is not allowed", f"give a number from 0 to {count - 1}")
        return number
    if count == 1:
        return 0
    if options.get("per") == "absolute" or "force" in options or what.kind == "point":
        return None
    raise InputError(
        "source", f"there are {count}, and an answer per incident pressure belongs to one", 'give its number, or per="absolute"'
    )


def _angles(system: System, options: SteadyOptions, what: SteadyQuantity, source: int | None) -> FloatArray:
    """Return the angles; those of an echo go back to the source unless given."""
    if "angle" in options:
        return arguments.angles(options["angle"])
    if what.kind == "target":
        return np.asarray(system.sources[source or 0].angle, dtype=np.float64)
    return np.asarray(0.0 if what.kind == "point" else [0.0, 180.0])


def _force(system: System, options: SteadyOptions, what: SteadyQuantity, shell: int, theta: FloatArray) -> LineForce | None:
    """Return the line force that drives the system; a receptance has it where it is read unless told."""
    if "force" not in options:
        if what.kind != "point":
            return None
        if theta.ndim:
            raise InputError("force", "is missing, and several angles are read", 'give where it acts, force=("outer", 0)')
        return LineForce(shell, float(theta))
    remedy = 'give a shell and an angle in degrees, as ("outer", 0)'
    value: Any = options["force"]
    if isinstance(value, str) or not isinstance(value, tuple | list) or len(value) != 2:
        raise InputError("force", f"{shown(value)} is not allowed", remedy)
    angle = arguments.angles(value[1])
    if angle.ndim:
        raise InputError("force", f"{shown(value)} is not allowed", remedy)
    number = system.shell_index(value[0])
    if not hasattr(system.shells[number], "layers"):
        raise InputError("force", f"shells[{number}] is rigid and does not move", "choose an elastic shell")
    return LineForce(number, float(angle))


def _radii(radius: npt.ArrayLike) -> FloatArray:
    """Return radii in a; InputError if one is negative."""
    remedy = "give one number or a list of them from 0, in outermost radii a"
    try:
        values = np.asarray(radius, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("radius", f"{shown(radius)} is not a number or a list of numbers", remedy) from None
    if values.ndim > 1 or values.size == 0 or not np.all(np.isfinite(values) & (values >= 0.0)):
        raise InputError("radius", f"{shown(radius)} is not allowed", remedy)
    return values


def _region(system: System, region: object) -> int | None:
    """Return the fluid within the shells over which a mean is taken; None for the axis, which must lie in a fluid."""
    count = len(system.shells)
    if region is None:
        if isinstance(system.fluids[0], Vacuum):
            raise InputError("region", "there is a vacuum on the axis", 'name a fluid within the shells, such as "gap"')
        return None
    remedy = f"name one of {', '.join(region_name(i, count) for i in range(count))}"
    number = region_number(region, count) if isinstance(region, str) else plain(region)
    if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < count:
        raise InputError("region", f"{shown(region)} is no fluid within the shells", remedy)
    if isinstance(system.fluids[number], Vacuum):
        raise InputError("region", f"there is a vacuum in the {region_name(number, count)}", remedy)
    return number


def _position(value: object) -> float:
    """Return a position along the axis, m."""
    try:
        return to_si(plain(value), "length")
    except InputError as error:
        raise InputError("z", error.problem, 'give a position along the axis in m, or a text such as "3 m"') from None


def _length(options: SteadyOptions, what: SteadyQuantity) -> float | None:
    """Return the length of a finite cylinder, m."""
    if "length" not in options:
        return None
    if what.name != "target_strength":
        raise InputError("length", f"has no effect on {what.name}", "leave it out")
    try:
        length = to_si(plain(options["length"]), "length")
    except InputError as error:
        raise InputError("length", error.problem, 'give a length in m, or a text such as "3 m"') from None
    if not 0.0 < length < math.inf:
        raise InputError("length", f"{length:g} m is not allowed", "give more than 0")
    return length


def frequencies(frequency: object, transit: float) -> FloatArray:
    """Return frequencies, Hz, shape () or (F,); InputError if one is none or too high for a system (*transit* s)."""
    most = LONGEST / (2.0 * math.pi * transit)
    remedy = f'give a frequency above 0 and up to {most:.4g} Hz, a text such as "2 kHz", or a list of them'
    several = not isinstance(frequency, str) and np.ndim(frequency) > 0  # type: ignore[arg-type]
    each: Any = frequency if several else [frequency]
    if several and np.ndim(each) > 1:
        raise InputError("frequency", f"an array of shape {np.shape(each)} is not allowed", remedy)
    if several and not isinstance(each, list | tuple):
        each = np.asarray(each).tolist()
    found = []
    for one in each:
        try:
            found.append(to_si(plain(one), "frequency"))
        except InputError as error:
            raise InputError("frequency", error.problem, remedy) from None
    values = np.array(found)
    if values.size == 0:
        raise InputError("frequency", "is empty", remedy)
    allowed = (values > 0.0) & (values <= most)
    if not np.all(allowed):
        raise InputError("frequency", f"{values[~allowed][0]:g} Hz is not allowed", remedy)
    return values if several else values[0]
