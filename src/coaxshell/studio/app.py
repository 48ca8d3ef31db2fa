"""The application: routes behind the guard."""

from __future__ import annotations

from starlette.applications import Starlette
from starlette.types import ASGIApp

from coaxshell.studio import statics
from coaxshell.studio.guard import Guard


def create_app(port: int) -> ASGIApp:
    """Return the ASGI application of a server that listens on a port of 127.0.0.1."""
    return Guard(Starlette(routes=statics.routes()), hosts=(f"127.0.0.1:{port}", f"localhost:{port}"))
