"""The summary of a three-dimensional run: that of each station, and what is largest over all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import Any

import numpy as np

from coaxshell.model.display.card import card
from coaxshell.model.prefixes import engineering
from coaxshell.model.system import System
from coaxshell.response.absorbers import of_lines
from coaxshell.response.arguments import time_window
from coaxshell.response.quantities import summary_rows
from coaxshell.response.stations import StationMotion
from coaxshell.response.summary import Summary, summarise
from coaxshell.response.summary_text import aligned, notes, title_lines, when
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.electrodes import Segment

_HEADING = ("shell", "largest magnitude", "value", "t [a/c_e]", "angle [deg]", "z [m]")
_PER_STATION = ("stress", "von_mises_stress", "relative_displacement")
"""Largest magnitudes that are told of each station."""
_ACROSS = 6
"""Stations that stand side by side in a table; more of them below each other."""


@dataclass(frozen=True)
class SpatialSummary:
    """What a three-dimensional run came to; ``str(summary)`` is an aligned table.

    Attributes
    ----------
    stations : tuple of float
        Axial positions, m.
    each : tuple of Summary
        One a station.
    absorber_displacement, absorber_force : float or None
        Largest magnitude over all absorbers (and both sides; of lines over the stations too), m and N or, of lines, N/m; None without.
    absorber_force_unit : str
        "N", or "N/m" of lines.
    """

    stations: tuple[float, ...]
    each: tuple[Summary, ...]
    absorber_displacement: float | None = None
    absorber_force: float | None = None
    absorber_force_unit: str = "N"

    def at(self, station: float) -> Summary:
        """Return the summary of a station of the run (m)."""
        return self.each[min(range(len(self.stations)), key=lambda i: abs(self.stations[i] - station))]

    @property
    def warnings(self) -> tuple[str, ...]:
        """What the run warned of."""
        return self.each[0].warnings

    def without_warnings(self) -> SpatialSummary:
        """Return the same without warnings, where they are told in another way."""
        return replace(self, each=tuple(summary.without_warnings() for summary in self.each))

    @property
    def largest(self) -> list[dict[str, Any]]:
        """The largest magnitudes over all stations, a dict a shell: by the keys of a summary, each with its station (m) beside it."""
        plain = [summary.to_dict() for summary in self.each]
        return [self._largest([one["shells"][i] for one in plain]) for i in range(len(plain[0]["shells"]))]

    def _largest(self, shells: Sequence[dict[str, Any]]) -> dict[str, Any]:
        found: dict[str, Any] = {"name": shells[0]["name"]}
        for key, _, _ in summary_rows(3):
            peaks = [_peak(shell.get(key)) for shell in shells]
            if any(peak is None for peak in peaks):
                continue
            largest, station = max(((peak or {}, z) for peak, z in zip(peaks, self.stations, strict=True)), key=lambda one: one[0]["value"])
            found[key] = {**largest, "station": station}
        return found

    def to_dict(self) -> dict[str, Any]:
        """Return all of it as nested plain dicts, lists and numbers, ready for JSON."""
        each = [{"station": z, **summary.to_dict()} for z, summary in zip(self.stations, self.each, strict=True)]
        common = {key: each[0][key] for key in ("title", "window", "transit_time", "settings", "warnings")}
        absorbers: dict[str, Any] = {"absorber_displacement": self.absorber_displacement, "absorber_force": self.absorber_force}
        if self.absorber_force is not None:
            absorbers["absorber_force_unit"] = self.absorber_force_unit
        return {**common, **absorbers, "stations": each, "largest": self.largest}

    def __str__(self) -> str:
        plain = self.each[0].to_dict()
        warnings = (f"warning: {text}" for text in plain["warnings"])
        along = ["", *self._along()] if len(self.stations) > 1 else []
        return "\n".join(
            [*title_lines(plain), self.waves, "", *aligned([_HEADING, *self.rows()], left=2), *along, "", *self.notes(), *warnings]
        )

    def _absorbers(self) -> list[str]:
        if self.absorber_displacement is None or self.absorber_force is None:
            return []
        return [
            f"largest absorber displacement: {engineering(self.absorber_displacement, 'm')}",
            f"largest absorber force: {engineering(self.absorber_force, self.absorber_force_unit)}",
        ]

    @property
    def waves(self) -> str:
        """The line that says which axial wavenumbers were added up."""
        settings = self.each[0].settings
        period = engineering(settings["axial_period"], "m")
        return f"three dimensions: axial wavenumbers up to {settings['axial_modes']:g} (times a), period {period}"

    def notes(self) -> list[str]:
        """Return the lines below the table: what the largest voltages are, estimated errors of the whole, what is left out."""
        plain = self.each[0].to_dict()
        shells = [{**shell, **largest} for shell, largest in zip(plain["shells"], self.largest, strict=True)]
        rates = any("shell_velocity" in largest for largest in self.largest)
        left_out = "velocity and acceleration of shells are read by name: their transforms are not at hand, which takes as long as the run"
        return [*self._absorbers(), *notes({**plain, "shells": shells}), *([] if rates or not shells else [left_out])]

    def rows(self) -> list[tuple[str, ...]]:
        """Return the rows of the table: shell, what, largest value, time, angle and z, as text."""
        rows: list[tuple[str, ...]] = []
        labels = {key: (label, unit) for key, label, unit in summary_rows(3)}
        for shell in self.largest:
            for key, (label, unit) in labels.items():
                if key in shell:
                    peak = shell[key]
                    place = (when(peak), f"{peak['angle']:.4g}") if "time" in peak else ("", "")
                    rows.append((shell["name"], label, engineering(peak["value"], unit), *place, f"{peak['station']:g}"))
        return rows

    def _along(self) -> list[str]:
        """Return the table of what is largest at each station: a column a station, or a row of many."""
        rows: list[tuple[str, ...]] = [("shell", "largest anywhere at z =", *(f"{z:g} m" for z in self.stations))]
        labels = {key: (label, unit) for key, label, unit in summary_rows(3) if key in _PER_STATION}
        plain = [summary.to_dict()["shells"] for summary in self.each]
        for i, shell in enumerate(plain[0]):
            for key, (label, unit) in labels.items():
                if shell.get(key) is not None:
                    values = (engineering(one[i][key]["value"], unit) for one in plain)
                    rows.append((shell["name"], label.removesuffix(" anywhere"), *values))
        if len(self.stations) <= _ACROSS:
            return aligned(rows, left=2)
        heading = ("z", *(f"{shell} {label}" for shell, label, *_ in rows[1:]))
        return aligned([heading, *zip(*(row[2:] for row in rows), strict=True)], left=0)

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


def _peak(value: Any) -> dict[str, Any] | None:
    """Return a peak, or a bare number as one without time and place."""
    return value if value is None or isinstance(value, dict) else {"value": value}


def station_card(found: SpatialSummary, system: System) -> str:
    """Return the drawing of the system that was solved beside its peaks over all stations, error estimates and warnings, as HTML."""
    columns = {"stress": "Pa", "axial_stress": "Pa", "von_mises_stress": "Pa", "relative_displacement": "m"}
    rows = [("", *("hoop stress: anywhere", "at z", "axial stress", "at z", "von Mises stress", "at z", "relative displacement", "at z"))]
    for shell in found.largest:
        pairs = ((engineering(shell[key]["value"], unit), f"{shell[key]['station']:g} m") for key, unit in columns.items())
        rows.append((shell["name"], *(cell for pair in pairs for cell in pair)))
    plain = found.each[0].to_dict()
    stations = ", ".join(f"{z:g}" for z in found.stations)
    combined = [(shell["name"], shell["errors"]["stress"]["combined"]) for shell in plain["shells"]]
    told = ", ".join(f"{name} {error:.1e}" for name, error in combined if error is not None)
    lines = [title_lines(plain)[1], f"{found.waves}; stations at z = {stations} m", f"estimated relative error of the stress: {told}"]
    return card(system, found.each[0].title or "unnamed system", rows, [*lines, *(f"warning: {text}" for text in found.warnings)])


def summarise_stations(
    spatial: SpatialSolution,
    motions: Sequence[StationMotion],
    window: Sequence[float] | None = None,
    segment: Segment = None,
    *,
    judged: bool = True,
) -> SpatialSummary:
    """Return the summary of each station within a window (start, end) in transits; see :func:`coaxshell.response.summary.summarise`."""
    each = tuple(summarise(motion.solution, window, segment, motion=motion, judged=judged) for motion in motions)
    span, scales = time_window(spatial.time, window), spatial.problem.scales
    lines = of_lines(spatial)
    q, f = (spatial.line_displacement, spatial.line_force) if lines else (spatial.absorber_displacement, spatial.absorber_force)
    return SpatialSummary(
        tuple(spatial.stations.tolist()),
        each,
        None if q is None else scales.length * float(np.abs(q[..., span]).max()),
        None if f is None else (scales.line_force if lines else scales.force) * float(np.abs(f[..., span]).max()),
        "N/m" if lines else "N",
    )
