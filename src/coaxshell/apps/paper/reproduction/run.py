"""Carry out the parts that are not done yet, on all cores, and gather what they found."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from coaxshell.apps.paper.reproduction.plan import Part, parts, require_room
from coaxshell.apps.paper.reproduction.results import Results, drawn_figures, estimate_of, judged_claims, sphere_of, walls_of
from coaxshell.apps.paper.reproduction.work import Job, carry_out
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.progress import Progress
from coaxshell.solver.settings import Settings
from coaxshell.studies.executors import completed, worker_count
from coaxshell.studies.store import Store

FINISHED = "parts"
"""Folder, within that of the report, of finished parts."""

TOPICS = ("figures", "claims", "slips", "sphere", "walls", "film", "estimate")


def reproduce(
    folder: Path,
    resolution: Settings | None = None,
    *,
    only: frozenset[str] = frozenset(),
    film_suffix: str | None = ".mp4",
    workers: int | None = None,
    progress: Progress | None = None,
    tell: Callable[[Cost], None] | None = None,
) -> Results:
    """Compute the paper's figures, claims and slips; what is finished in the folder already is taken up.

    Parameters
    ----------
    folder : Path
        Of the report; finished parts are kept in it.
    resolution : Settings, optional
        The paper's unless given.
    only : frozenset of str
        Of TOPICS; all of them if empty.
    film_suffix : str or None
        ".mp4" or ".webp"; None for no film.
    workers : int, optional
        Processes; one a core unless given.
    progress : callable, optional
        Called with the fraction done and the part that was finished.
    tell : callable, optional
        Called with the cost of all that is left to do before it is begun.

    Raises
    ------
    InputError
        A part or an option is not allowed, or so many parts side by side do not fit into memory.
    """
    start = time.perf_counter()
    resolution = resolution or Settings()
    store = Store(folder / FINISHED)
    jobs = [Job(part, resolution, store.folder, film_suffix or "") for part in parts(resolution, only=only, film=film_suffix is not None)]
    waiting = [job for job in jobs if job.key not in store]
    cost = require_room([job.part for job in waiting], resolution, worker_count(workers))
    if tell:
        tell(cost)
    done = len(jobs) - len(waiting)
    resumed = done
    for job, outcome in completed(waiting, carry_out, workers=workers):
        if isinstance(outcome, Exception):
            raise outcome
        done += 1
        if progress:
            progress(0.95 * done / len(jobs), f"reproducing: {job.part.title}")
    pieces = {job.part: _piece(store, job) for job in jobs}

    def wanted(topic: str) -> bool:
        return not only or topic in only

    film = next((piece for part, piece in pieces.items() if part.kind == "film"), None)
    effects: list[dict[str, Any]] = next((values["effects"] for part, (_, values) in pieces.items() if part.kind == "slips"), [])
    figures = drawn_figures(resolution, store, pieces) if wanted("figures") else ()
    judged = judged_claims(resolution, store) if wanted("claims") else ()
    if progress:
        progress(1.0, "reproducing: figures and claims")
    return Results(
        resolution,
        figures,
        judged,
        effects,
        None if film is None else (film[0]["film"].tobytes(), film[1]["suffix"]),
        estimate_of(pieces),
        {part.title: values["seconds"] for part, (_, values) in pieces.items()},
        {part.title: values["processor"] for part, (_, values) in pieces.items()},
        time.perf_counter() - start,
        resumed,
        worker_count(workers),
        sphere_of(resolution, store, pieces),
        walls_of(pieces),
    )


def _piece(store: Store, job: Job) -> tuple[dict[str, Any], dict[str, Any]]:
    piece = store.get(job.key)
    if piece is None:
        carry_out(job)  # it was there but could not be read
        piece = store.get(job.key)
    assert piece is not None
    return piece


__all__ = ["FINISHED", "TOPICS", "Part", "reproduce"]
