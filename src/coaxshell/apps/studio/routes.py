"""Descriptions and live solves."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from typing import Any, TypeVar

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Route

from coaxshell.apps.studio import arrays, bodies, descriptions, limits, links, refusals, worker
from coaxshell.apps.studio.downloads import described
from coaxshell.apps.studio.refusals import RefusedError
from coaxshell.apps.studio.state import Run, Studio
from coaxshell.errors import InputError
from coaxshell.model import System, units
from coaxshell.solver.settings import Settings

MOST_REVISION = 2**53
HISTORIES, BARS = ("all", "without rates"), ("now", "later")
T = TypeVar("T")


def studio_of(request: Request) -> Studio:
    """Return the server's state."""
    studio: Studio = request.app.state.studio
    if studio.closing:
        raise RefusedError(503, "closing", "server", "is ending", "start it again")
    return studio


async def schema(request: Request) -> Response:
    """Answer with all that a form is made from."""
    return JSONResponse(await asyncio.shield(request.app.state.schema))


async def validate(request: Request) -> Response:
    """Answer with the normalised description or its first problem."""
    return await conversation(await bodies.read_table(request))


async def read(work: Callable[[], T], data: dict[str, Any]) -> T:
    """Return what is made of a description: here where it takes a millisecond, beside the event loop where it may take longer.

    As the first unusual unit does: half a second.
    """
    return work() if len(str(data)) < bodies.LONG and units.knows_all() else await run_in_threadpool(work)


async def conversation(data: dict[str, Any], **more: Any) -> Response:
    """Return the answer to a description, valid or not, with further entries."""
    try:
        # The costs of choices take milliseconds each: beside the event loop.
        answer = await (run_in_threadpool(lambda: _described(data)) if data.get("choices") else read(lambda: _described(data), data))
    except InputError as error:
        return JSONResponse(refusals.told(error))
    return JSONResponse({**more, **answer})


def _described(data: dict[str, Any]) -> dict[str, Any]:
    """Return the answer to a description; InputError with all that is wrong with it, and with the resolution that may go with it."""
    given, system = data.get("resolution"), None
    problems: list[InputError] = []
    try:
        system = descriptions.system_of(data)
    except InputError as error:
        problems = [error, *error.also]
    problems += limits.wrong_with(given, system)
    if system is None or problems:
        first, *others = problems
        raise InputError(first.where, first.problem, first.remedy, tuple(others))
    if given is None:
        return descriptions.told(system)
    settings = limits.settings_of(given, live=False, system=system)
    with refusals.readable("system"):
        limits.check_cost(system, settings, live=False)
        costs = {"full": limits.cost_of(system, settings)}
        if isinstance(data.get("preview"), dict):
            costs["preview"] = limits.cost_of(system, limits.settings_of(data["preview"], live=True, system=system))
        if data.get("choices") is True:
            costs |= limits.choices_of(system, settings)
    return {
        **descriptions.told(system, settings.dimensions),
        "costs": costs,
        "resolution": {name: value for name, value in limits.table_of(settings).items() if not isinstance(given, dict) or name in given},
    }


def wanted(data: dict[str, Any], *, live: bool) -> tuple[System, Settings]:
    """Return system and settings of a request; InputError when they are not allowed."""
    system = descriptions.system_of(data)
    settings = limits.settings_of(data.get("resolution", "preview"), live=live, system=system)
    with refusals.readable("system"):
        limits.check_cost(system, settings, live=live)
    return system, settings


