"""What control costs in three dimensions: at each station, per length there, and over the whole length of the shells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from html import escape
from typing import Any

from coaxshell.model.places import shell_name
from coaxshell.model.prefixes import engineering
from coaxshell.numerics.progress import Progress
from coaxshell.response.effort import ROWS, ControlEffort, ShellEffort, control_effort
from coaxshell.response.stations import StationMotion
from coaxshell.response.summary_text import aligned
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.electrodes import Segment

_TOTALS = (("real_power", "largest real power", "W"), ("apparent_power", "largest apparent power", "VA"), ("energy", "energy given", "J"))


@dataclass(frozen=True)
class LengthEffort:
    """What the amplifiers of one shell are asked for over its whole length; per metre where all sources are uniform along the axis.

    Attributes
    ----------
    shell : str
    real_power, apparent_power : float
        Largest magnitudes, W and VA: of the integral of voltage times current over the mid-surface, and of the root mean squares over it.
    energy : float
        What the amplifiers have given when the run ends, J.
    """

    shell: str
    real_power: float
    apparent_power: float
    energy: float


def _row(shell: ShellEffort, words: str, unit: str, value: float, station: float, limited: str | None) -> tuple[str, ...]:
    """Return a row of what is largest over the stations, against the limit of a name."""
    limit = None if limited is None else shell.limits.get(limited)
    share = ("", "") if limit is None else (engineering(limit, unit), f"{100.0 * value / limit:.3g} %")
    return shell.shell, words, engineering(value, unit), *share, f"{station:g}"


@dataclass(frozen=True)
class SpatialEffort:
    """The effort at all stations of a run; ``str(effort)`` is an aligned table of what is largest over them.

    Attributes
    ----------
    stations : tuple of float
        m.
    each : tuple of ControlEffort
        One a station: power and energy per metre of length there.
    over_length : tuple of LengthEffort
        Of each controlled shell, where it was asked for.
    extent : str
        "over the whole length", or "per metre of length".
    """

    stations: tuple[float, ...]
    each: tuple[ControlEffort, ...]
    over_length: tuple[LengthEffort, ...] = ()
    extent: str = ""

    def at(self, station: float) -> ControlEffort:
        """Return the effort at a station of the run (m)."""
        return self.each[min(range(len(self.stations)), key=lambda i: abs(self.stations[i] - station))]

    @property
    def within(self) -> bool:
        """Whether no limit is exceeded at any station."""
        return all(one.within for one in self.each)

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain data, ready for JSON."""
        each = [{"station": z, **one.to_dict()} for z, one in zip(self.stations, self.each, strict=True)]
        return {"stations": each, "over_length": [asdict(one) for one in self.over_length], "extent": self.extent, "within": self.within}

    def __str__(self) -> str:
        """Return the aligned table."""
        rows: list[tuple[str, ...]] = [("shell", "effort", "value", "limit", "share", "z [m]")]
        for place, shell in enumerate(self.each[0].shells):
            for name, words, unit in ROWS[:-1]:  # energy is told over the whole length
                total = bool(shell.segments) and name.endswith("power")
                found = [(getattr(one.shells[place], name), z) for one, z in zip(self.each, self.stations, strict=True)]
                if any(value is None for value, _ in found):
                    continue
                rows.append(_row(shell, f"{words}, all segments" if total else words, unit, *max(found), None if total else name))
                if total:  # limits are those of one amplifier
                    worst = [(getattr(one.shells[place].worst(name), name), z) for one, z in zip(self.each, self.stations, strict=True)]
                    words = "largest voltage times current" if name == "apparent_power" else words
                    rows.append(_row(shell, f"{words}, one segment", unit, *max(worst), name))
        for one in self.over_length:
            for name, words, unit in _TOTALS:
                per = f"{unit}/m" if self.extent.startswith("per") else unit
                rows.append((one.shell, f"{words}, {self.extent}", engineering(getattr(one, name), per), "", "", ""))
        return "\n".join(aligned(rows, left=2))

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"


def spatial_effort(
    spatial: SpatialSolution,
    motions: Sequence[StationMotion],
    segment: Segment = None,
    *,
    whole_length: bool = False,
    progress: Progress | None = None,
    **limits: float | None,
) -> SpatialEffort:
    """Return what control costs at the stations of a run, and over the whole length.

    Parameters
    ----------
    spatial : SpatialSolution
    motions : sequence of StationMotion
        Those of the stations.
    segment : float, str or None
        As in two dimensions (:func:`coaxshell.response.effort.control_effort`).
    whole_length : bool
        Whether to add up power and energy over the whole length too: the waves of the run are solved once more, as for its energy.
    progress : callable, optional
        Of these waves.
    **limits : float
        As in two dimensions.

    Raises
    ------
    InputError
        As in two dimensions, and for the whole length as :func:`coaxshell.response.energy.whole_length.require_balanced`.
    """
    each = tuple(control_effort(motion, segment, **limits) for motion in motions)
    stations = tuple(float(z) for z in spatial.stations)
    if not whole_length:
        return SpatialEffort(stations, each)
    from coaxshell.response.energy.length_power import length_power

    found, extent = length_power(spatial, progress)
    shells = len(spatial.problem.shells)
    totals = tuple(LengthEffort(shell_name(one.shell, shells), one.largest_real, one.largest_apparent, one.energy) for one in found)
    return SpatialEffort(stations, each, totals, extent)
