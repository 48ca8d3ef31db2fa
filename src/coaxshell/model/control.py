"""Piezoelectric proportional-derivative control: the paper's (Eq. 17), or by electrodes as they can be made."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal, Self, get_args

from pydantic import BeforeValidator, GetCoreSchemaHandler, GetJsonSchemaHandler, model_validator
from pydantic_core import core_schema

from coaxshell.errors import InputError
from coaxshell.model.base import Described
from coaxshell.model.segments import Count, Dead, DeadBelts, DeadElectrodes, Gap, Length, require_segments
from coaxshell.model.units import DIMENSIONS, Quantity, quantity
from coaxshell.numerics.scalars import plain

End = Literal["inner", "middle", "outer"]
Transducers = Literal["paper", "electrodes"]
ALLOWED = "must be 'all' or a list of shells: numbers from 0 inside, 'inner', 'outer', 'middle' (of three)"


def _current(value: Any) -> Any:
    """Return a current per area; a current alone, in A, lacks its area."""
    if isinstance(value, str) and value.strip().endswith("A"):
        told = f"{value!r} is a current without the area that it serves"
        raise InputError("", told, 'divide it by the area of wall that one amplifier drives, as in "20 A/m^2"')
    return value


CurrentLimit = Annotated[float, quantity("current density", above=0), BeforeValidator(_current)]


def require_current(law: Any) -> None:
    """Raise InputError if what a law says of currents does not go together."""
    said = next((name for name in ("current_limit", "current_saturation") if getattr(law, name)), None)
    if said is None:
        return
    if law.transducers != "electrodes":
        raise InputError(said, "is said of currents, which the paper's law has not", 'use transducers = "electrodes", or leave it out')
    if not law.current_saturation:
        return
    if law.current_limit is None:
        raise InputError(said, "stops at a current_limit, and none is given", 'give one, such as current_limit = "20 A/m^2"')
    if law.segments is None:
        told = "is that of an amplifier, which a point of a whole electrode has not"
        raise InputError("current_saturation", told, "give the number of segments, or leave it out and read control_effort")
    if law.saturation:
        raise InputError("current_saturation", "voltage and current are not known to stop together", "leave one of the two out")
    if law.dead:
        raise InputError("dead", "segments at ground take what current they like", "leave dead or current_saturation out")


def _shells(value: Any) -> Any:
    """Return "all" or a tuple: a single index or name becomes a tuple of one; digits in text become a number."""
    if isinstance(value, str):
        if value == "all":
            return value
        value = [part.strip() for part in value.split(",")]
    elif isinstance(plain(value), int) and not isinstance(plain(value), bool):
        value = [value]
    if not isinstance(value, list | tuple | range):
        raise InputError("", f"{value!r} is not allowed", ALLOWED)
    return tuple(_shell(item) for item in value)


def _shell(item: Any) -> int | str:
    number = int(item) if isinstance(item, str) and len(item) < 9 and item.isdecimal() else plain(item)
    if number in get_args(End) or (isinstance(number, int) and not isinstance(number, bool) and number >= 0):
        return number
    raise InputError("", f"{item!r} is not allowed", ALLOWED)


@dataclass(frozen=True, repr=False)
class _OneOrEach(Quantity):
    """A number for all shells, or a list of one for each."""

    def _each(self, value: Any) -> float | tuple[float, ...]:
        if not isinstance(value, list | tuple):
            return self.validate(value)
        if not value:
            raise InputError("", "the list is empty", "give a number, or a list of one for each shell under control")
        found = []
        for place, one in enumerate(value):
            try:
                found.append(self.validate(one))
            except InputError as error:
                raise InputError(f"[{place}]", error.problem, error.remedy) from None
        return tuple(found)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> core_schema.CoreSchema:
        return core_schema.no_info_plain_validator_function(self._each)

    def __get_pydantic_json_schema__(self, schema: core_schema.CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"type": "number", "unit": self.dimension.unit, "examples": [self.dimension.example]}  # forms ask for one


Gain = Annotated[float | tuple[float, ...], _OneOrEach(DIMENSIONS["number"])]


class PDControl(Described):
    """Describe the control law u = k_p phi_s + k_d dphi_s/dt, phi_s the sensor's potential and u the actuator's (V).

    Time in the derivative is dimensionless, in transits a/c_e, as in the paper: both gains are plain numbers.
    With the paper's transducers negative gains stiffen and damp, with electrodes positive ones.
    """

    proportional: Gain
    """Proportional gain k_p (V/V), or a list of one for each shell under control, in the order of "shells"."""
    derivative: Gain
    """Derivative gain k_d (V/V, per unit of dimensionless time), or such a list."""
    transducers: Transducers = "paper"
    """What reads and drives: "paper" reads curvature and drives by a pressure alone, "electrodes" strain, by traction and moment too."""
    shells: Annotated[tuple[int | End, ...] | Literal["all"], BeforeValidator(_shells)] = "all"
    """Which shells: "all", or numbers from 0 inside, "inner", "outer", "middle"; ``System.controlled_shells`` gives the numbers."""
    saturation: bool = False
    """Whether the actuator's voltage stops at the field limit."""
    field_limit: Annotated[float, quantity("electric field", above=0)] | None = None
    """Largest field on the actuator (V/m); the material's own unless given."""
    current_limit: CurrentLimit | None = None
    """Largest current of an amplifier over the area of wall that it drives (A/m^2), above which a warning is given."""
    current_saturation: bool = False
    """Whether the current stops at the current limit; the voltage then is what that current leaves."""
    segments: Count | None = None
    """Electrodes around each wall, all layers cut at the same places, each with its own loop; one that varies freely unless given."""
    segment_gap: Gap | None = None
    """Between neighbouring segments along the mid-surface, a strip held at ground (m)."""
    segment_pitch: Length | None = None
    """In three dimensions from electrode to electrode along the axis, middle to middle, one at z = 0 (m); not cut along it unless given."""
    segment_length: Length | None = None
    """Of each electrode along the axis (m), what is left of the pitch held at ground; the whole pitch unless given."""
    dead: Dead | None = None
    """Segments held at ground, which neither sense nor push: 0 has its middle at theta = 0, the others follow counterclockwise."""
    dead_belts: DeadBelts | None = None
    """Single belts held at ground whole: 0 has its middle at z = 0, n at n times segment_pitch."""
    dead_electrodes: DeadElectrodes | None = None
    """Single segments of single belts held at ground, pairs of a belt and a segment such as [0, 3]."""

    @model_validator(mode="after")
    def _once_each(self) -> Self:
        if self.shells != "all" and (not self.shells or len(set(self.shells)) < len(self.shells)):
            raise InputError("shells", f"{list(self.shells)!r} is not allowed", "must name at least one shell, and each only once")
        require_segments(self)
        require_current(self)
        return self
