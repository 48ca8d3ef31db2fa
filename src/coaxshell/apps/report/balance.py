"""Where the energy goes, and the pressure in the fluids at chosen instants."""

from __future__ import annotations

from typing import Any

import numpy as np

from coaxshell.apps.report.parts import Section, Subject, Table, drawn
from coaxshell.model.prefixes import engineering
from coaxshell.numerics.progress import Progress

_INSTANTS = (0.5, 1.0, 1.5, 2.0, 3.0, 4.0)
"""Transits, beside the instants of the largest stresses."""
_APART = 0.2
"""Transits between two of them at least."""
PIXELS = 240
_EVERY = 4
"""Pixels from one to the next of the data."""


def energies(subject: Subject, progress: Progress | None = None) -> Section:
    """Return the section on energy: what is stored where, lost where, and how well it balances."""
    from coaxshell.plotting.energy import energy_groups, plot_energy
    from coaxshell.plotting.style import PAGE_WIDTH, literal, new_figure, style

    many = len(subject.runs) > 1
    columns: dict[str, Any] = {}
    rows: dict[str, list[str]] = {}
    closed = 0.0
    with style():
        figure = new_figure(PAGE_WIDTH, 2.9 if not many else 5.0)
        axes = figure.subplots(len(subject.runs), 1, squeeze=False)[:, 0]
    for number, (ax, (name, response)) in enumerate(zip(axes, subject.runs.items(), strict=True)):
        balance = response.energy(progress=_share(progress, number, len(subject.runs)))
        plot_energy(balance, ax)
        if many:
            ax.set_title(literal(name), loc="left", fontweight="bold")
        unit = str(balance["exterior_work"].attrs["units"])
        closed = max(closed, float(np.abs(balance["closure_relative"]).max()))
        columns.setdefault("time (a/c_e)", balance["time"].to_numpy())
        values = {str(key): variable.to_numpy() for key, variable in balance.data_vars.items()}
        first = columns["time (a/c_e)"]
        columns |= {
            f"{name + ' ' if many else ''}{key} ({balance[key].attrs['units']})": np.interp(first, balance["time"].to_numpy(), one)
            for key, one in values.items()
        }
        told = {"work of the exterior pressure": values["exterior_work"]} | {k: 1e-3 * v for k, v in energy_groups(balance).items()}
        for group, one in told.items():
            cells = rows.setdefault(group, [""] * 2 * len(subject.runs))
            cells[2 * number : 2 * number + 2] = [engineering(float(np.abs(one).max()), unit), engineering(float(one[-1]), unit)]
    caption = f"Stores and losses, stacked, add up to the work of the exterior pressure within {closed:.1g} of it."
    said = "; ".join(f"{group}: up to {', '.join(filter(None, cells[::2]))}" for group, cells in rows.items())
    head = [f"{name + ': ' if many else ''}{what}" for name in subject.runs for what in ("largest", "at the end")]
    picture = drawn(figure, "energy", f"{caption} {said}.", caption, columns)
    return Section("Energy", [picture, Table("Energy by what holds or takes it", ("", *head), [(k, *v) for k, v in rows.items()])])


def fields(subject: Subject, progress: Progress | None = None) -> Section:
    """Return the section of pressure fields at instants that the largest stresses choose."""
    from coaxshell.plotting import FieldView, figure_snapshots

    times = instants(subject)
    runs = list(subject.runs.values())
    panels = sum(1 if response.stations is None else 2 for response in runs)
    view = FieldView(3.0, PIXELS)
    names = list(subject.runs) if len(runs) > 1 else []
    columns = 3 if panels == 1 else 2 if panels == 2 else 1
    sheet = figure_snapshots(*runs, times=times, names=names, view=view, columns=columns, progress=progress)
    told = ", ".join(f"{time:.3g}" for time in times)
    caption = f"Pressure in the fluids (colour), hoop stress on the walls, at t = {told} transits; the wave comes from the right."
    return Section("Pressure fields", [drawn(sheet, "fields", caption, caption, _sampled(subject, times), form="png")])


def instants(subject: Subject) -> list[float]:
    """Return six instants at most, or as many as fit: those of the largest hoop stress of each shell, and others spread over the run."""
    end = min(float(response.time[-1]) for response in subject.runs.values())
    panels = sum(1 if response.stations is None else 2 for response in subject.runs.values())
    most = 6 if panels <= 2 else 4
    summary: Any = subject.run.summary()
    each = summary.each if subject.run.stations is not None else [summary]
    peaks = [max((one.shells[i].stress for one in each), key=lambda peak: peak.value) for i in range(len(each[0].shells))]
    found: list[float] = []
    for peak in sorted(peaks, key=lambda peak: -peak.value):
        if peak.time <= end and all(abs(peak.time - other) > _APART for other in found) and len(found) < most - 2:
            found.append(peak.time)
    for time in (*(one for one in _INSTANTS if one <= end), end):
        if len(found) < most and all(abs(time - other) > _APART for other in found):
            found.append(time)
    return sorted(found)


def _sampled(subject: Subject, times: list[float]) -> dict[str, Any]:
    """Return the pressure at one in sixteen pixels of the first run in two dimensions, x and y in a; nothing of three."""
    response = subject.run
    if response.stations is not None:
        return {}
    x = np.linspace(-3.0, 3.0, PIXELS // _EVERY + 1)
    values = response.pressure(x=x, y=x, time=times)
    grid = np.meshgrid(x, x)
    table: dict[str, Any] = {"x (a)": grid[0].ravel(), "y (a)": grid[1].ravel()}
    return table | {f"t = {time:.4g} (Pa)": frame.ravel() for time, frame in zip(times, values.to_numpy(), strict=True)}


def _share(progress: Progress | None, number: int, count: int) -> Progress | None:
    if progress is None:
        return None
    return lambda fraction, stage: progress((number + fraction) / count, stage)
