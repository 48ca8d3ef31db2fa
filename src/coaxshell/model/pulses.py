"""Pressure histories: the free-field pressure at the head point from the moment the front reaches it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self, get_args

from pydantic import BeforeValidator, Field, model_validator

from coaxshell.errors import InputError
from coaxshell.model.base import Described, shown
from coaxshell.model.naming import lookup
from coaxshell.model.records.sampled import Sampled
from coaxshell.model.units import Delay, Pressure, Time

__all__ = ["OF_A_FILE", "PULSES", "AnyPulse", "Exponential", "Gaussian", "Pulse", "Sampled", "Step", "as_pulse"]


class Exponential(Described):
    """Describe a front followed by an exponential decay, p(t) = peak exp(-t/decay) for t >= 0."""

    type: Literal["exponential"] = "exponential"
    peak_pressure: Pressure
    """Pressure at the front (Pa)."""
    decay_time: Time
    """Time to fall by a factor e (s)."""

    @property
    def peak(self) -> float:
        """Largest magnitude of the pressure (Pa)."""
        return abs(self.peak_pressure)


class Step(Described):
    """Describe a pressure that rises linearly over *rise_time* and then stays."""

    type: Literal["step"] = "step"
    pressure: Pressure
    """Pressure reached (Pa)."""
    rise_time: Delay = 0.0
    """Time of the linear rise (s); 0 is a sharp front."""

    @property
    def peak(self) -> float:
        """Largest magnitude of the pressure (Pa)."""
        return abs(self.pressure)


class Gaussian(Described):
    """Describe a smooth pulse, p(t) = peak exp(-((t - centre)/width)^2 / 2) for t >= 0."""

    LEAST_CENTRE: ClassVar[float] = 6.0
    """Widths between t = 0 and the centre; the pulse starts at exp(-18) = 1.5e-8 of its peak, so that it is causal to rounding."""

    type: Literal["gaussian"] = "gaussian"
    peak_pressure: Pressure
    """Largest pressure (Pa)."""
    width: Time
    """Standard deviation in time (s)."""
    centre: Delay = Field(default_factory=lambda data: Gaussian.LEAST_CENTRE * data["width"])
    """Time of the peak (s); 6 widths unless given."""

    @property
    def peak(self) -> float:
        """Largest magnitude of the pressure (Pa)."""
        return abs(self.peak_pressure)

    def __init__(self, **data: Any) -> None:
        if data.get("centre", 0.0) is None:
            del data["centre"]
        super().__init__(**data)

    @model_validator(mode="after")
    def _causal(self) -> Self:
        least = self.LEAST_CENTRE * self.width
        # Rounding in text or in 6*width must not refuse the very value that is the default.
        if self.centre < least * (1 - 1e-12):
            raise InputError(
                "centre", f"{self.centre!r} s is too early for the width {self.width!r} s", f"must be at least 6 widths, {least!r} s"
            )
        return self


Pulse = Exponential | Step | Gaussian | Sampled
PULSES: dict[str, type[Pulse]] = {kind.model_fields["type"].default: kind for kind in get_args(Pulse)}
"""Kinds of pulse by the ``type`` that names them in a file."""

OF_A_FILE = 'a measured one is {type = "sampled", file = "gauge.csv"}'


def as_pulse(value: Any) -> Pulse:
    """Return a pulse from an instance or a mapping whose ``type`` names it; ``file`` names the record of a sampled one."""
    if isinstance(value, Exponential | Step | Gaussian | Sampled):
        return value
    if isinstance(value, Mapping):
        data = dict(value)
        if "type" not in data:
            raise InputError("type", "is missing", f"must be one of {', '.join(PULSES)}; {OF_A_FILE}")
        kind = lookup(PULSES, str(data["type"]), "kind of pulse", "type")
        if kind is Sampled and ("file" in data or "samples" in data):
            return _stored(data)
        return kind.model_validate({**data, "type": kind.model_fields["type"].default})
    raise InputError("", f"{shown(value)} is not a pulse", f"give an Exponential, a Step, a Gaussian or a Sampled; {OF_A_FILE}")


def _stored(data: Mapping[str, Any]) -> Sampled:
    """Return the record of a table that names a file, or holds its samples as one text."""
    options = {key: value for key, value in data.items() if key not in ("type", "file", "samples")}
    if "file" not in data:
        from coaxshell.model.records.storing import from_text

        return from_text(data["samples"], options)
    for key in ("samples", "time", "pressure"):
        if key in data:
            raise InputError(key, "has no effect beside file", "give the samples, or the file that holds them")
    if not isinstance(data["file"], str | Path):
        raise InputError("file", f"{shown(data['file'])} is no file", "give its name")
    return Sampled.from_file(data["file"], **options)


AnyPulse = Annotated[Exponential | Step | Gaussian | Sampled, BeforeValidator(as_pulse)]
