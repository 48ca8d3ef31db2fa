"""The answer of a fit: the system, each value with its interval, what could not be told, and how well the records are met."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from coaxshell._version import __version__
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.files import replacing_folder
from coaxshell.numerics.identity import numerics
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.texts import percent
from coaxshell.response.summary_text import aligned
from coaxshell.solver.settings import Settings

FIT_PARTS = ("fitted.toml", "fit.json", "records.csv")
"""What a saved fit holds."""


@dataclass(frozen=True)
class FittedValue:
    """One value that was looked for.

    Attributes
    ----------
    name, unit, long_name : str
    start, value : float
        Where the search began, and where it ended, SI.
    deviation : float
        Standard deviation, SI.
    low, high : float
        Interval of the confidence asked for.
    identified : bool
        Whether the records tell it.
    at_limit : bool
        Whether the search ended at a limit of what is allowed.
    """

    name: str
    unit: str
    long_name: str
    start: float
    value: float
    deviation: float
    low: float
    high: float
    identified: bool
    at_limit: bool


@dataclass(frozen=True, eq=False)
class FittedRecord:
    """One record beside the run that was found.

    Attributes
    ----------
    name, quantity, place, unit : str
    time : ndarray, shape (n,)
        Of the samples that were used, since the run began, s.
    measured, modelled : ndarray, shape (n,)
        SI.
    noise : float
        By which its residuals were weighted, SI.
    residual : float
        RMS of measured less modelled, SI.
    correlated : float
        Correlation time of the residual, samples.
    """

    name: str
    quantity: str
    place: str
    unit: str
    time: FloatArray
    measured: FloatArray
    modelled: FloatArray
    noise: float
    residual: float
    correlated: float

    @property
    def explained(self) -> float:
        """Share of the record's mean square that the run explains."""
        square = float(np.mean(self.measured**2))
        return 1.0 - self.residual**2 / square if square > 0.0 else math.nan


@dataclass(frozen=True, eq=False)
class Fit:
    """What a fit found.

    Attributes
    ----------
    system : System
        The one whose run is closest to the records, ready for :func:`simulate`.
    values : tuple of FittedValue
        Properties, then clocks.
    correlation : DataArray
        Of every two values, dims (value, other).
    unidentified : tuple of str
        What the records do not tell, a sentence each, by name.
    remarks : tuple of str
        What else a reader should know: values told apart poorly, at a limit, records that the model does not meet within their noise.
    records : tuple of FittedRecord
    confidence : float
    resolution : Settings
    runs : int
        Runs that it took.
    converged : bool
    """

    system: System
    values: tuple[FittedValue, ...]
    correlation: xr.DataArray
    unidentified: tuple[str, ...]
    remarks: tuple[str, ...]
    records: tuple[FittedRecord, ...]
    confidence: float
    resolution: Settings
    runs: int
    converged: bool = field(default=True)

    def __getitem__(self, name: str) -> FittedValue:
        """Return a value by its name; KeyError if there is none."""
        return {one.name: one for one in self.values}[name]

    def to_dataset(self) -> xr.Dataset:
        """Return the values with their intervals by ``value``, and their correlations."""
        dims = ("value",)
        columns = ("start", "deviation", "low", "high", "identified")
        data = {name: xr.Variable(dims, np.array([getattr(one, name) for one in self.values])) for name in columns}
        data["found"] = xr.Variable(dims, np.array([one.value for one in self.values]))
        data["correlation"] = xr.Variable(("value", "other"), self.correlation.values)
        names = np.array([one.name for one in self.values], dtype=object)
        units = np.array([one.unit for one in self.values], dtype=object)
        coordinates = {"value": xr.Variable(dims, names), "other": xr.Variable(("other",), names), "unit": xr.Variable(dims, units)}
        told = {"title": self._title, "source": f"coaxshell {__version__}", "numerics": numerics(), "confidence": self.confidence}
        return xr.Dataset(data, coordinates, {**told, "scenario": self.system.to_toml_string()})

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain data, without the samples."""
        return {
            "title": self._title,
            "numerics": numerics(),
            "confidence": self.confidence,
            "converged": self.converged,
            "runs": self.runs,
            "resolution": self.resolution.arguments(),
            "values": [_plain(vars(one)) for one in self.values],
            "correlation": np.round(self.correlation.values, 6).tolist(),
            "unidentified": list(self.unidentified),
            "remarks": list(self.remarks),
            "records": [
                {
                    **{name: getattr(one, name) for name in ("name", "quantity", "place", "unit")},
                    "samples": int(one.time.size),
                    **_plain({name: getattr(one, name) for name in ("noise", "residual", "explained", "correlated")}),
                }
                for one in self.records
            ],
        }

    def to_csv(self) -> str:
        """Return the records beside the run as a table with commas: record, time (s), measured, modelled."""
        lines = ["record,time (s),measured (SI),modelled (SI)"]
        for one in self.records:
            name = one.name.replace(",", ";")
            rows = zip(one.time.tolist(), one.measured.tolist(), one.modelled.tolist(), strict=True)
            lines += [f"{name},{t!r},{y!r},{m!r}" for t, y, m in rows]
        return "\n".join(lines) + "\n"

    def save(self, folder: str | Path) -> Path:
        """Write ``fitted.toml``, ``fit.json`` and ``records.csv`` to a folder.

        The files appear together; an earlier result is replaced.

        Raises
        ------
        InputError
            The folder holds something else than an earlier result, or cannot be written.
        """
        with replacing_folder(folder, FIT_PARTS, "output", force=True) as made:
            self.system.to_toml(made / "fitted.toml")
            (made / "fit.json").write_text(json.dumps(self.to_dict(), indent=1), encoding="utf-8")
            (made / "records.csv").write_text(self.to_csv(), encoding="utf-8")
        return Path(folder)

    @property
    def _title(self) -> str:
        return f"fit of {self.system.name.removesuffix(', fitted') or 'a system'} to {len(self.records)} records"

    def __str__(self) -> str:
        """Return aligned tables: values with their intervals, records, and what is not told."""
        rows: list[tuple[str, ...]] = [("value", "start", "found", f"{100 * self.confidence:g} % interval", "unit", "")]
        for one in self.values:
            interval = f"{one.low:.5g} to {one.high:.5g}" if one.identified else "-"
            told = "" if one.identified else "not identified"
            rows.append((one.name, f"{one.start:.5g}", f"{one.value:.5g}", interval, one.unit, told))
        records: list[tuple[str, ...]] = [("record", "what", "where", "samples", "left (RMS)", "explained")]
        for each in self.records:
            left = f"{each.residual:.3g} {each.unit}".removesuffix(" 1")
            records.append((each.name, each.quantity.replace("_", " "), each.place, str(each.time.size), left, percent(each.explained, 2)))
        lines = [*aligned(rows, left=1), "", *aligned(records, left=3)]
        lines += (
            ["", *(f"not identified: {text}" for text in self.unidentified), *self.remarks] if self.unidentified or self.remarks else []
        )
        return "\n".join(lines)


def _plain(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return values of which those that are not finite are None, as JSON knows no such numbers."""
    return {name: None if isinstance(value, float) and not math.isfinite(value) else value for name, value in values.items()}
