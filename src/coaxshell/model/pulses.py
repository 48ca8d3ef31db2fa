"""Pressure histories: the free-field pressure at the head point from the moment the front reaches it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from coaxshell.errors import InputError
from coaxshell.model.base import Described, shown
from coaxshell.model.history import read_history
from coaxshell.model.naming import lookup
from coaxshell.model.units import AnyPressure, Delay, Pressure, Time


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


def _listed(values: Any) -> Any:
    """Turn an array or another iterable into a list, which pydantic can read; leave texts and scalars for it to refuse."""
    return list(values) if hasattr(values, "__iter__") and not isinstance(values, str | bytes | Mapping) else values


class Sampled(Described):
    """Describe a sampled history: linear between the samples, zero before the first and after the last."""

    type: Literal["sampled"] = "sampled"
    time: Annotated[tuple[Delay, ...], BeforeValidator(_listed)]
    """Times (s), from 0 on, strictly increasing, at least two."""
    pressure: Annotated[tuple[AnyPressure, ...], BeforeValidator(_listed)]
    """Pressures at these times (Pa)."""

    @model_validator(mode="after")
    def _regular(self) -> Self:
        if len(self.time) < 2:
            raise InputError("time", f"{len(self.time)} samples are too few", "must be at least 2")
        if len(self.time) != len(self.pressure):
            raise InputError(
                "pressure", f"{len(self.pressure)} pressures do not match {len(self.time)} times", "must be as many pressures as times"
            )
        for i in range(1, len(self.time)):
            if self.time[i] <= self.time[i - 1]:
                raise InputError(
                    f"time[{i}]", f"{self.time[i]!r} s does not follow {self.time[i - 1]!r} s", "times must be strictly increasing"
                )
        return self

    @property
    def peak(self) -> float:
        """Largest magnitude of the pressure (Pa)."""
        return max(abs(pressure) for pressure in self.pressure)

    @classmethod
    def from_csv(cls, path: str | Path) -> Self:
        """Read two columns, time (s) and pressure (Pa), with or without a header line; InputError names the file and line."""
        time, pressure = read_history(Path(path))
        return cls(time=tuple(time), pressure=tuple(pressure))


Pulse = Exponential | Step | Gaussian | Sampled
PULSES: dict[str, type[Exponential] | type[Step] | type[Gaussian] | type[Sampled]] = {
    "exponential": Exponential,
    "step": Step,
    "gaussian": Gaussian,
    "sampled": Sampled,
}


def as_pulse(value: Any) -> Pulse:
    """Return a pulse from an instance or a mapping whose ``type`` names it; ``file`` names a CSV of a sampled one."""
    if isinstance(value, Exponential | Step | Gaussian | Sampled):
        return value
    if isinstance(value, Mapping):
        data = dict(value)
        if "type" not in data:
            raise InputError("type", "is missing", "must be one of " + ", ".join(PULSES))
        kind = lookup(PULSES, str(data["type"]), "kind of pulse", "type")
        if kind is Sampled and "file" in data:
            return Sampled.from_csv(str(data["file"]))
        return kind.model_validate({**data, "type": kind.model_fields["type"].default})
    raise InputError("", f"{shown(value)} is not a pulse", "give an Exponential, a Step, a Gaussian or a Sampled")


AnyPulse = Annotated[Exponential | Step | Gaussian | Sampled, BeforeValidator(as_pulse)]
