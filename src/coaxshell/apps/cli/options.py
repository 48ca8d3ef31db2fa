"""Options that several commands share, and from their texts to values; every problem is an InputError that names the option."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypedDict

import typer

from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.plotting import FieldView

DURATION, TIME_STEP, MODES, DIMENSIONS = "5", "1e-3", "150", "2"
"""The paper's resolution, as the help shows it."""

SetOption = Annotated[
    list[str] | None,
    typer.Option(
        "--set", "-s", metavar="PATH=VALUE", help='Change an entry of the system, as in source.peak_pressure="50 kPa". May be repeated.'
    ),
]
DurationOption = Annotated[
    str, typer.Option("--duration", metavar="TIME", help='How long, in acoustic transits a/c_e of the outermost radius, or as in "3 ms".')
]
TimeStepOption = Annotated[str, typer.Option("--time-step", metavar="TIME", help='Time step, likewise: transits, or as in "2 us".')]
ModesOption = Annotated[str, typer.Option("--modes", metavar="N|auto", help="Highest circumferential order, or auto to meet --tolerance.")]
ToleranceOption = Annotated[str, typer.Option("--tolerance", metavar="ERROR", help="Relative error that --modes auto aims at.")]
EngineOption = Annotated[str, typer.Option("--engine", metavar="spectral|direct", help="How to solve.")]
RefinementOption = Annotated[
    str, typer.Option("--refinement", metavar="N", help="Solve at time-step/N and keep every N-th instant: for stiff absorbers.")
]
DimensionsOption = Annotated[str, typer.Option("--dimensions", metavar="2|3", help="2, all alike along the axis, or 3.")]
StationsOption = Annotated[
    str,
    typer.Option(
        "--stations", metavar="LENGTH,...", help='Axial positions at which a run in three dimensions answers, in m or as in "0 m,70 cm".'
    ),
]
AxialModesOption = Annotated[
    str | None, typer.Option("--axial-modes", metavar="FACTOR", help="Largest axial wavenumber times a.", show_default="as --modes")
]
AxialPeriodOption = Annotated[
    str | None,
    typer.Option(
        "--axial-period", metavar="LENGTH", help="After which the answer repeats along the axis.", show_default="what causality asks"
    ),
]
FigureOrTableOption = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="FILE", help="Where else to; .csv, or .png, .pdf, .svg for a figure.")
]
ForceOption = Annotated[bool, typer.Option("--force", help="Overwrite what exists already.")]
JsonOption = Annotated[bool, typer.Option("--json", help="Print one JSON document for programs instead of a table.")]
QuietOption = Annotated[bool, typer.Option("--quiet", "-q", help="Show no progress.")]
WorkersOption = Annotated[str | None, typer.Option("--workers", metavar="N", help="Processes; one a core unless given.")]
DaskOption = Annotated[
    str | None,
    typer.Option("--dask", metavar="ADDRESS", help="Work on the Dask cluster whose scheduler is here, as in tcp://10.0.0.1:8786."),
]
DatasetOption = Annotated[
    Path | None, typer.Option("--output", "-o", metavar="FILE", help="Where to, as NetCDF (.nc).", show_default="STUDY.nc in this folder")
]
StoreOption = Annotated[
    Path | None,
    typer.Option(
        "--store",
        metavar="FOLDER",
        help="Keep every finished case here.",
        show_default="STUDY.store in this folder, removed when all is done",
    ),
]
RunWorkersOption = Annotated[
    str | None,
    typer.Option("--workers", metavar="N", help="Processes for a run in three dimensions; threads of this one unless given."),
]
RunStoreOption = Annotated[
    Path | None,
    typer.Option("--store", metavar="FOLDER", help="Keep finished parts of a run in three dimensions here, for --resume."),
]
AllowCodeOption = Annotated[bool, typer.Option("--allow-code", help="Run Python files that the study names outside its folder too.")]
ResumeOption = Annotated[bool, typer.Option("--resume", help="Go on with what has been kept.")]


SourceArgument = Annotated[
    str, typer.Argument(metavar="SOURCE", help="A preset, a .toml file, or a run saved by coaxshell run --output (.nc).")
]
CompareOption = Annotated[
    str | None, typer.Option("--compare", metavar="SOURCE", help="Second system, shown beside the first on the same scales.")
]
WidthOption = Annotated[str, typer.Option("--width", metavar="LENGTH", help="Side of the square that is seen, in outermost radii a.")]
UnitsOption = Annotated[str, typer.Option("--units", metavar="auto|Pa|kPa|MPa|relative", help="Of the pressure; relative is p/(rho c^2).")]
PressureLimitOption = Annotated[
    str | None,
    typer.Option("--pressure-limit", metavar="PRESSURE", help="End of the pressure's colour scale in Pa.", show_default="from the fields"),
]
SectionOption = Annotated[
    str | None,
    typer.Option(
        "--section",
        metavar="LENGTH",
        help="Three dimensions: z of the cross-section, in m or as in 70 cm.",
        show_default="the first station",
    ),
]
StressLimitOption = Annotated[
    str | None,
    typer.Option("--stress-limit", metavar="PRESSURE", help="End of the stress's colour scale in Pa.", show_default="from the fields"),
]


