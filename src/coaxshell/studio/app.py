"""The application: routes behind the guard, and the state that lives as long as the server."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from anyio import to_thread
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import Request
from starlette.responses import Response

from coaxshell.studio import job_routes, refusals, routes, statics, study_routes
from coaxshell.studio.guard import Guard
from coaxshell.studio.refusals import RefusedError
from coaxshell.studio.state import Studio


def create_app(port: int) -> Guard:
    """Return the ASGI application of a server that listens on a port of 127.0.0.1."""
    application = Starlette(
        routes=[*statics.routes(), *routes.routes(), *job_routes.routes(), *study_routes.routes()],
        lifespan=_alive,
        exception_handlers={RefusedError: _refused, HTTPException: _plain},
    )
    return Guard(application, hosts=(f"127.0.0.1:{port}", f"localhost:{port}"))


@asynccontextmanager
async def _alive(app: Starlette) -> AsyncIterator[None]:
    # Descriptions are read in threads; more of them at once would only take the event loop's turns.
    to_thread.current_default_thread_limiter().total_tokens = 4
    app.state.studio = studio = Studio()
    try:
        yield
    finally:
        studio.close()


async def _refused(request: Request, error: Exception) -> Response:
    assert isinstance(error, RefusedError)
    return error.response


async def _plain(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    if error.status_code == 405:
        method = RefusedError(405, "method-not-allowed", "method", f"{request.method:.20} is not allowed here", "see docs/studio-api.md")
        return method.response
    return refusals.not_found(request.url.path[:120]).response
