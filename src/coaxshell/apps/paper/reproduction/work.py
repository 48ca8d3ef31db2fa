"""Carry out one part and keep it: arrays and plain values, with the seconds that it took."""

from __future__ import annotations

import tempfile
import time
import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.apps.paper import cases
from coaxshell.apps.paper.claims import systems
from coaxshell.apps.paper.figures import FIGURES
from coaxshell.apps.paper.known_runs import Runs, key_of
from coaxshell.apps.paper.recipes import FigureRecipe
from coaxshell.apps.paper.reproduction.plan import DIRECT_SAMPLE, VARIANTS, WITH_FIELDS, Part, groups, sphere_resolution, walls_resolution
from coaxshell.errors import PhysicsWarning
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.solver.settings import Settings
from coaxshell.studies.store import Store

if TYPE_CHECKING:
    from coaxshell.apps.paper.sphere.report import Report as SphereReport
    from coaxshell.apps.paper.thickness.report import Report as WallsReport

Piece = tuple[dict[str, Any], dict[str, Any]]
FILM = {"frames": 200, "fps": 20.0, "pixels": 300}


@dataclass(frozen=True)
class Job:
    """A part, its resolution and the folder of the store, as sent to a worker."""

    part: Part
    resolution: Settings
    folder: Path
    film_suffix: str = ".mp4"

    @property
    def key(self) -> str:
        """Name of the finished part in the store."""
        return key_of("part", asdict(self.part), self.resolution.arguments(), self.film_suffix if self.part.kind == "film" else "")


def runs_of(variant: str, resolution: Settings, store: Store | None) -> Runs:
    """Return the runs of a variant of the model."""
    from coaxshell.apps.paper import slips

    def solver(wanted: Any, settings: Settings, progress: Any) -> Iterator[tuple[str, Any]]:
        return slips.solve_each(wanted, settings, VARIANTS[variant], progress)

    return Runs(resolution, solver=solver, variant=variant, store=store, has_fields=variant in WITH_FIELDS)


def carry_out(job: Job) -> float:
    """Do a part, keep it, and return its seconds; a part that is there already is not done again."""
    store = Store(job.folder)
    start, begun = time.perf_counter(), time.process_time()
    with one_blas_thread(), warnings.catch_warnings():
        warnings.simplefilter("ignore", PhysicsWarning)  # the report has them
        arrays, values = _WORK[job.part.kind](job, store)
    seconds = time.perf_counter() - start
    store.put(job.key, arrays, {**values, "seconds": seconds, "processor": time.process_time() - begun})
    return seconds


def _runs(job: Job, store: Store) -> Piece:
    group = groups(job.resolution)[job.part.about]
    runs = runs_of(job.part.variant, job.resolution, store)
    count = sum(1 for _ in runs.each(group.systems, resolution=group.resolution, peaks_only=group.peaks_only))
    return {}, {"runs": count}


def _fields(job: Job, store: Store) -> Piece:
    runs_of(job.part.variant, job.resolution, store).fields(systems.preset(job.part.about))
    return {}, {}


def _responses(job: Job, names: tuple[str, ...]) -> list[Any]:
    from coaxshell.response import simulate

    return [simulate(systems.preset(name), settings=job.resolution) for name in names]


def _figure(job: Job, store: Store) -> Piece:
    recipe = FIGURES[job.part.about]
    if not isinstance(recipe, FigureRecipe):
        raise TypeError(f"figure {recipe.number} is drawn from many runs")
    responses = _responses(job, recipe.presets)
    told = dict.fromkeys(text for response in responses for text in response.warnings)
    return {"png": picture(recipe.draw(responses, None))}, {"warnings": list(told)}


def picture(figure: Any) -> np.ndarray[Any, Any]:
    """Return a figure as the bytes of a PNG file."""
    from coaxshell.plotting import save_figure

    with tempfile.TemporaryDirectory() as folder:
        return np.frombuffer(save_figure(figure, Path(folder) / "figure.png").read_bytes(), dtype=np.uint8)


def _film(job: Job, store: Store) -> Piece:
    from coaxshell.plotting import FieldView, save_film

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"film{job.film_suffix}"
        view = FieldView(3.0, int(FILM["pixels"]))
        responses = _responses(job, ("bare", "hybrid"))
        save_film(*responses, path=path, frames=int(FILM["frames"]), fps=FILM["fps"], view=view, units="relative")
        return {"film": np.frombuffer(path.read_bytes(), dtype=np.uint8)}, {"suffix": job.film_suffix}


def _slips(job: Job, store: Store) -> Piece:
    from coaxshell.apps.paper.slips.effects import effects

    return {}, {"effects": [_plain(asdict(effect)) for effect in effects(job.resolution)]}


def _plain(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: list(value) if isinstance(value, tuple) else value for name, value in values.items()}


def _sphere(job: Job, store: Store) -> Piece:
    from coaxshell.apps.paper.sphere.report import report

    return _report(report(sphere_resolution(job.resolution)))


def _walls(job: Job, store: Store) -> Piece:
    from coaxshell.apps.paper.thickness.report import report

    made = report(walls_resolution(job.resolution))
    pictures, told = _report(made)
    return pictures, {**told, "map_told": made.map_told}


def _report(made: SphereReport | WallsReport) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the pictures of a report, and what it tells."""
    pictures = {name: picture(figure) for name, figure in made.figures().items()}
    tables = [[caption, list(headings), [list(row) for row in rows]] for caption, headings, rows in made.tables]
    return pictures, {"markdown": made.markdown("figures/"), "tables": tables, "told": made.told}


def _sphere_claims(job: Job, store: Store) -> Piece:
    """Judge the claims of one module under the slice and under the sphere; their runs stay in the store."""
    from coaxshell.apps.paper.sphere.judged import judged_in_both, topic

    judged = judged_in_both(job.resolution, (topic(job.part.about),), store)
    return {}, {"claims": len(judged.claims)}


def _direct(job: Job, store: Store) -> Piece:
    """Measure the processor time of both engines on a sample of Figure 9's runs, each run on its own."""
    from coaxshell.response import simulate

    seconds: dict[str, list[float]] = {"direct": [], "spectral": []}
    for system in cases.count(systems.preset("bare"), DIRECT_SAMPLE).values():
        for engine, taken in seconds.items():
            start = time.process_time()
            simulate(system, settings=job.resolution, engine=engine, refinement=1)
            taken.append(time.process_time() - start)
    return {}, {**seconds, "sample": list(DIRECT_SAMPLE)}


_WORK: dict[str, Callable[[Job, Store], Piece]] = {
    "runs": _runs,
    "fields": _fields,
    "figure": _figure,
    "film": _film,
    "slips": _slips,
    "sphere": _sphere,
    "claims under the sphere": _sphere_claims,
    "walls": _walls,
    "direct": _direct,
}

__all__ = ["FILM", "Job", "carry_out", "picture", "runs_of"]
