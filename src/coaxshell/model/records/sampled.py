"""A sampled pressure history: the record as it was read, what is made of it, and the curve that is solved."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import BeforeValidator, model_validator

from coaxshell.errors import InputError
from coaxshell.model.base import UNSTATED, Described, stated
from coaxshell.model.samples import Samples, Series, not_increasing
from coaxshell.model.units import AnyPressure, AnyTime, Delay, Time, quantity, to_si

if TYPE_CHECKING:
    import numpy.typing as npt

    from coaxshell.model.records.measures import Measures
    from coaxshell.numerics.arrays import ComplexArray, FloatArray


def _window(value: Any) -> Any:
    """Return a window of time in s, greater than 0, or "pre-trigger"."""
    if value is None or value == "pre-trigger":
        return value
    window = to_si(value, "time")
    if window <= 0:
        raise InputError("", f"{window!r} s is not allowed", 'must be greater than 0, or "pre-trigger"')
    return window


class Sampled(Described):
    """Describe a sampled history: linear between the samples, zero before the first and after the last.

    A measured record is kept as it was read; the options say what is made of it, in this order: *scale*, *offset* and *baseline* on the
    pressures, the part from *start* to *end*, *shift* of the times, *resample*, *taper*. Samples before t = 0 (before a trigger) are
    then left out. :attr:`curve` is the history that results, and all that is solved.
    """

    type: Literal["sampled"] = "sampled"
    time: Annotated[Samples, Series("time")]
    """Times (s), strictly increasing, at least two."""
    pressure: Annotated[Samples, Series("pressure")]
    """Pressures at these times (Pa)."""
    scale: Annotated[float, quantity("number", nonzero=True)] = 1.0
    """Factor on the pressures, such as a calibration."""
    offset: AnyPressure = 0.0
    """Pressure of the baseline, subtracted after scaling (Pa)."""
    baseline: Annotated[float | Literal["pre-trigger"] | None, BeforeValidator(_window)] = None
    """Time from the first sample over which the mean is taken and subtracted (s), or "pre-trigger": all samples before t = 0."""
    start: AnyTime | None = None
    """Time of the record from which it is kept (s); it becomes t = 0 unless *shift* says otherwise."""
    end: AnyTime | None = None
    """Time of the record up to which it is kept (s)."""
    shift: AnyTime | None = None
    """Time added to those of the record (s)."""
    resample: Time | None = None
    """Interval of a new, even grid of samples (s)."""
    taper: Delay = 0.0
    """Length of the last part of the history, which is brought to zero by half a cosine (s)."""
    reference: str = ""
    """Where the samples come from."""

    def __init__(
        self,
        *,
        time: Sequence[float] | npt.ArrayLike = UNSTATED,
        pressure: Sequence[float] | npt.ArrayLike = UNSTATED,
        **options: Any,
    ) -> None:
        super().__init__(**stated({"time": time, "pressure": pressure}), **options)

    @model_validator(mode="after")
    def _regular(self) -> Self:
        if len(self.time) < 2:
            raise InputError("time", f"{len(self.time)} samples are too few", "must be at least 2")
        if len(self.time) != len(self.pressure):
            raise InputError(
                "pressure", f"{len(self.pressure)} pressures do not match {len(self.time)} times", "must be as many pressures as times"
            )
        late = not_increasing(self.time)
        if late is not None:
            raise InputError(
                f"time[{late}]", f"{self.time[late]!r} s does not follow {self.time[late - 1]!r} s", "times must be strictly increasing"
            )
        _ = self.curve  # what an option makes impossible is told now
        return self

    @cached_property
    def curve(self) -> tuple[FloatArray, FloatArray]:
        """The history that the record stands for: times (s), from 0 on, and pressures (Pa), read-only arrays."""
        from coaxshell.model.records.conditioning import conditioned

        times, values = conditioned(
            self.time,
            self.pressure,
            scale=self.scale,
            offset=self.offset,
            baseline=self.baseline,
            start=self.start,
            end=self.end,
            shift=self.shift,
            resample=self.resample,
            taper=self.taper,
        )
        times.flags.writeable = values.flags.writeable = False
        return times, values

    @cached_property
    def digest(self) -> str:
        """SHA-256 of the history, its times and then its pressures as little-endian doubles."""
        from coaxshell.model.records.binary_text import digest

        return digest(*self.curve)

    @cached_property
    def transforms(self) -> deque[tuple[FloatArray, ComplexArray]]:
        """The latest transforms of the history, each with the numbers of its contour: a place for the solver to keep them."""
        return deque(maxlen=2)

    @property
    def peak(self) -> float:
        """Largest magnitude of the pressure (Pa)."""
        return float(abs(self.curve[1]).max())

    @cached_property
    def spectrum(self) -> tuple[FloatArray, FloatArray]:
        """Frequencies (Hz) and the energy density ``|P(f)|^2`` (Pa^2 s^2) of the history."""
        from coaxshell.model.records.measures import spectrum

        return spectrum(*self.curve)

    @property
    def measures(self) -> Measures:
        """Peak, rise, decay, impulse, duration, sampling and band of the history."""
        from coaxshell.model.records.measures import measures

        return measures(len(self.time), *self.curve, *self.spectrum)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What a reader of the record should know: where it is cut off, absurd magnitudes, a baseline that is left."""
        import numpy as np

        from coaxshell.model.records.remarks import remarks

        recorded = self.scale * np.asarray(self.pressure) - self.offset
        return remarks(*self.curve, np.asarray(self.time), recorded, start=self.start, shift=self.shift, baseline=self.baseline is not None)

    def __eq__(self, other: object) -> bool:
        return type(other) is type(self) and self._fields == other._fields

    def __hash__(self) -> int:
        return hash(self._fields)

    @property
    def _fields(self) -> tuple[Any, ...]:
        """What the record is: its fields, without what is computed from them; where it comes from makes it no other."""
        return tuple(getattr(self, name) for name in type(self).model_fields if name != "reference")

    def __getstate__(self) -> dict[Any, Any]:
        """Travel between processes without what is computed from the fields."""
        state = super().__getstate__()
        return {**state, "__dict__": {k: v for k, v in state["__dict__"].items() if k in type(self).model_fields}}

    def __repr_args__(self) -> Iterable[tuple[str | None, Any]]:
        return [(name, value) for name, value in super().__repr_args__() if name is None or value != self.default_of(name)]

    @classmethod
    def default_of(cls, name: str) -> Any:
        """Return the default of a field."""
        return cls.model_fields[name].default

    @classmethod
    def from_file(cls, path: str | Path, **options: Any) -> Sampled:
        """Read a record from a CSV or other text file, a MATLAB file (up to version 7) or a sound file.

        Parameters
        ----------
        path : str or Path
        **options
            ``time_column``, ``pressure_column`` (heading, or number from 1 on), ``time_unit``, ``pressure_unit`` (instead of those in the
            headings), ``interval`` (s, without a column of times), ``sha256`` of the file, and the other entries of this class.

        Raises
        ------
        InputError
            Naming the file and the line, the column or the option.
        """
        from coaxshell.model.records.reader import of_file

        return cls(**of_file(path, options))

    @classmethod
    def from_bytes(cls, content: bytes, name: str = "record", **options: Any) -> Sampled:
        """Read a record from the bytes of a file, which errors and :attr:`reference` call *name*; options as those of :meth:`from_file`."""
        from coaxshell.model.records.reader import of_bytes

        return cls(**of_bytes(content, name, options))

    @classmethod
    def from_csv(cls, path: str | Path, **options: Any) -> Sampled:
        """Read a record from a text file; the same as :meth:`from_file`."""
        return cls.from_file(path, **options)

    @classmethod
    def from_data(cls, data: Any, **options: Any) -> Sampled:
        """Read a record from a pandas Series or DataFrame, an xarray DataArray or Dataset (units in ``attrs``), or an array (n, 2).

        Options as those of :meth:`from_file`; times are the index, or a column called time; InputError says what does not fit.
        """
        from coaxshell.model.records.reader import of_data

        return cls(**of_data(data, options))
