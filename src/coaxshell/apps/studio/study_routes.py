"""Sweeps and optimisations as a page asks for them: checked before they start, and as study files for the command line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Route

from coaxshell.apps.studio import bodies, limits, refusals
from coaxshell.apps.studio.routes import studio_of, wanted
from coaxshell.errors import InputError
from coaxshell.studies.design import POINTS

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.solver.settings import Settings

KINDS = ("sweep", "optimise")


class Asked(NamedTuple):
    """A study that may start: its system and settings, what its task takes, and what a file of it has."""

    system: System
    settings: Settings
    arguments: tuple[Any, ...]
    entries: dict[str, Any]
    table: tuple[str, dict[str, Any]]

    @property
    def text(self) -> str:
        """Text of the study as a TOML file."""
        from coaxshell.studies.study_file import study_text

        name, varied = self.table
        command = "sweep" if name == "over" else "optimise"
        return study_text(command, self.system, self.entries, {name: varied, "resolution": limits.table_of(self.settings)})


def asked(kind: str, data: dict[str, Any]) -> Asked:
    """Return the study that a request asks for; InputError or RefusedError when it cannot start."""
    with refusals.readable(kind):
        return {"sweep": _sweep, "optimise": _optimisation}[kind](data)


def _sweep(data: dict[str, Any]) -> Asked:
    from coaxshell.apps.studio import sweeps

    points = bodies.one_of(data, "points", POINTS, "grid")
    samples = None if data.get("samples") is None else bodies.whole_of(data, "samples", 1, 2**31)
    seed = bodies.whole_of(data, "seed", 0, 2**31, 0)
    system, settings = wanted(data, live=False)
    over, metrics = data.get("over"), data.get("metrics", sweeps.METRICS)
    plan = sweeps.planned(system, settings, over, metrics, points, samples, seed)
    entries = {"metrics": metrics, "points": points, "samples": samples, "seed": None if samples is None else seed}
    return Asked(system, settings, (system, settings, *plan), entries, ("over", over or {}))


def _optimisation(data: dict[str, Any]) -> Asked:
    from coaxshell.apps.studio import optimisations

    system, settings = wanted(data, live=False)
    problem = optimisations.planned(system, settings, data)
    entries = {
        "objectives": data["objectives"],
        "constraints": data.get("constraints") or None,
        "method": problem.method,
        "evaluations": problem.evaluations,
        "population": problem.setting.population,
        "seed": problem.setting.seed,
    }
    return Asked(system, settings, (problem, settings), entries, ("variables", data["variables"]))


async def study(request: Request) -> Response:
    """Answer with the study file of what would be started."""
    studio_of(request)
    data = await bodies.read_table(request)
    kind = bodies.one_of(data, "kind", KINDS)
    try:
        text = await run_in_threadpool(lambda: asked(kind, data).text)
    except InputError as error:
        return JSONResponse(refusals.told(error))
    return JSONResponse({"ok": True, "toml": text})


async def left(request: Request) -> Response:
    """Give a page the studies of pages that have gone: after a reload, those it had started itself."""
    data = await bodies.read_table(request)
    return JSONResponse({"jobs": [job.told() for job in studio_of(request).jobs.take_over(bodies.name_of(data, "client"))]})


def routes() -> list[BaseRoute]:
    """Return these routes."""
    return [Route("/api/study", study, methods=["POST"]), Route("/api/studies", left, methods=["POST"])]