@dataclass(frozen=True)
class View:
    """The options of a command that draws fields, as typed."""

    width: WidthOption = "6"
    units: UnitsOption = "auto"
    pressure_limit: PressureLimitOption = None
    stress_limit: StressLimitOption = None

    def seen(self, pixels: int) -> FieldView:
        """Return what is seen, so many pixels along a side; InputError names the option that is wrong."""
        from coaxshell.plotting import FieldView, check_units

        view = FieldView(0.5 * number("--width", self.width), pixels)
        check_units(self.units)
        return view

    @property
    def scales(self) -> Scales:
        """The ends of the colour scales and the units of the pressure."""
        highest = limit("--pressure-limit", self.pressure_limit), limit("--stress-limit", self.stress_limit)
        return {"pressure_limit": highest[0], "stress_limit": highest[1], "units": self.units}


class Scales(TypedDict):
    """What a drawing of fields is told of its scales."""

    pressure_limit: float | None
    stress_limit: float | None
    units: str


def limit(option: str, text: str | None) -> float | None:
    """Return the end of a colour scale in Pa, None if it is left to the fields; InputError if it is not positive."""
    if text is None:
        return None
    value = number(option, text)
    if not (math.isfinite(value) and value > 0):
        raise InputError(option, f"{value:g} is not allowed", "give a positive number, in Pa")
    return value


_OF_SETTINGS = (
    *("duration", "time_step", "modes", "tolerance", "engine", "refinement"),
    *("dimensions", "stations", "axial_modes", "axial_period"),
)
_OF_FIELDS = ("times", "until", "frames", "fps", "pixels", "width", "units", "points", "displaced", "output", "folder", "path")


def number(option: str, text: str) -> float:
    """Return the number written in an option."""
    try:
        return float(text)
    except ValueError:
        raise InputError(option, f"{text!r} is not a number", "give a number such as 5 or 1e-3") from None


def whole(option: str, text: str) -> int:
    """Return the whole number written in an option."""
    try:
        return int(text)
    except ValueError:
        raise InputError(option, f"{text!r} is not a whole number", "give one such as 1 or 4") from None


def overrides(texts: Sequence[str], option: str = "--set") -> dict[str, Any]:
    """Return {path: value} from ``path=value`` texts; the value is read as TOML, or else as text such as ``6 mm``."""
    found: dict[str, Any] = {}
    for text in texts:
        path, equals, value = text.partition("=")
        path = path.strip()
        if not path or not equals or not value.strip():
            raise InputError(option, f"{text!r} is not an assignment", 'write path=value, as in "source.peak_pressure=50 kPa"')
        if path in found:
            raise InputError(option, f"{path!r} is given twice", "give each path once")
        found[path] = _value(value.strip())
    return found


def _value(text: str) -> Any:
    from coaxshell.model.toml_text import parsed

    try:
        found = parsed(f"value = {text}")
    except InputError:
        return text
    return found["value"] if len(found) == 1 else text


@contextmanager
def named_as_options(**names: str) -> Iterator[None]:
    """Let errors about arguments name the option instead: ``time_step`` becomes ``--time-step``, or what *names* says of it.

    An item of a setting, such as ``stations[1]``, is called by its option too: the error shows its text.
    """
    try:
        yield
    except InputError as error:
        name, item, _ = error.where.partition("[")
        where = name if item and name in _OF_SETTINGS else error.where
        if where in names or where in _OF_SETTINGS + _OF_FIELDS:
            option = names.get(where, where).replace("_", "-")
            raise InputError(f"--{option}", error.problem, error.remedy) from None
        raise


_MOST = 100_000


def times(text: str, option: str = "--times") -> list[float]:
    """Return the instants of "0.2,1.2,3.6", "0:5:0.1", or both mixed, in the order written.

    Raises
    ------
    InputError
        An item is neither a number nor a range.
    """
    found: list[float] = []
    for item in text.split(","):
        found += _range(item, option) if ":" in item else [_number(item, option)]
    return found


def _range(item: str, option: str) -> list[float]:
    parts = [_number(part, option) for part in item.split(":")]
    if len(parts) != 3 or parts[2] <= 0 or parts[1] < parts[0]:
        raise InputError(option, f"{item.strip()!r} is not a range", "write start:stop:step, as in 0:5:0.1")
    start, stop, step = parts
    count = math.floor((stop - start) / step * (1 + 1e-12) + 1e-9) + 1
    if count > _MOST:
        raise InputError(option, f"{item.strip()!r} asks for {count} instants", f"at most {_MOST} are allowed")
    return [round(start + i * step, 12) for i in range(count)]


def _number(text: str, option: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(option, f"{text.strip()!r} is not a time", "give transits, as in 0.2,1.2,3.6 or 0:5:0.1")
    return value
