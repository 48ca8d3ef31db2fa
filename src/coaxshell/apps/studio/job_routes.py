"""Jobs, their events and results, and files to take home."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Awaitable, Callable
from typing import TYPE_CHECKING, Any

from starlette.background import BackgroundTask
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import FileResponse, JSONResponse, Response, StreamingResponse
from starlette.routing import BaseRoute, Route

from coaxshell._version import __version__
from coaxshell.apps.studio import arrays, bodies, downloads, limits, refusals, study_routes, worker
from coaxshell.apps.studio.jobs import Job
from coaxshell.apps.studio.refusals import RefusedError
from coaxshell.apps.studio.routes import FIELD_INSTEAD, MOST_REVISION, refuse_space, studio_of, wanted
from coaxshell.apps.studio.state import Run, Studio
from coaxshell.errors import InputError

if TYPE_CHECKING:
    from coaxshell.studies.optimisation.optimum import Optimum

HEARTBEAT, THROTTLE = 15.0, 0.1


async def start(request: Request) -> Response:
    """Start a job."""
    studio, data = studio_of(request), await bodies.read_table(request)
    job = Job(bodies.name_of(data, "client"), bodies.one_of(data, "kind", tuple(_STARTS)), bodies.text_of(data, "title"))
    try:
        await _STARTS[job.kind](studio, job, data)
    except InputError as error:
        return JSONResponse(refusals.told(error))
    return JSONResponse({"job": job.told()}, 202)


async def _solve(studio: Studio, job: Job, data: dict[str, Any]) -> None:
    job.slot, job.revision = bodies.name_of(data, "slot"), bodies.whole_of(data, "revision", 0, MOST_REVISION)
    run = studio.run_of(*await run_in_threadpool(lambda: wanted({"resolution": "full", **data}, live=False)))
    job.run = run.name
    if any(
        other.kind == "solve" and other.slot == job.slot and (other.revision or 0) > job.revision for other in studio.jobs.of(job.client)
    ):
        raise RefusedError(409, "cancelled", "revision", f"{job.revision} is older than what was asked for since", "ask with a newer one")
    if studio.curves.get(run.name) is not None:
        studio.jobs.done(job)
        return
    studio.jobs.start(job, worker.solve, *run.pair, place=run.place)
    assert job.work is not None

    def keep(future: asyncio.Future[Any]) -> None:
        if not future.cancelled() and future.exception() is None:
            studio.curves.put(run.name, future.result())

    job.work.future.add_done_callback(keep)


async def _field(studio: Studio, job: Job, data: dict[str, Any]) -> None:
    from coaxshell.apps.studio import cut_films, fields

    run = studio.run(bodies.name_of(data, "run"))
    stations = run.settings.stations if run.settings.dimensions == 3 else ()
    plane = bodies.one_of(data, "plane", cut_films.PLANES if stations else ("across",), "across")
    number = bodies.whole_of(data, "station", 0, max(len(stations) - 1, 0), 0)
    every, size = bodies.whole_of(data, "every", 1, limits.STEPS, 8), bodies.whole_of(data, "size", 32, 320, 200)
    half_width = bodies.number_of(data, "half_width", 0.5, 10.0, 3.0)
    values = (run.settings.steps // every + 1) * size**2
    if values > limits.FIELD_VALUES:
        raise RefusedError(
            422, "limit", "every", f"{values:,} values are too many", f"at most {limits.FIELD_VALUES:,}: fewer frames or pixels"
        )
    job.run, job.file = run.name, studio.file("npy")
    if stations:
        cut = plane, float(stations[number])
        studio.jobs.start(job, cut_films.cut_film, *run.pair, *cut, every, size, half_width, job.file, place=run.place)
    else:
        studio.jobs.start(job, fields.film, *run.pair, every, size, half_width, job.file, place=run.place)


async def _energy(studio: Studio, job: Job, data: dict[str, Any]) -> None:
    from coaxshell.apps.studio import fields

    run = studio.run(bodies.name_of(data, "run"))
    job.run = run.name
    every = bodies.whole_of(data, "every", 1, limits.STEPS, 10)
    studio.jobs.start(job, fields.energy, *run.pair, every, place=run.place)


async def _unrolled(studio: Studio, job: Job, data: dict[str, Any]) -> None:
    from coaxshell.apps.studio import unrolled

    run = studio.run(bodies.name_of(data, "run"))
    shell, frames = bodies.whole_of(data, "shell", 0, limits.SHELLS - 1, 0), bodies.whole_of(data, "frames", 2, 200, 120)
    quantity = bodies.one_of(data, "quantity", tuple(unrolled.COMPONENTS), "stress")
    await run_in_threadpool(unrolled.require_flat, run.system, run.settings, shell)
    job.run = run.name
    studio.jobs.start(job, unrolled.unrolled, *run.pair, shell, quantity, frames, place=run.place)


async def _loops(studio: Studio, job: Job, data: dict[str, Any]) -> None:
    from coaxshell.apps.studio import panels

    run = studio.run(bodies.name_of(data, "run"))
    panels.require_controlled(run.system)
    job.run = run.name
    studio.jobs.start(job, panels.loops, *run.pair, place=run.place)


async def _spectra(studio: Studio, job: Job, data: dict[str, Any]) -> None:
    from coaxshell.apps.studio import panels

    run = studio.run(bodies.name_of(data, "run"))
    shell, quantity = bodies.whole_of(data, "shell", 0, limits.SHELLS - 1, 0), bodies.one_of(data, "quantity", panels.QUANTITIES, "stress")
    panels.require_stressed(run.system, shell)
    number = bodies.whole_of(data, "station", 0, limits.STATIONS - 1, 0)
    stations = run.settings.stations if run.settings.dimensions == 3 else (None,)
    if number >= len(stations):
        raise bodies.bad("station", number, f"give the number of one, below {len(stations)}")
    job.run = run.name
    studio.jobs.start(job, panels.spectra, *run.pair, shell, quantity, stations[number], place=run.place)


async def _stressed(studio: Studio, job: Job, data: dict[str, Any]) -> None:
    from coaxshell.apps.studio import panels

    run = studio.run(bodies.name_of(data, "run"))
    shell = bodies.whole_of(data, "shell", 0, limits.SHELLS - 1, 0)
    component = bodies.one_of(data, "component", panels.COMPONENTS, panels.COMPONENTS[0])
    panels.require_stressed(run.system, shell)
    job.run = run.name
    studio.jobs.start(job, panels.stressed, *run.pair, shell, component, place=run.place)


async def _film(studio: Studio, job: Job, data: dict[str, Any]) -> None:
    runs = _runs(studio, data.get("runs"))
    kind = bodies.one_of(data, "format", ("mp4", "webp"), "mp4")
    frames, size = bodies.whole_of(data, "frames", 2, 500, 120), bodies.whole_of(data, "size", 64, 480, 360)
    fps = bodies.number_of(data, "fps", 1.0, 60.0, 25.0)
    job.run, job.file, job.name = runs[0].name, studio.file(kind), runs[0].system.name
    pairs = [run.pair for run in runs]
    studio.jobs.start(job, downloads.movie, pairs, frames, fps, size, job.file, place=runs[0].place)


async def _report(studio: Studio, job: Job, data: dict[str, Any]) -> None:
    from coaxshell.apps.report import PARTS, parts_left

    runs, without = _runs(studio, data.get("runs"), 2), data.get("without", [])
    if not isinstance(without, list) or len(without) > len(PARTS) or not all(isinstance(part, str) for part in without):
        raise bodies.bad("without", without, f"give a list of {', '.join(PARTS)}")
    parts_left(without)
    job.run, job.file, job.name = runs[0].name, studio.file("html"), runs[0].system.name
    studio.jobs.start(job, downloads.report, [run.pair for run in runs], without, job.file, place=runs[0].place)


async def _sweep(studio: Studio, job: Job, data: dict[str, Any]) -> None:
    from coaxshell.apps.studio import sweeps

    study = await run_in_threadpool(study_routes.asked, "sweep", data)
    job.file, job.name = studio.file("nc"), study.system.name
    studio.jobs.start(job, sweeps.sweep, *study.arguments, job.file, place=worker.structure_key(study.system, study.settings))


async def _optimise(studio: Studio, job: Job, data: dict[str, Any]) -> None:
    from coaxshell.apps.studio import optimisations

    study = await run_in_threadpool(study_routes.asked, "optimise", data)
    job.name = study.system.name
    studio.jobs.start(job, optimisations.optimise, *study.arguments, place=worker.structure_key(study.system, study.settings))


_STARTS: dict[str, Callable[[Studio, Job, dict[str, Any]], Awaitable[None]]] = {
    "solve": _solve,
    "field": _field,
    "film": _film,
    "report": _report,
    "energy": _energy,
    "unrolled": _unrolled,
    "loops": _loops,
    "spectra": _spectra,
    "stressed": _stressed,
    "sweep": _sweep,
    "optimise": _optimise,
}


def _runs(studio: Studio, names: Any, most: int = 3) -> list[Run]:
    if not isinstance(names, list) or not 1 <= len(names) <= most or not all(isinstance(name, str) for name in names):
        raise bodies.bad("runs", names, f"give 1 to {most} names of runs")
    return [studio.run(name) for name in names]


async def jobs(request: Request) -> Response:
    """Answer with the jobs of a client."""
    client = bodies.name_of(dict(request.query_params), "client")
    return JSONResponse({"jobs": [job.told() for job in studio_of(request).jobs.of(client)]})


async def job(request: Request) -> Response:
    """Answer with one job, or cancel it."""
    studio = studio_of(request)
    found = studio.jobs.get(request.path_params["job"])
    if request.method == "DELETE":
        studio.jobs.cancel(found)
        return Response(status_code=204)
    return JSONResponse({"job": found.told()})


async def result(request: Request) -> Response:
    """Answer with what a job came to."""
    found = studio_of(request).jobs.finished(request.path_params["job"])
    if found.kind == "sweep":
        return JSONResponse({"kind": "sweep", **found.result})
    if found.kind == "optimise":
        from coaxshell.apps.studio import optimisations

        return JSONResponse({"kind": "optimise", **await run_in_threadpool(optimisations.told, found.result)})
    if found.kind in ("energy", "unrolled", "loops", "spectra", "stressed"):
        return arrays.answer(found.result, run=found.run)
    if found.kind != "field":
        raise RefusedError(404, "not-found", "result", f"a {found.kind} has none", "see /api/runs/{run} or /api/jobs/{id}/file")
    return JSONResponse({"run": found.run, **found.result[0], "most_values": limits.FRAME_VALUES})


async def design(request: Request) -> Response:
    """Answer with a design of an optimisation, as with a valid description."""
    from coaxshell.apps.studio import optimisations

    found = studio_of(request).jobs.finished(request.path_params["job"])
    if found.kind != "optimise":
        raise RefusedError(404, "not-found", "design", f"a {found.kind} has none", "start a job of the kind optimise")
    number = bodies.whole_of(request.path_params, "number", 0, len(found.result.optimum.history) - 1)
    try:
        return JSONResponse(await run_in_threadpool(optimisations.design, found.result, number))
    except InputError as error:
        return JSONResponse(refusals.told(error))


async def frames(request: Request) -> Response:
    """Answer with a slice of a field."""
    from coaxshell.apps.studio import fields

    found, query = studio_of(request).jobs.finished(request.path_params["job"]), dict(request.query_params)
    if found.kind != "field" or found.file is None:
        raise RefusedError(404, "not-found", "frames", f"a {found.kind} has none", "start a job of the kind field")
    (about, stresses), path = found.result, found.file
    begin, count = bodies.whole_of(query, "start", 0, about["frames"] - 1, 0), bodies.whole_of(query, "count", 1, limits.STEPS, 24)
    kind = bodies.one_of(query, "format", ("uint8", "float16"), "uint8")
    values = min(count, about["frames"] - begin) * about["size"] ** 2
    if values > limits.FRAME_VALUES:
        raise RefusedError(422, "limit", "count", f"{values:,} values are too many", f"at most {limits.FRAME_VALUES:,}")
    limit = bodies.number_of(query, "limit", 1e-30, 1e30, about["pressure_limit"]) if kind == "uint8" else None
    return arrays.answer(await run_in_threadpool(fields.frames_of, path, about, stresses, begin, count, limit))


async def job_file(request: Request) -> Response:
    """Answer with the film or the dataset of a job, or with the best system or the history of an optimisation."""
    found = studio_of(request).jobs.finished(request.path_params["job"])
    if found.kind == "optimise":
        kind = bodies.one_of(dict(request.query_params), "what", ("toml", "csv"), "toml")
        return await _written(found.result.optimum, kind, found.name)
    if found.kind not in ("film", "report", "sweep") or found.file is None:
        raise RefusedError(404, "not-found", "file", f"a {found.kind} has none", "start a job of the kind film")
    suffix = found.file.suffix[1:]
    return FileResponse(found.file, media_type=downloads.TYPES[suffix], filename=downloads.named(found.name, suffix, found.kind))


async def _written(optimum: Optimum, kind: str, of: str) -> Response:
    try:
        text = await run_in_threadpool(optimum.to_csv if kind == "csv" else lambda: optimum.system.to_toml_string())
    except InputError as error:
        raise RefusedError.of(error) from None
    name = downloads.named(of, kind, "designs" if kind == "csv" else "best")
    return Response(text, media_type=downloads.TYPES[kind], headers={"Content-Disposition": f'attachment; filename="{name}"'})


async def download(request: Request) -> Response:
    """Answer with a run as a file."""
    studio, suffix, query = studio_of(request), request.path_params["suffix"], request.query_params
    run, wanted_file = studio.run(request.path_params["run"]), request.path_params["what"]
    if (wanted_file, suffix) == ("download", "toml"):
        attached = {"Content-Disposition": f'attachment; filename="{downloads.named(run.system.name, suffix)}"'}
        return Response(run.system.to_toml_string(), media_type=downloads.TYPES["toml"], headers=attached)
    path = studio.file(suffix)
    if (wanted_file, suffix) in (("download", "nc"), ("download", "csv")):
        task = downloads.netcdf if suffix == "nc" else downloads.csv
        work = studio.workers.submit(task, run.pair, path, place=run.place)
    elif wanted_file == "figure" and suffix in ("png", "svg"):
        quantity = bodies.one_of(dict(query), "quantity", ("stress", "field"), "stress")
        time = bodies.number_of(dict(query), "time", 0.0, 1e6, 1.0)
        others = query.getlist("compare")
        runs = [run, *(_runs(studio, others) if others else [])]
        for one in runs if quantity == "field" else ():
            refuse_space(one, "the pressure", FIELD_INSTEAD)
        work = studio.workers.submit(downloads.figure, [one.pair for one in runs], quantity, time, path, place=run.place, live=False)
    else:
        raise refusals.not_found(f"{wanted_file}.{suffix}")
    try:
        await work.future
    except InputError as error:
        path.unlink(missing_ok=True)
        raise RefusedError.of(error) from None
    away = BackgroundTask(path.unlink, missing_ok=True)
    what = {"csv": "histories", "png": "stress", "svg": "stress"}.get(suffix, "")
    return FileResponse(path, media_type=downloads.TYPES[suffix], filename=downloads.named(run.system.name, suffix, what), background=away)


async def events(request: Request) -> Response:
    """Answer with a stream of what happens to the jobs of one client or several: all tabs of a browser share one."""
    clients = dict.fromkeys(request.query_params.getlist("client"))
    if not 0 < len(clients) <= limits.TABS or not all(map(bodies.is_name, clients)):
        raise bodies.bad("client", ", ".join(clients) or None, f"give 1 to {limits.TABS} names of clients")
    studio = studio_of(request)
    event = studio.jobs.watch(next(iter(clients)))
    for other in clients:
        studio.jobs.watch(other, event)

    async def stream() -> AsyncIterator[str]:
        seen: dict[str, int] = {}
        try:
            yield "retry: 1000\n" + _event("hello", {"version": __version__, "server": studio.id})
            while not studio.closing:
                event.clear()
                current = [job for client in clients for job in studio.jobs.of(client)]
                for one in current:
                    if seen.get(one.id) != one.version:
                        seen[one.id] = one.version
                        yield _event("job", one.told())
                seen = {one.id: seen[one.id] for one in current}
                await asyncio.sleep(THROTTLE)
                try:
                    await asyncio.wait_for(event.wait(), HEARTBEAT)
                except TimeoutError:
                    yield ": \n\n"
        finally:
            for client in clients:
                studio.jobs.unwatch(client, event)

    return StreamingResponse(stream(), media_type="text/event-stream")


def _event(name: str, data: dict[str, Any]) -> str:
    return f"event: {name}\ndata: {json.dumps(data, allow_nan=False)}\n\n"


def routes() -> list[BaseRoute]:
    """Return these routes."""
    return [
        Route("/api/jobs", start, methods=["POST"]),
        Route("/api/jobs", jobs),
        Route("/api/jobs/{job}", job, methods=["GET", "DELETE"]),
        Route("/api/jobs/{job}/result", result),
        Route("/api/jobs/{job}/designs/{number}", design),
        Route("/api/jobs/{job}/frames", frames),
        Route("/api/jobs/{job}/file", job_file),
        Route("/api/runs/{run}/{what:str}.{suffix:str}", download),
        Route("/api/events", events),
    ]