async def solve(request: Request) -> Response:
    """Answer with the curves of a system, or 204 when a newer revision has come."""
    studio, data = studio_of(request), await bodies.read_table(request)
    client, name = bodies.name_of(data, "client"), bodies.name_of(data, "slot")
    revision, parts = bodies.whole_of(data, "revision", 0, MOST_REVISION), _parts(data)
    slot = studio.slot(client, name)
    if revision < slot.revision:
        return Response(status_code=204)
    slot.revision = revision
    try:
        pair = await read(lambda: wanted(data, live=True), data)
        if revision < slot.revision:
            return Response(status_code=204)
        run = studio.run_of(*pair)
        kept_as = run.name if all(parts) else (run.name, *parts)
        content = studio.curves.get(run.name) or studio.curves.get(kept_as)
        if content is None:
            # What still waits for this slot gives way; what runs already is finished, so that a slider that never rests is answered.
            slot.work = work = studio.workers.submit(worker.solve, *run.pair, *parts, place=run.place, instead_of=slot.work)
            content = await work.future
            studio.curves.put(kept_as, content)
    except InputError as error:
        return JSONResponse(refusals.told(error))
    except asyncio.CancelledError:
        task = asyncio.current_task()
        if task is not None and task.cancelling():
            raise  # the request itself, not the work for it
        return Response(status_code=204)
    if revision < slot.answered:
        return Response(status_code=204)
    slot.answered = revision
    return arrays.answer(content, client=client, slot=name, revision=revision, run=run.name)


def _parts(data: dict[str, Any]) -> tuple[bool, bool]:
    """Return whether velocities and accelerations, and bars, are wanted together with the other curves."""
    return bodies.one_of(data, "histories", HISTORIES, "all") == "all", bodies.one_of(data, "bars", BARS, "now") == "now"


async def run(request: Request) -> Response:
    """Answer with the curves of a run."""
    studio = studio_of(request)
    found = studio.run(request.path_params["run"])
    return await of_run(found, studio.curves_of(found))


async def of_run(run: Run, content: Any) -> Response:
    """Return what a worker makes of a run, or why it cannot."""
    try:
        return arrays.answer(await content, run=run.name)
    except InputError as error:
        raise RefusedError.of(error) from None


async def bars(request: Request) -> Response:
    """Answer with the peaks of a run, which a slider's curves do not wait for."""
    return await _told(request, worker.bars, "bars")


async def judgement(request: Request) -> Response:
    """Answer with the estimated errors and the warnings of a run, which its curves do not wait for.

    In three dimensions they take seconds, as the run did: the worker that has it makes them when it is through with the one before.
    """
    return await _told(request, worker.judge)


async def _told(request: Request, task: Callable[..., Any], name: str | None = None) -> Response:
    """Answer with what a worker tells of a run: a table, or what stands under a name."""
    studio = studio_of(request)
    found = studio.run(request.path_params["run"])
    try:
        told = await studio.workers.submit(task, *found.pair, place=found.place, live=found.settings.dimensions == 2).future
    except InputError as error:
        raise RefusedError.of(error) from None
    return JSONResponse({"run": found.name, **(told if name is None else {name: told})})


FIELD_INSTEAD = "use two dimensions here, or response.pressure(...) of a run in Python"
ENERGY_INSTEAD = "start a job of the kind energy, which tells how far it is"


def refuse_space(run: Run, what: str, remedy: str) -> None:
    """Refuse what is not shown of a run in three dimensions."""
    try:
        limits.require_plane(run.settings, what, remedy)
    except InputError as error:
        raise RefusedError.of(error) from None


async def energy(request: Request) -> Response:
    """Answer with the energy balance of a run."""
    from coaxshell.apps.studio import fields

    studio = studio_of(request)
    found = studio.run(request.path_params["run"])
    every = bodies.whole_of(dict(request.query_params), "every", 1, limits.STEPS, 10)
    refuse_space(found, "the energy", ENERGY_INSTEAD)
    return await of_run(found, studio.workers.submit(fields.energy, *found.pair, every, place=found.place, live=False).future)


async def costs(request: Request) -> Response:
    """Answer with what the wave and the energy of a run in three dimensions cost, before they are begun."""
    from coaxshell.apps.studio import cut_films

    studio, query = studio_of(request), dict(request.query_params)
    found = studio.run(request.path_params["run"])
    every, size = bodies.whole_of(query, "every", 1, limits.STEPS, 8), bodies.whole_of(query, "size", 32, 320, 200)
    half_width = bodies.number_of(query, "half_width", 0.5, 10.0, 3.0)
    if found.settings.dimensions != 3:
        raise RefusedError(422, "input", "run", "is of two dimensions, where they take seconds", "ask for them")
    work = studio.workers.submit(cut_films.costs, *found.pair, every, size, half_width, place=found.place)
    try:
        return JSONResponse({"run": found.name, **await work.future})
    except InputError as error:
        raise RefusedError.of(error) from None


