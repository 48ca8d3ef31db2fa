"""A response as the arrays and bars that the page draws."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from coaxshell.apps.studio import limits
from coaxshell.apps.studio.arrays import Item, Packed, packed
from coaxshell.model import Absorber, PointAbsorber, RigidShell, Shell
from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response import Response
from coaxshell.response.errors import error_table
from coaxshell.response.peaks import Peak
from coaxshell.response.quantities import QUANTITIES, Quantity, Where, columns
from coaxshell.response.summary import Summary, summarise
from coaxshell.response.tables import quantities_of
from coaxshell.response.voltages import actuator_limit
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.links.described import shells_between

_ABSORBER_FORCE = {"absorber_force": ("absorber force, inward", "N/m")}
_PLACES: dict[Where, str] = {"head": "peak {} at the head", "tail": "peak {} at the tail", "anywhere": "peak {} anywhere", "rms": "RMS {}"}


def quantities() -> dict[str, tuple[str, str]]:
    """Return what is given at head and tail of each shell, in any dimensions: label and unit by name."""
    return {quantity.name: (quantity.label, quantity.unit) for quantity in columns(3)} | _ABSORBER_FORCE


def bars(dimensions: int = 2) -> dict[str, tuple[str, str]]:
    """Return the bars of a shell: label and unit by their keys in the summary."""
    return {
        quantity.key(where): (
            f"peak {quantity.noun}, mean over a segment" if quantity.largest and quantity.roles else _PLACES[where].format(quantity.noun),
            quantity.unit,
        )
        for quantity in QUANTITIES.values()
        if quantity.dimensions <= dimensions
        for where in quantity.summary
    }


def rates() -> set[str]:
    """Return the names of velocities and accelerations, which take a transform back to themselves."""
    return {quantity.name for quantity in columns() if quantity.rate}


def curves(response: Response, seconds: float, *, with_rates: bool = True, with_bars: bool = True) -> Packed:
    """Return header and arrays of a run as docs/studio-api.md says, with bars, and velocities and accelerations, if wanted."""
    absorbers = absorbers_of(response, response.system.absorber_list)
    left_out = [] if with_rates else sorted(rates())
    header = {
        **header_of(response, seconds),
        "absorbers": absorbers,
        "bars": bars_alone(response) if with_bars else None,
        "left_out": left_out,
    }
    return packed(header, {"time": Item(response.time, "transits"), **_histories(response, absorbers, with_rates)})


def header_of(response: Response, seconds: float) -> dict[str, Any]:
    """Return what the headers of all runs have: resolution and shells."""
    system, count = response.system, len(response.system.shells)
    walls = response.solution.problem.shells
    return {
        "ok": True,
        "resolution": limits.table_of(response.settings),
        "seconds": seconds,
        "transit_time_seconds": system.transit_time,
        "name": system.name,
        "shells": [
            {
                "index": index,
                "name": shell_name(index, count),
                "radius": shell.radius,
                "rigid": isinstance(shell, RigidShell),
                "actuator_limit": actuator_limit(response.solution, index).volts if walls[index].has("actuator") else None,
            }
            for index, shell in enumerate(system.shells)
        ],
    }


def judgement(response: Response) -> dict[str, Any]:
    """Return estimated errors and warnings of a run as docs/studio-api.md says."""
    elastic = response.system.shell_indices()
    return {
        "estimates": {
            "stress": [_finite(value) for value in response.estimates.modal_stress],
            "displacement": [_finite(value) for value in response.estimates.modal_displacement],
            "time_window": _finite(response.estimates.time_window),
            "errors": [error_table(response.solution, index) for index in elastic],
        },
        "warnings": list(response.warnings),
    }


def _histories(response: Response, absorbers: dict[str, Any], with_rates: bool) -> dict[str, Item]:
    """Return all histories at the ends of the shells; straight from the solution, since labels would take longer than the numbers."""
    solution, head = response.solution, response.system.sources[0].angle
    ends = np.array([head, head + 180.0])
    items: dict[str, Item] = {}
    for index in range(len(response.system.shells)):
        for quantity in given(response.motion, index):
            if quantity.rate and not with_rates:
                continue
            values = quantity.at(response.motion, index, ends)
            items[f"{quantity.name}/{index}"] = Item(np.asarray(values, dtype=np.float32).T, quantity.unit)
    if solution.absorber_force is not None and response.system.absorber_list:
        forces = solution.problem.scales.line_force * solution.absorber_force
        for index in range(len(response.system.shells)):
            for side in (0, 1):
                pair = _nearest(response.system.absorber_list, head, (side, index), len(response.system.shells))
                if pair is not None and f"absorber_force/{index}" not in items:
                    items[f"absorber_force/{index}"] = Item(forces[list(pair), side], "N/m")
    return items


def given(motion: WallMotion, index: int) -> list[Quantity]:
    """Return the quantities of a shell whose histories are given."""
    return quantities_of(motion, index) if isinstance(motion.solution.problem.system.shells[index], Shell) else []


def absorbers_of(response: Response, listed: Sequence[Absorber | PointAbsorber]) -> dict[str, Any]:
    """Return where absorbers are, and the numbers of those nearest to head and tail."""
    pair = _nearest(listed, response.system.sources[0].angle)
    pairs = [shells_between(one, len(response.system.shells)) for one in listed]
    return {
        "count": len(listed),
        "angles": [absorber.angle for absorber in listed],
        "inner_shells": [inner for inner, _ in pairs],
        "outer_shells": [outer for _, outer in pairs],
        "head": None if pair is None else pair[0],
        "tail": None if pair is None else pair[1],
    }


def _nearest(
    listed: Sequence[Absorber | PointAbsorber], head: float, end: tuple[int, int] | None = None, shells: int = 0
) -> tuple[int, int] | None:
    """Return the numbers of the absorbers nearest to head and tail, of those that end on a side on a shell, or all; None without any."""
    numbers = [n for n, one in enumerate(listed) if end is None or shells_between(one, shells)[end[0]] == end[1]]
    if not numbers:
        return None

    def nearest(angle: float) -> int:
        return min(numbers, key=lambda n: round(abs((listed[n].angle - angle + 180.0) % 360.0 - 180.0), 9))

    return nearest(head), nearest(head + 180.0)


def bars_alone(response: Response) -> list[dict[str, Any]]:
    """Return the bars of a run of two dimensions.

    Without peaks of velocities and accelerations, errors and warnings, which take longer; they take as long as a slider's run.
    """
    return bars_of(response, summarise(response.solution, judged=False))


def bars_of(response: Response, summary: Summary, dimensions: int = 2) -> list[dict[str, Any]]:
    """Return the bars of all shells, and of the absorbers."""
    count = len(response.system.shells)
    numbers = {shell_name(index, count): index for index in range(count)}
    found: list[dict[str, Any]] = []
    for shell in summary.shells:
        for name, (label, unit) in bars(dimensions).items():
            value: Peak | float | None = getattr(shell, name)
            if value is None:
                continue
            told = _peak(value) if isinstance(value, Peak) else {"value": _finite(value), "time": None, "angle": None}
            found.append({"shell": numbers[shell.name], "name": name, "label": label, "unit": unit, **told})
    return [*found, *absorber_bars(summary.absorber_displacement, summary.absorber_force, "N/m")]


def absorber_bars(displacement: float | None, force: float | None, unit: str) -> list[dict[str, Any]]:
    """Return the bars of the absorbers, whose forces have a unit of their own at points."""
    each = (
        ("absorber_displacement", "peak absorber displacement", "m", displacement),
        ("absorber_force", "peak absorber force", unit, force),
    )
    return [
        {"shell": None, "name": name, "label": label, "unit": of, "value": _finite(largest), "time": None, "angle": None}
        for name, label, of, largest in each
        if largest is not None
    ]


def _peak(peak: Peak) -> dict[str, Any]:
    return {"value": _finite(peak.value), "time": peak.time, "angle": peak.angle, "growing": peak.growing}


def _finite(value: float | FloatArray) -> float | None:
    number = float(value)
    return number if np.isfinite(number) else None
