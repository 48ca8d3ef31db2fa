"""Two runs side by side: their names, what of them can be compared, and how each peak of the first stands to that of the second."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, cast

from coaxshell.errors import InputError
from coaxshell.model.prefixes import against, engineering
from coaxshell.response.quantities import summary_rows
from coaxshell.response.station_choice import SAME
from coaxshell.response.summary_text import GROWING

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response.response import Response
    from coaxshell.response.spatial import SpatialResponse
    from coaxshell.response.spatial_summary import SpatialSummary
    from coaxshell.response.summary import Summary

_NONE = "-"


def labels(first: System, second: System) -> tuple[str, str]:
    """Return a name for each of two systems, different even where theirs are not."""
    one, other = first.name or "first", second.name or "second"
    return (one, other) if one != other else (one, f"{other} (compared)")


def run_labels(first: Response, second: Response) -> tuple[str, str]:
    """Return a name for each of two runs, with their dimensions where only these tell them apart."""
    one, other = labels(first.system, second.system)
    flat = [response.stations is None for response in (first, second)]
    if first.system.name != second.system.name or flat[0] == flat[1]:
        return one, other
    two, three = f"{one}, two dimensions", f"{one}, three dimensions"
    return (two, three) if flat[0] else (three, two)


def compared(named: Mapping[str, Response]) -> dict[str, Response]:
    """Return two named runs at what can be compared: in three dimensions the stations that both have, the first beside two dimensions.

    Raises
    ------
    InputError
        They have no station in common.
    """
    spatial = {name: cast("SpatialResponse", response) for name, response in named.items() if response.stations is not None}
    if len(spatial) < len(named):
        return {name: spatial[name].at(spatial[name].stations[0]) if name in spatial else response for name, response in named.items()}
    first, second = (response.stations for response in spatial.values())
    common = [z for z in first if abs(second - z).min() <= SAME]
    if not common:
        raise InputError("compare", "the runs have no station in common", "give --stations that the saved run has")
    return {name: response.at(common) for name, response in spatial.items()}


def comparison_rows(first: Summary | SpatialSummary, second: Summary | SpatialSummary) -> list[tuple[str, ...]]:
    """Return (shell, quantity, first value, second value, how these stand) for each shell and quantity that either run has.

    Of three dimensions the largest over all stations counts. Where a value still grows at the end of its run that would be a matter of
    the run's length: it is not given.
    """
    plain = [summary.to_dict() for summary in (first, second)]
    ours, theirs = ({shell["name"]: shell for shell in one["largest" if "largest" in one else "shells"]} for one in plain)
    rows = []
    for name in dict.fromkeys([*ours, *theirs]):
        for key, label, unit in summary_rows(3):
            found = [shells.get(name, {}).get(key) for shells in (ours, theirs)]
            pair = [_number(value) for value in found]
            if any(value is not None for value in pair):
                texts = [_NONE if value is None else engineering(value, unit) for value in pair]
                grows = any(isinstance(value, Mapping) and value.get("growing", False) for value in found)
                rows.append((name, label, *texts, GROWING if grows else against(pair[0], pair[1])))
    of_absorbers = [("absorber_displacement", "displacement of masses", "m")]
    units = {one.get("absorber_force_unit", "N/m") for one in plain if one.get("absorber_force") is not None}
    if len(units) == 1:  # a line's force is per metre, a point's is none
        of_absorbers.append(("absorber_force", "force on a shell", units.pop()))
    for key, label, unit in of_absorbers:
        pair = [one.get(key) for one in plain]
        if any(value is not None for value in pair):
            rows.append(("absorbers", label, *(_NONE if v is None else engineering(v, unit) for v in pair), against(pair[0], pair[1])))
    return rows


def _number(value: Mapping[str, Any] | float | None) -> float | None:
    found: float | None = value["value"] if isinstance(value, Mapping) else value
    return found
