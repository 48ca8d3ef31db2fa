"""The application: routes behind the guard, files of the page, and the state that lives as long as the server."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Collection
from contextlib import asynccontextmanager
from pathlib import Path

from anyio import to_thread
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, JSONResponse, Response
from starlette.routing import BaseRoute, Mount, Route
from starlette.staticfiles import StaticFiles

from coaxshell.apps.studio import job_routes, projects, record_uploads, refusals, routes, study_routes
from coaxshell.apps.studio.guard import NAMES, Guard
from coaxshell.apps.studio.refusals import RefusedError
from coaxshell.apps.studio.schema import schema
from coaxshell.apps.studio.state import Studio


def create_app(port: int, key: str, names: Collection[str] = ()) -> Guard:
    """Return the ASGI application of a server that listens on a port of 127.0.0.1.

    Parameters
    ----------
    port : int
    key : str
        What every request must carry.
    names : collection of str
        Names of hosts, beside those of this machine, under which it may be reached.
    """
    application = Starlette(
        routes=[*files(), *routes.routes(), *job_routes.routes(), *study_routes.routes(), *projects.routes(), *record_uploads.routes()],
        lifespan=_alive,
        exception_handlers={RefusedError: _refused, HTTPException: _plain, ClientDisconnect: _gone, Exception: _failed},
    )
    return Guard(application, port, key, (*NAMES, *names))


@asynccontextmanager
async def _alive(app: Starlette) -> AsyncIterator[None]:
    # Descriptions are read in threads; more of them at once would only take the event loop's turns.
    to_thread.current_default_thread_limiter().total_tokens = 4
    app.state.studio = studio = Studio()
    resting = asyncio.get_running_loop().create_task(studio.rest())
    # What every page asks for first is made while the browser starts.
    app.state.schema = asyncio.get_running_loop().create_task(run_in_threadpool(schema))
    try:
        yield
    finally:
        resting.cancel()
        studio.close()


async def _refused(request: Request, error: Exception) -> Response:
    assert isinstance(error, RefusedError)
    return error.response


async def _gone(request: Request, error: Exception) -> Response:
    return Response(status_code=408)  # to nobody


async def _failed(request: Request, error: Exception) -> Response:
    return JSONResponse(refusals.internal(request.url.path[:120]), 500)  # and it is raised again, for the guard to log


async def _plain(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    if error.status_code == 405:
        method = RefusedError(405, "method-not-allowed", "method", f"{request.method:.20} is not allowed here", "see docs/studio-api.md")
        return method.response
    return refusals.not_found(request.url.path[:120]).response


PAGE = Path(__file__).with_name("page")


PLOTLY = PAGE / "vendor" / "plotly-cartesian.min.js"
"""plotly.js as its authors publish it for charts on Cartesian axes, npm's plotly.js-cartesian-dist-min.

All of plotly.js, as the Python package of that name has it, is three times as large, and so is what a browser spends on reading it.
"""


async def index(request: Request) -> Response:
    """Answer with the page."""
    return FileResponse(PAGE / "index.html", headers={"Cache-Control": "no-cache"})


async def plotly(request: Request) -> Response:
    """Answer with plotly.js."""
    return FileResponse(PLOTLY, media_type="text/javascript", headers={"Cache-Control": "max-age=86400"})


def files() -> list[BaseRoute]:
    """Return the routes of the page's files, and of plotly's own script."""
    return [
        Route("/", index),
        Route("/vendor/plotly.min.js", plotly),
        Mount("/page", StaticFiles(directory=PAGE)),
    ]
