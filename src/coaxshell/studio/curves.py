"""A response as the arrays and bars that the page draws."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from coaxshell.model import RigidShell, Shell
from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response import Response
from coaxshell.response.histories import combined
from coaxshell.response.modal import displacement_gain, stress_gain_of, voltage_gain
from coaxshell.response.peaks import Peak
from coaxshell.response.summary import Summary
from coaxshell.response.voltages import actuator_values
from coaxshell.solver.solution import ModalSolution
from coaxshell.studio import limits
from coaxshell.studio.arrays import Item, Packed, packed

QUANTITIES = {
    "stress": ("hoop stress", "Pa"),
    "displacement": ("displacement, inward", "m"),
    "sensor_voltage": ("sensor voltage", "V"),
    "actuator_voltage": ("actuator voltage", "V"),
    "absorber_force": ("absorber force, inward", "N/m"),
}
"""What is given at head and tail of each shell: label and unit."""

BARS = {
    "stress_head": ("peak stress at the head", "Pa"),
    "stress_tail": ("peak stress at the tail", "Pa"),
    "stress": ("peak stress anywhere", "Pa"),
    "stress_rms": ("RMS stress", "Pa"),
    "relative_displacement_head": ("peak relative displacement at the head", "m"),
    "relative_displacement_tail": ("peak relative displacement at the tail", "m"),
    "displacement_head": ("peak absolute displacement at the head", "m"),
    "displacement_tail": ("peak absolute displacement at the tail", "m"),
    "sensor_voltage": ("peak sensor voltage, mean over a segment", "V"),
    "actuator_voltage": ("peak actuator voltage asked for, mean over a segment", "V"),
}


_AT_ENDS: dict[str, Callable[[ModalSolution, int, FloatArray], FloatArray]] = {
    "stress": lambda solution, shell, ends: combined(solution, shell, stress_gain_of(solution, shell), ends),
    "displacement": lambda solution, shell, ends: combined(solution, shell, displacement_gain(solution), ends),
    "sensor_voltage": lambda solution, shell, ends: combined(solution, shell, voltage_gain(solution, shell), ends),
    "actuator_voltage": actuator_values,
}


def curves(response: Response, seconds: float) -> Packed:
    """Return header and arrays of a run as docs/studio-api.md says."""
    system, count = response.system, len(response.system.shells)
    summary = response.summary()
    absorbers = _absorbers(response)
    highest = {shell.name: shell.actuator_limit for shell in summary.shells}
    header = {
        "ok": True,
        "resolution": limits.table_of(response.settings),
        "seconds": seconds,
        "transit_time_seconds": summary.transit_time,
        "name": system.name,
        "shells": [
            {
                "index": index,
                "name": shell_name(index, count),
                "radius": shell.radius,
                "rigid": isinstance(shell, RigidShell),
                "actuator_limit": highest.get(shell_name(index, count)),
            }
            for index, shell in enumerate(system.shells)
        ],
        "absorbers": absorbers,
        "bars": _bars(response, summary),
        "estimates": {
            "stress": [_finite(value) for value in response.estimates.modal_stress],
            "displacement": [_finite(value) for value in response.estimates.modal_displacement],
            "time_window": _finite(response.estimates.time_window),
            "errors": [shell.errors for shell in summary.shells],
        },
        "warnings": list(response.warnings),
    }
    return packed(header, {"time": Item(response.time, "transits"), **_histories(response, absorbers)})


def _histories(response: Response, absorbers: dict[str, Any]) -> dict[str, Item]:
    """Return all histories at the ends of the shells; straight from the solution, since labels would take longer than the numbers."""
    solution, head = response.solution, response.system.sources[0].angle
    ends = np.array([head, head + 180.0])
    items: dict[str, Item] = {}
    for index in range(len(response.system.shells)):
        for quantity in _given(response, index):
            values = _AT_ENDS[quantity](solution, index, ends)
            items[f"{quantity}/{index}"] = Item(np.asarray(values, dtype=np.float32).T, QUANTITIES[quantity][1])
    if solution.absorber_force is not None and response.system.absorber_list:
        forces = solution.problem.scales.line_force * solution.absorber_force
        for index in range(len(response.system.shells)):
            for side, first in ((0, index), (1, index - 1)):  # a shell is the inner one of the gap outside it, the outer one of that inside
                pair = _nearest(response, head, first)
                if pair is not None and f"absorber_force/{index}" not in items:
                    items[f"absorber_force/{index}"] = Item(forces[list(pair), side], "N/m")
    return items


def _given(response: Response, index: int) -> list[str]:
    shell = response.system.shells[index]
    if not isinstance(shell, Shell):
        return []
    found = ["stress", "displacement"]
    if shell.sensor is not None:
        found.append("sensor_voltage")
    if index in response.system.controlled_shells and shell.sensor is not None and shell.actuator is not None:
        found.append("actuator_voltage")
    return found


def _absorbers(response: Response) -> dict[str, Any]:
    listed = response.system.absorber_list
    pair = _nearest(response, response.system.sources[0].angle, None)
    return {
        "count": len(listed),
        "angles": [absorber.angle for absorber in listed],
        "inner_shells": [absorber.inner_shell for absorber in listed],
        "head": None if pair is None else pair[0],
        "tail": None if pair is None else pair[1],
    }


def _nearest(response: Response, head: float, inner_shell: int | None) -> tuple[int, int] | None:
    """Return the numbers of the absorbers nearest to head and tail, of one gap or of all; None without any."""
    numbers = [n for n, one in enumerate(response.system.absorber_list) if inner_shell in (None, one.inner_shell)]
    if not numbers:
        return None
    listed = response.system.absorber_list

    def nearest(angle: float) -> int:
        return min(numbers, key=lambda n: round(abs((listed[n].angle - angle + 180.0) % 360.0 - 180.0), 9))

    return nearest(head), nearest(head + 180.0)


def _bars(response: Response, summary: Summary) -> list[dict[str, Any]]:
    count = len(response.system.shells)
    numbers = {shell_name(index, count): index for index in range(count)}
    bars: list[dict[str, Any]] = []
    for shell in summary.shells:
        for name, (label, unit) in BARS.items():
            value: Peak | float | None = getattr(shell, name)
            if value is None:
                continue
            told = _peak(value) if isinstance(value, Peak) else {"value": _finite(value), "time": None, "angle": None}
            bars.append({"shell": numbers[shell.name], "name": name, "label": label, "unit": unit, **told})
    for name, label, unit in (
        ("absorber_displacement", "peak absorber displacement", "m"),
        ("absorber_force", "peak absorber force", "N/m"),
    ):
        largest = getattr(summary, name)
        if largest is not None:
            bars.append({"shell": None, "name": name, "label": label, "unit": unit, "value": _finite(largest), "time": None, "angle": None})
    return bars


def _peak(peak: Peak) -> dict[str, Any]:
    return {"value": _finite(peak.value), "time": peak.time, "angle": peak.angle, "growing": peak.growing}


def _finite(value: float | FloatArray) -> float | None:
    number = float(value)
    return number if np.isfinite(number) else None
