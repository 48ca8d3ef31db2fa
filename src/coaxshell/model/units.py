"""Numbers with units: every quantity is a float in SI, and is also accepted as text such as ``"6 mm"``.

pint takes half a second to import: it is asked only about units that are not in a table of the usual ones, so that describing a system
stays fast. A test holds each factor of the table against it.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Decimal
from functools import lru_cache
from numbers import Integral, Real
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import core_schema

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.quantity_text import hint, parts, respelt
from coaxshell.numerics.scalars import plain

USUAL: dict[str, dict[str, float]] = {
    "m": {"m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "km": 1000.0, "in": 0.0254, "ft": 0.3048},
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6},
    "kg": {"kg": 1.0, "g": 1e-3, "t": 1000.0},
    "kg/m": {"kg/m": 1.0},
    "kg/m^3": {"kg/m^3": 1.0, "kg/m3": 1.0, "g/cm^3": 1000.0, "g/cm3": 1000.0},
    "Hz": {"Hz": 1.0, "kHz": 1000.0, "MHz": 1e6},
    "m/s": {"m/s": 1.0, "km/s": 1000.0},
    "m/s^2": {"m/s^2": 1.0, "m/s2": 1.0},
    "Pa": {"Pa": 1.0, "kPa": 1000.0, "MPa": 1e6, "GPa": 1e9, "bar": 1e5},
    "C/m^2": {"C/m^2": 1.0, "C/m2": 1.0},
    "F/m": {"F/m": 1.0, "nF/m": 1e-9},
    "A/m^2": {"A/m^2": 1.0, "A/m2": 1.0, "mA/cm^2": 10.0},
    "V/m": {"V/m": 1.0, "V/mm": 1000.0, "kV/mm": 1e6},
    "deg": {"deg": 1.0, "°": 1.0},
    "N*s/m^2": {"N*s/m^2": 1.0},
    "N*s/m": {"N*s/m": 1.0},
    "N/m^2": {"N/m^2": 1.0},
    "N/m": {"N/m": 1.0},
    "N/m^4": {"N/m^4": 1.0},
    "N/m^3": {"N/m^3": 1.0},
    "N": {"N": 1.0, "kN": 1000.0, "MN": 1e6},
}
"""Unit in SI: factors of units as they are typed."""


@dataclass(frozen=True)
class Dimension:
    """A kind of quantity: its article and name, SI unit, an example of a text, and units of other kinds also accepted."""

    name: str
    unit: str
    example: str
    also: tuple[str, ...] = ()


DIMENSIONS: dict[str, Dimension] = {
    "length": Dimension("a length", "m", "6 mm"),
    "time": Dimension("a time", "s", "0.13 ms"),
    "mass": Dimension("a mass", "kg", "250 g"),
    "density": Dimension("a density", "kg/m^3", "7.8 g/cm^3"),
    "frequency": Dimension("a frequency", "Hz", "1 kHz"),
    "speed": Dimension("a speed", "m/s", "1.4 km/s"),
    "acceleration": Dimension("an acceleration", "m/s^2", "9.81 m/s^2"),
    "pressure": Dimension("a pressure", "Pa", "25 kPa"),
    "stress": Dimension("a stress or modulus", "Pa", "70 GPa"),
    "charge density": Dimension("a charge per area", "C/m^2", "14.1 C/m^2"),
    "permittivity": Dimension("a permittivity", "F/m", "5.841 nF/m"),
    "current density": Dimension("a current per area", "A/m^2", "20 A/m^2"),
    "electric field": Dimension("an electric field", "V/m", "590 V/mm"),
    "angle": Dimension("an angle", "deg", "45 deg"),
    # The problem is plane: a kilogram of absorber is a kilogram per metre of length, and the paper writes the former.
    "line mass": Dimension("a mass per metre of length", "kg/m", "10 kg/m", ("kg",)),
    "line damping": Dimension("a damping per metre of length", "N*s/m^2", "1e6 N*s/m^2", ("N*s/m",)),
    "line stiffness": Dimension("a stiffness per metre of length", "N/m^2", "1 GN/m^2", ("N/m",)),
    "line cubic stiffness": Dimension("a cubic stiffness per metre of length", "N/m^4", "1e20 N/m^4", ("N/m^3",)),
    "damping": Dimension("a damping", "N*s/m", "1e5 N*s/m"),
    "stiffness": Dimension("a stiffness", "N/m", "1 MN/m"),
    "cubic stiffness": Dimension("a cubic stiffness", "N/m^3", "1e18 N/m^3"),
    # Laws of links serve absorbers at points and, per metre of length, those that are lines.
    "link force": Dimension("a force", "N", "10 kN", ("N/m",)),
    "link damping": Dimension("a damping", "N*s/m", "1e5 N*s/m", ("N*s/m^2",)),
    "link stiffness": Dimension("a stiffness", "N/m", "1 MN/m", ("N/m^2",)),
    "link cubic stiffness": Dimension("a cubic stiffness", "N/m^3", "1e18 N/m^3", ("N/m^4",)),
    "number": Dimension("a plain number", "", "0.3"),
}


@dataclass(frozen=True, repr=False)
class Quantity:
    """A field of one dimension with limits: the marker in ``Annotated[float, quantity(...)]``."""

    dimension: Dimension
    above: float | None = None
    least: float | None = None
    below: float | None = None
    most: float | None = None
    nonzero: bool = False

    def __repr__(self) -> str:
        return f"{self.dimension.name} in {self.dimension.unit}" if self.dimension.unit else self.dimension.name

    def validate(self, value: object) -> float:
        """Return *value* as a finite float in SI within the limits; InputError otherwise."""
        number = to_si(value, self.dimension)
        allowed = [
            (self.above is None or number > self.above, f"greater than {self.above:g}" if self.above is not None else ""),
            (self.least is None or number >= self.least, f"at least {self.least:g}" if self.least is not None else ""),
            (self.below is None or number < self.below, f"less than {self.below:g}" if self.below is not None else ""),
            (self.most is None or number <= self.most, f"at most {self.most:g}" if self.most is not None else ""),
            (not self.nonzero or number != 0, "different from 0" if self.nonzero else ""),
        ]
        if not all(ok for ok, _ in allowed):
            raise InputError(
                "", f"{_with_unit(number, self.dimension)} is not allowed", "must be " + " and ".join(text for _, text in allowed if text)
            )
        return number

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        inner = core_schema.float_schema(allow_inf_nan=False, gt=self.above, ge=self.least, lt=self.below, le=self.most)
        return core_schema.no_info_before_validator_function(self.validate, inner)

    def __get_pydantic_json_schema__(self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        # Forms are generated from this schema: they need the unit and an example beside the limits.
        return {**handler(schema), "unit": self.dimension.unit, "examples": [self.dimension.example]}


def quantity(
    dimension: str,
    *,
    above: float | None = None,
    least: float | None = None,
    below: float | None = None,
    most: float | None = None,
    nonzero: bool = False,
) -> Quantity:
    """Mark a float field as a quantity of one of :data:`DIMENSIONS` with the given limits (SI)."""
    return Quantity(DIMENSIONS[dimension], above, least, below, most, nonzero)


def to_si(value: object, dimension: Dimension | str) -> float:
    """Convert a number (already SI) or a text such as ``"6 mm"`` to a finite SI float; InputError says what was expected."""
    kind = DIMENSIONS[dimension] if isinstance(dimension, str) else dimension
    value = plain(value)
    if isinstance(value, bool):  # Python counts it among the numbers; a user does not
        raise InputError("", f"{shown(value)} is not {kind.name}", _remedy(kind))
    if isinstance(value, str):
        number = _from_text(value, kind)
    elif isinstance(value, Real):
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
    else:
        raise InputError("", f"{shown(value)} is not {kind.name}", _remedy(kind))
    if not math.isfinite(number):
        raise InputError("", f"{shown(value)} is not finite", _remedy(kind))
    return number


def whole(value: object) -> object:
    """Pass whole numbers of any type on as int and refuse booleans, which Python counts as numbers."""
    value = plain(value)
    if isinstance(value, bool):
        raise InputError("", f"{value!r} is not a count", "give a whole number")
    return int(value) if isinstance(value, Integral) else value


def _from_text(text: str, kind: Dimension) -> float:
    found = parts(text, kind.name)
    if found is None:
        if text.strip().lower().lstrip("+-") in ("nan", "inf", "infinity"):
            return math.nan
        raise InputError("", f"{shown(text)} is not {kind.name}", _remedy(kind))
    number, unit = found
    factor = _factor(unit, (kind.unit, *kind.also)) if unit else 1.0
    if factor is None:
        raise _unknown(text, unit, kind)
    plain = float(number)
    if not unit or plain == 0 or math.isinf(plain):
        return plain
    # In decimal, so that "9.3 mm" is exactly the float 0.0093; the range of float still rules.
    return float(Decimal(number) * Decimal(repr(factor)))


def _unknown(text: str, unit: str, kind: Dimension) -> InputError:
    known = _parsed(unit) is not None
    problem = f"{shown(text)} is not {kind.name}" if known else f"{shown(text)} has an unknown unit {shown(unit)}"
    return InputError("", problem, hint(unit, known) + _remedy(kind))


def knows_all() -> bool:
    """Return whether no unit is left that takes long to read, as the first unusual one does."""
    return _registry.cache_info().currsize > 0


@lru_cache(maxsize=1)
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(cache_folder=None)


def _tidied(unit: str) -> str:
    plain = unit.replace("·", "*").replace("°", "degree").replace("^", "**")
    return re.sub(r"(?<=[A-Za-z])(-?\d)", r"**\1", plain)  # "m2" and "m-2" are powers; pint wants them spelt out


_LONGEST_UNIT = 64
# pint computes the numbers in a unit exactly: "9**9**9**9" would take it for ever. Units need no powers of numbers, nor large exponents.
_ENDLESS = re.compile(r"[\d⁰¹²³⁴-⁹]{3,}|[\d⁰¹²³⁴-⁹]\s*\)*\s*(\*\*|\^)")

# The parser of units passes over what it does not know, quotation marks and control characters among it, and takes "mm0" for 1.
_STRANGE = re.compile(r"[^\w \t*/^().+\-·⋅×°%⁺⁻]|[A-Za-zµ)][-^*\s]*0")


def _parsed(unit: str) -> Any | None:
    if len(unit) > _LONGEST_UNIT or _ENDLESS.search(unit) or _STRANGE.search(unit):
        return None
    try:
        return _registry().parse_units(_tidied(unit), as_delta=True)
    except Exception:  # noqa: BLE001 - pint raises many kinds, down to the tokenizer's own; all mean "not a unit"
        return None


@lru_cache(maxsize=512)
def _factor(unit: str, targets: tuple[str, ...]) -> float | None:
    """Return the factor from a unit to the first of some others of its kind; None if there is none."""
    usual = next((USUAL[target][unit] for target in targets if unit in USUAL.get(target, ())), None)
    return usual or next((factor for target in targets if (factor := by_pint(unit, target)) is not None), None)


def by_pint(unit: str, target: str) -> float | None:
    """Return the factor from one unit to another; None if they are of different kinds or the first is unknown."""
    for spelling in dict.fromkeys((unit, respelt(unit))):
        try:
            factor = _factor_of(_parsed(spelling), target)
        except (ArithmeticError, ValueError):  # powers beyond the range of float
            factor = None
        if factor is not None:
            return factor
    return None


def _factor_of(found: Any | None, target: str) -> float | None:
    wanted = _registry().parse_units(target) if target else _registry().dimensionless
    # Radians are dimensionless to pint: without this "3 deg" would pass as a plain number, and "3 m/m" as an angle.
    if found is None or not found.is_compatible_with(wanted) or (target == "deg") != _is_angle(found):
        return None
    one, two = (_registry().Quantity(size, found).to(wanted).magnitude for size in (1.0, 2.0))
    if not two == 2 * one > 0:  # decibels and degrees of temperature are no multiples of anything
        return None
    factor = float(one)
    rounded = float(f"{factor:.12g}")  # pint makes g/cm^3 999.9999999999999 kg/m^3
    return rounded if abs(rounded - factor) <= 1e-15 * abs(factor) else factor


def _is_angle(unit: Any) -> bool:
    return bool(unit.dimensionless) and any(name in str(unit) for name in ("degree", "radian", "turn", "arc", "grad"))


def _with_unit(number: float, kind: Dimension) -> str:
    return f"{number!r} {kind.unit}".strip()


def _remedy(kind: Dimension) -> str:
    unit = f" in {kind.unit}" if kind.unit else ""
    example = f" or as text such as {kind.example!r}" if kind.unit else f" such as {kind.example}"
    return f"give {kind.name} as a finite number{unit}{example}"


Count = Annotated[int, Field(ge=0), BeforeValidator(whole)]
Number = Annotated[float, quantity("number")]
Length = Annotated[float, quantity("length", above=0)]
Position = Annotated[float, quantity("length")]
Time = Annotated[float, quantity("time", above=0)]
Delay = Annotated[float, quantity("time", least=0)]
AnyTime = Annotated[float, quantity("time")]
Mass = Annotated[float, quantity("mass", above=0)]
Density = Annotated[float, quantity("density", above=0)]
Frequency = Annotated[float, quantity("frequency", above=0)]
Speed = Annotated[float, quantity("speed", above=0)]
Pressure = Annotated[float, quantity("pressure", nonzero=True)]
AnyPressure = Annotated[float, quantity("pressure")]
Modulus = Annotated[float, quantity("stress", above=0)]
Angle = Annotated[float, quantity("angle", least=-360, most=360)]
Inclination = Annotated[float, quantity("angle", above=-90, below=90)]