async def point(request: Request) -> Response:
    """Answer with the pressure history at a point."""
    from coaxshell.apps.studio import fields

    studio = studio_of(request)
    found = studio.run(request.path_params["run"])
    query = dict(request.query_params)
    x, y = (bodies.number_of(query, name, -20.0, 20.0) for name in ("x", "y"))
    refuse_space(found, "the pressure", FIELD_INSTEAD)
    return await of_run(found, studio.workers.submit(fields.point, *found.pair, x, y, place=found.place, live=False).future)


async def link(request: Request) -> Response:
    """Answer with the fragment of a link that holds a description, and how many samples of it this server keeps until it ends."""
    studio, data = studio_of(request), await bodies.read_table(request)
    unknown = [name for name in data if name not in links.ENTRIES]
    if unknown or data.get("v") != links.VERSION:
        raise bodies.bad(unknown[0] if unknown else "v", data.get("v"), f"give {', '.join(links.ENTRIES)}, with v = {links.VERSION}")

    def made() -> dict[str, Any]:
        short, samples = studio.records.shortened(data)
        return {"fragment": links.fragment(short), "samples_kept": samples}

    return JSONResponse(await run_in_threadpool(made))


async def open_link(request: Request) -> Response:
    """Answer with the description in a link, checked as any other."""
    studio, data = studio_of(request), await bodies.read_table(request)
    try:
        content = await run_in_threadpool(lambda: studio.records.restored(links.opened(data.get("fragment"))))
    except InputError as error:
        return JSONResponse(refusals.told(error))
    return await conversation(content, resolution=content.get("resolution"), view=content.get("view"))


async def upload(request: Request) -> Response:
    """Answer with the description in an uploaded file."""
    studio = studio_of(request)
    kind = request.headers.get("content-type", "").split(";")[0].strip().lower()
    if kind == "application/toml":
        try:
            return await conversation({"toml": (await bodies.read_body(request)).decode("utf-8")})
        except UnicodeDecodeError:
            return JSONResponse(refusals.told(InputError("file", "is not text in UTF-8", "give a TOML file")))
    if kind != "application/x-netcdf":
        raise RefusedError(415, "wrong-type", "Content-Type", "is neither TOML nor NetCDF", "send application/toml or application/x-netcdf")
    path = studio.file("nc")
    try:
        await run_in_threadpool(path.write_bytes, await bodies.read_body(request, limits.UPLOAD_BYTES))
        text, settings = await studio.workers.submit(described, path).future
    except InputError as error:
        return JSONResponse(refusals.told(error))
    finally:
        path.unlink(missing_ok=True)
    resolution = {name: value for name in limits.ENTRIES if _finite(value := settings.get(name)) or (name == "stations" and value)}
    return await conversation({"toml": text}, resolution=resolution)


def _finite(value: object) -> bool:
    return isinstance(value, int | float) and math.isfinite(value)


def routes() -> list[BaseRoute]:
    """Return these routes."""
    return [
        Route("/api/schema", schema),
        Route("/api/validate", validate, methods=["POST"]),
        Route("/api/solve", solve, methods=["POST"]),
        Route("/api/link", link, methods=["POST"]),
        Route("/api/link/open", open_link, methods=["POST"]),
        Route("/api/upload", upload, methods=["POST"]),
        Route("/api/runs/{run}", run),
        Route("/api/runs/{run}/bars", bars),
        Route("/api/runs/{run}/judgement", judgement),
        Route("/api/runs/{run}/energy", energy),
        Route("/api/runs/{run}/costs", costs),
        Route("/api/runs/{run}/point", point),
    ]
