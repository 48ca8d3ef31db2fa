"""The files of the page, and plotly's own script out of its Python package."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

from starlette.requests import Request
from starlette.responses import FileResponse, Response
from starlette.routing import BaseRoute, Mount, Route
from starlette.staticfiles import StaticFiles

PAGE = Path(__file__).with_name("page")


def plotly_script() -> Path:
    """Return the file of plotly.js, without importing plotly (which takes a second)."""
    spec = find_spec("plotly")
    assert spec is not None  # the command looked for the extra before
    assert spec.origin is not None
    return Path(spec.origin).parent / "package_data" / "plotly.min.js"


async def index(request: Request) -> Response:
    """Answer with the page."""
    return FileResponse(PAGE / "index.html", headers={"Cache-Control": "no-cache"})


async def plotly(request: Request) -> Response:
    """Answer with plotly.js."""
    return FileResponse(plotly_script(), media_type="text/javascript", headers={"Cache-Control": "max-age=86400"})


def routes() -> list[BaseRoute]:
    """Return the routes of all files."""
    return [
        Route("/", index),
        Route("/vendor/plotly.min.js", plotly),
        Mount("/page", StaticFiles(directory=PAGE)),
    ]
