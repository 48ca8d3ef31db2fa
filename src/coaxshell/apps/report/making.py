"""From runs to the file of a report, part by part, with progress and the time it takes told before."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from coaxshell.apps.report import account, answers, balance, fittings, system
from coaxshell.apps.report.page import page
from coaxshell.apps.report.parts import MOST_SHELLS, Section, Subject
from coaxshell.errors import InputError
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.files import write_text
from coaxshell.numerics.progress import Progress
from coaxshell.response.run_comparison import compared, run_labels

if TYPE_CHECKING:
    from coaxshell.response import Response

PARTS = ("spectra", "energy", "fields")
"""What takes long and can be left out."""
_AROUND = np.arange(0.0, 360.0, 10.0)
_FIGURES, _SPECTRUM, _ENERGY, _FIELDS = (5.0, 5e-4), (1.0, 3e-4), (5.0, 3e-5), 6.0
"""Seconds of processor a run, and of the first two a shell and instant, of the third an order and instant, beyond these."""


def report(
    response: Response,
    path: str | Path,
    compare: Response | None = None,
    *,
    without: Collection[str] = (),
    progress: Progress | None = None,
) -> Path:
    """Write a report of a run as one HTML file, and return its path.

    It holds the system to scale with its materials, loads, largest magnitudes, histories, where the stress is largest, shock spectra,
    energy, fields at chosen instants, control effort, strokes of absorbers, warnings, estimated errors and how to repeat it. The file asks
    for nothing outside itself; printed from a browser it has ten A4 pages at most. Below each figure its data can be saved as CSV.

    Parameters
    ----------
    response : Response
        In two or three dimensions.
    path : str or Path
        Where to; ends in .html.
    compare : Response, optional
        A second run, shown beside the first.
    without : collection of str
        Parts to leave out, of "spectra", "energy" and "fields", which take longest.
    progress : callable, optional
        Called with the fraction done and the name of the part.

    Raises
    ------
    InputError
        The file is no .html or cannot be written, a part is unknown, or the runs have no station in common.
    """
    target = Path(path)
    if target.suffix.lower() not in (".html", ".htm"):
        raise InputError("path", f"{str(path)!r} has no known ending", "allowed: .html")
    chosen = parts_left(without)
    subject = _subject(response, compare)
    sections = list(_sections(subject, chosen, progress))
    write_text(target, page(_title(subject), _subtitle(subject), sections))
    if progress is not None:
        progress(1.0, "report")
    return target


def report_cost(response: Response, compare: Response | None = None, *, without: Collection[str] = ()) -> Cost:
    """Return about how long a report takes, as processor time on one core."""
    chosen = parts_left(without)
    seconds = 4.0
    for run in (response, *([compare] if compare is not None else [])):
        stations = 1 if run.stations is None else run.stations.size
        histories = min(MOST_SHELLS, len(run.system.shell_indices(None))) * stations * run.time.size
        seconds += _FIGURES[0] + _FIGURES[1] * histories
        seconds += (_SPECTRUM[0] + _SPECTRUM[1] * histories) * ("spectra" in chosen)
        if run.stations is None:
            seconds += (_ENERGY[0] + _ENERGY[1] * (run.modes + 1) * run.time.size) * ("energy" in chosen) + _FIELDS * ("fields" in chosen)
        else:
            from coaxshell.solver.cost import run_cost

            seconds += run_cost(run.system, run.settings).seconds * (("energy" in chosen) + ("fields" in chosen))
    return Cost(0.0, seconds)


def parts_left(without: Collection[str]) -> list[str]:
    """Return the parts that take long and are not left out; InputError for an unknown one."""
    names = [without] if isinstance(without, str) else list(without)
    for name in names:
        if name not in PARTS:
            raise InputError("without", f"{name!r} is no part that can be left out", f"allowed: {', '.join(PARTS)}")
    return [part for part in PARTS if part not in names]


def _subject(response: Response, compare: Response | None) -> Subject:
    """Return what the report is about: the runs by name, at what can be compared, and the shells that are stressed most."""
    if compare is None:
        runs = {response.system.name or "the system": response}
    else:
        names = run_labels(response, compare)
        runs = compared(dict(zip(names, (response, compare), strict=True)))
    first = next(iter(runs.values()))
    elastic = first.system.shell_indices(None)
    if not elastic:
        raise InputError("shells", "no shell of this run is elastic, so there is nothing to report", "read its fields instead")
    if len(elastic) > MOST_SHELLS:
        elastic = sorted(sorted(elastic, key=lambda shell: -float(np.abs(first.stress(shell, _AROUND)).max()))[:MOST_SHELLS])
    return Subject(runs, elastic)


def _title(subject: Subject) -> str:
    names = list(subject.runs)
    return names[0] if len(names) == 1 else f"{names[0]} against {names[1]}"


def _subtitle(subject: Subject) -> str:
    from coaxshell.response.summary_text import title_lines

    summary = subject.run.summary()
    plain = summary.to_dict()
    return title_lines(plain)[1]


def _sections(subject: Subject, chosen: Collection[str], progress: Progress | None) -> Iterator[Section]:
    """Yield the sections; one that a run cannot give says why."""
    from coaxshell.apps.verification.suite import circumstances

    summaries = {name: response.summary() for name, response in subject.runs.items()}
    makers: list[tuple[str, float, Callable[[Progress | None], Section | None]]] = [
        ("In brief", 1.0, lambda _: answers.in_brief(subject, summaries)),
        ("The system", 0.2, lambda _: system.described(subject)),
        ("Loads", 0.5, lambda _: system.loads(subject)),
        ("Histories", 2.0, lambda _: answers.histories(subject)),
        ("Where the stress is largest", 3.0, lambda _: answers.largest_stress(subject)),
        *([("Shock spectra", 5.0, lambda _: answers.spectra(subject))] if "spectra" in chosen else []),
        *([("Energy", 20.0, lambda report: balance.energies(subject, report))] if "energy" in chosen else []),
        *([("Pressure fields", 10.0, lambda report: balance.fields(subject, report))] if "fields" in chosen else []),
        ("Control effort", 1.0, lambda _: fittings.control(subject, summaries)),
        ("Absorbers", 0.5, lambda _: fittings.absorbers(subject)),
        ("Warnings and estimated errors", 0.1, lambda _: account.trust(subject)),
        ("How to repeat", 0.1, lambda _: account.repeating(subject, circumstances())),
    ]
    whole, done = sum(weight for _, weight, _ in makers), 0.0
    for title, weight, make in makers:
        share = _share(progress, title.lower(), done / whole, weight / whole)
        if share is not None:
            share(0.0, "")
        try:
            section = make(share)
        except InputError as error:
            section = Section(title, [f"Left out: {error}."])
        if section is not None:
            yield section
        done += weight


def _share(progress: Progress | None, title: str, start: float, width: float) -> Progress | None:
    """Return a report for one part of the work, which is told under the part's name."""
    if progress is None:
        return None
    return lambda fraction, _: progress(start + width * min(fraction, 1.0), title)
