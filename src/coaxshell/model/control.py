"""Piezoelectric proportional-derivative control (paper's Eq. 17)."""

from __future__ import annotations

from typing import Annotated, Any, Literal, Self, get_args

from pydantic import BeforeValidator, model_validator

from coaxshell.errors import InputError
from coaxshell.model.base import Described
from coaxshell.model.units import Number, quantity
from coaxshell.numerics.scalars import plain

End = Literal["inner", "middle", "outer"]
ALLOWED = "must be 'all' or a list of shells: numbers from 0 inside, 'inner', 'outer', 'middle' (of three)"


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


class PDControl(Described):
    """Describe the control law u = k_p phi_s + k_d dphi_s/dt, phi_s the sensor's potential and u the actuator's (V).

    Time in the derivative is dimensionless, in transits a/c_e, as in the paper: both gains are plain numbers.
    Negative gains stiffen and damp.
    """

    proportional: Number
    """Proportional gain k_p (V/V)."""
    derivative: Number
    """Derivative gain k_d (V/V, per unit of dimensionless time)."""
    shells: Annotated[tuple[int | End, ...] | Literal["all"], BeforeValidator(_shells)] = "all"
    """Which shells: "all", or numbers from 0 inside, "inner", "outer", "middle"; ``System.controlled_shells`` gives the numbers."""
    saturation: bool = False
    """Whether the actuator's voltage stops at the field limit."""
    field_limit: Annotated[float, quantity("electric field", above=0)] | None = None
    """Largest field on the actuator (V/m); the material's own unless given."""

    @model_validator(mode="after")
    def _once_each(self) -> Self:
        if self.shells != "all" and (not self.shells or len(set(self.shells)) < len(self.shells)):
            raise InputError("shells", f"{list(self.shells)!r} is not allowed", "must name at least one shell, and each only once")
        return self
