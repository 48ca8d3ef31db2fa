"""A measured history: its samples, what was measured where, how noisy it is, and what its clock shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from pydantic import BeforeValidator, model_validator

from coaxshell.errors import InputError
from coaxshell.limits import RECORD_BYTES
from coaxshell.model.base import UNSTATED, Described, shown, stated
from coaxshell.model.naming import suggestion
from coaxshell.model.samples import Samples, Series, not_increasing
from coaxshell.model.units import AnyTime, Length, Time, quantity, to_si

if TYPE_CHECKING:
    import numpy.typing as npt

    from coaxshell.model.records.choosing import Wanted
    from coaxshell.numerics.arrays import FloatArray
    from coaxshell.response import Response
    from coaxshell.studies.fitting.places import Place

Measured = Literal["strain", "stress", "acceleration", "velocity", "displacement", "sensor_voltage", "pressure"]
_UNITS: Mapping[str, tuple[str, str, Mapping[str, float]]] = {
    "strain": ("1", "number", {"strain": 1.0, "microstrain": 1e-6, "ustrain": 1e-6, "ue": 1e-6, "um/m": 1e-6, "ppm": 1e-6}),
    "stress": ("Pa", "stress", {}),
    "acceleration": ("m/s^2", "acceleration", {"g": 9.80665, "gn": 9.80665}),
    "velocity": ("m/s", "speed", {}),
    "displacement": ("m", "length", {}),
    "sensor_voltage": ("V", "number", {"V": 1.0, "mV": 1e-3, "kV": 1e3}),
    "pressure": ("Pa", "pressure", {}),
}
"""Of each quantity its unit in SI, the kind of units that are known of it, and further ones."""
_COLUMNS = ("time_column", "value_column", "time_unit", "value_unit", "interval")
FREE = "free"


def _clock(value: Any) -> Any:
    """Return a time in s, or the name of a clock."""
    if isinstance(value, str):
        try:
            return to_si(value, "time")
        except InputError:
            if not value.strip():
                raise InputError("", "'' is no clock", 'give "free", a name that records share, or a time') from None
            return value.strip()
    return to_si(value, "time")


def _depth(value: Any) -> Any:
    return value if value in (None, "inner", "outer") else to_si(value, "length")


class Measurement(Described):
    """Describe a measured history, in SI: linear between nothing; what is compared are its samples.

    Read one with :meth:`from_file`, or give *time* and *values*.
    """

    _called: ClassVar[str] = "a measurement"

    time: Annotated[Samples, Series("time")]
    """Times of the record's own clock (s), strictly increasing."""
    values: Annotated[Samples, Series("number")]
    """Values at these times, in SI."""
    quantity: Measured
    """What was measured: strain, stress (both around the shell), acceleration, velocity, displacement, sensor_voltage or pressure."""
    shell: int | str = "outer"
    """Shell on which it was measured."""
    angle: Annotated[float, quantity("angle")] = 0.0
    """Angle from the source direction (degrees)."""
    component: Literal["normal", "tangential"] = "normal"
    """Of a motion: normal (positive inwards) or tangential."""
    depth: Annotated[float | Literal["inner", "outer"] | None, BeforeValidator(_depth)] = None
    """Of strain and stress: outward of the middle of the wall (m), or a face; the middle of the wall unless given."""
    radius: Length | None = None
    """Of a pressure: distance from the axis (m)."""
    station: Annotated[float, quantity("length")] | None = None
    """Axial position (m), in three dimensions."""
    noise: Annotated[float, quantity("number", above=0)] | None = None
    """Standard deviation of its noise, in the unit of the values in SI; found from what the fit leaves unless given."""
    clock: Annotated[float | str, BeforeValidator(_clock)] = FREE
    """What its clock shows as the run begins: a time (s) if known; "free" if not; or a name that records of one recorder share."""
    clock_guess: AnyTime = 0.0
    """Where the search for a clock that is not known begins (s)."""
    clock_range: Time | None = None
    """How far on either side of the guess it is searched (s); a quarter of the record unless given."""
    start: AnyTime | None = None
    """Time of the record from which it is used (s)."""
    end: AnyTime | None = None
    """Time of the record up to which it is used (s)."""
    name: str = ""
    """What tables and errors call it."""

    def __init__(
        self, *, time: Sequence[float] | npt.ArrayLike = UNSTATED, values: Sequence[float] | npt.ArrayLike = UNSTATED, **entries: Any
    ) -> None:
        super().__init__(**stated({"time": time, "values": values}), **entries)

    @model_validator(mode="after")
    def _regular(self) -> Self:
        if len(self.time) != len(self.values):
            raise InputError("values", f"{len(self.values)} values do not match {len(self.time)} times", "must be as many")
        late = not_increasing(self.time)
        if late is not None:
            raise InputError(f"time[{late}]", f"{self.time[late]!r} s does not follow {self.time[late - 1]!r} s", "must increase")
        if (self.quantity == "pressure") != (self.radius is not None):
            problem = "is missing" if self.radius is None else f"belongs to a pressure, not to {self.quantity}"
            raise InputError("radius", problem, "give the distance from the axis of a pressure gauge, and of nothing else")
        if self.depth is not None and self.quantity not in ("strain", "stress"):
            raise InputError("depth", f"belongs to strain and stress, not to {self.quantity}", "leave it out")
        if self.component != "normal" and self.quantity not in ("acceleration", "velocity", "displacement"):
            raise InputError("component", f"{self.component!r} belongs to a motion, not to {self.quantity}", "leave it out")
        if len(self.used) < 3:
            raise InputError("time", f"{len(self.used)} samples from start to end are too few", "must be at least 3")
        return self

    @property
    def unit(self) -> str:
        """Unit of the values in SI."""
        return _UNITS[self.quantity][0]

    @property
    def used(self) -> range:
        """Numbers of the samples from start to end."""
        import numpy as np

        times = np.asarray(self.time)
        first = 0 if self.start is None else int(np.searchsorted(times, self.start, side="left"))
        last = times.size if self.end is None else int(np.searchsorted(times, self.end, side="right"))
        return range(first, last)

    @property
    def gauge(self) -> Place:
        """What is read from a run."""
        from coaxshell.studies.fitting.places import Place

        return Place(self.quantity, self.shell, self.angle, self.component, self.depth, self.radius, self.station)

    @property
    def place(self) -> str:
        """Where it was measured, in words."""
        where = f"r = {self.radius:g} m" if self.radius is not None else f"{self.shell} shell"
        face = "" if self.depth is None else f", {self.depth} face" if isinstance(self.depth, str) else f", depth {self.depth:g} m"
        along = "" if self.station is None else f", z = {self.station:g} m"
        return f"{where}, {self.angle:g} deg{face}{along}"

    def expected(self, response: Response, clock: float = 0.0) -> FloatArray:
        """Return what it would show in a run, SI, at its own times, if its clock shows *clock* (s) as the run begins; 0 before that."""
        import numpy as np

        from coaxshell.studies.fitting.places import predicted, shown_at

        found = predicted(response, self.gauge)
        return shown_at(self.quantity, response.time_seconds, found, np.asarray(self.time) - clock).values

    @classmethod
    def from_file(cls, path: str | Path, **entries: Any) -> Measurement:
        """Read a measurement from a CSV or other text file, a MATLAB file (up to version 7) or a sound file.

        Parameters
        ----------
        path : str or Path
        **entries
            ``time_column``, ``value_column`` (heading, or number from 1 on), ``time_unit``, ``value_unit`` (instead of those in the
            headings; "microstrain" and "g" are known), ``interval`` (s, without a column of times), ``scale`` (factor on the values,
            such as a calibration), and the entries of this class.

        Raises
        ------
        InputError
            Naming the file and the line, the column or the entry.
        """
        from coaxshell.model.records.choosing import choose
        from coaxshell.model.records.reader import table_of
        from coaxshell.numerics.reading import regular_bytes

        name = str(path)
        table = table_of(regular_bytes(Path(path), RECORD_BYTES, "give the path of a record: CSV, .mat or .wav"), name)
        columns = {key: entries.pop(key) for key in _COLUMNS if key in entries}
        known = [*cls.model_fields, *_COLUMNS, "scale"]
        for key in entries:
            if key not in known or key in ("time", "values"):
                raise InputError(key, "is not an entry beside the file of a measurement", suggestion(key, known))
        scale = to_si(entries.pop("scale", 1.0), "number")
        if table.full_scale and scale == 1.0:
            problem = f"is missing: {name} holds shares of a full scale"
            raise InputError("scale", problem, "give the value at full scale, in SI")
        chosen = choose(table, columns, name, wanted(entries.get("quantity")))
        return cls(time=chosen.time, values=scale * chosen.values, **{"name": Path(path).stem, **entries})


def wanted(quantity: Any) -> Wanted:
    """Return what the column of a measured quantity holds; InputError if there is no such quantity."""
    from coaxshell.model.records.choosing import Wanted
    from coaxshell.model.records.columns import factor_of

    if quantity not in _UNITS:
        raise InputError(
            "quantity", f"{shown(quantity)} is not allowed" if quantity is not None else "is missing", f"one of {', '.join(_UNITS)}"
        )
    unit, kind, more = _UNITS[quantity]

    def factor(text: str) -> float | None:
        plain = text.strip().replace("µ", "u").replace("μ", "u").replace("ε", "e")
        return more[plain] if plain in more else None if kind == "number" else factor_of(text, kind)

    examples = {"strain": "microstrain", "acceleration": "g or m/s^2", "sensor_voltage": "mV", "stress": "MPa", "pressure": "kPa or psi"}
    words = quantity.replace("_", " ")
    return Wanted("value", (words, quantity, words.split(maxsplit=1)[0]), unit, factor, examples.get(quantity, unit))
