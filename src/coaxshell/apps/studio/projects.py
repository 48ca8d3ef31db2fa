"""Named designs, kept together in one project file: TOML with a table for each, written as scenarios and resolutions are."""

from __future__ import annotations

from typing import Any

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Route

from coaxshell.apps.studio import bodies, limits, refusals
from coaxshell.apps.studio.descriptions import normalised, system_from
from coaxshell.apps.studio.routes import studio_of
from coaxshell.errors import InputError
from coaxshell.model import System
from coaxshell.model.base import shown
from coaxshell.model.paths import within
from coaxshell.model.toml import resolved, tables
from coaxshell.model.toml_text import parsed
from coaxshell.solver.settings import Settings

VERSION = 1
_HEAD = """\
# Designs of coaxshell studio: open this file there. The tables below "system" are what a scenario of coaxshell run holds,
# and "resolution" has its settings.
"""
Design = tuple[str, System, Settings]


def text_of(designs: list[Design]) -> str:
    """Return the text of a project file that :func:`designs_in` reads."""
    import tomli_w

    each = [{"name": name, "resolution": limits.table_of(settings), "system": tables(system)} for name, system, settings in designs]
    return _HEAD + tomli_w.dumps({"version": VERSION, "designs": each})


def designs_in(text: str) -> list[Design]:
    """Return the designs of a project file; InputError when it is none, or a design of it is not allowed here."""
    data = parsed(text, "project")
    if data.get("version") != VERSION:
        raise InputError("version", f"{shown(data.get('version'))} is not allowed", f"must be {VERSION}: the version of project files")
    listed = data.get("designs")
    for entry in listed if isinstance(listed, list) else ():
        if isinstance(entry, dict) and isinstance(entry.get("system"), dict):
            entry["system"] = resolved(entry["system"])
    return checked(listed)


def checked(listed: object) -> list[Design]:
    """Return designs given as tables of name, system and resolution; InputError naming the first that is not allowed."""
    if not isinstance(listed, list) or not listed:
        raise InputError("designs", "are missing" if listed is None else f"{shown(listed)} are not designs", "give a list of tables")
    if len(listed) > limits.DESIGNS:
        raise InputError("designs", f"{len(listed):,} designs are too many here", f"at most {limits.DESIGNS}")
    return [_checked(number, entry) for number, entry in enumerate(listed)]


def _checked(number: int, entry: object) -> Design:
    where = f"designs[{number}]"
    if not isinstance(entry, dict):
        raise InputError(where, f"{shown(entry)} is not a design", "give a table of name, system and resolution")
    name = entry.get("name")
    if not isinstance(name, str) or not name.strip() or len(name) > limits.TEXT or not name.isprintable():
        raise InputError(f"{where}.name", f"{shown(name)} is not a name", f"give 1 to {limits.TEXT} letters")
    try:
        system = system_from(entry.get("system"))
        return name, system, limits.settings_of(entry.get("resolution", {}), live=False, system=system)
    except InputError as error:
        inner = within("system", error) if not error.where.startswith(("resolution", "system")) else error
        raise within(where, inner) from None


def _told(designs: list[Design]) -> dict[str, Any]:
    each = [{"name": name, "system": normalised(system), "resolution": limits.table_of(settings)} for name, system, settings in designs]
    return {"ok": True, "designs": each}


async def write(request: Request) -> Response:
    """Answer with the text of the project file of some designs."""
    studio_of(request)
    data = await bodies.read_table(request, limits.PROJECT_BYTES)
    return await _answer(lambda: {"ok": True, "toml": text_of(checked(data.get("designs")))})


async def open_file(request: Request) -> Response:
    """Answer with the designs in the text of a project file."""
    studio_of(request)
    data = await bodies.read_table(request, limits.PROJECT_BYTES)
    text = data.get("toml")
    if not isinstance(text, str):
        raise bodies.bad("toml", text, "give the text of a project file")
    return await _answer(lambda: _told(designs_in(text)))


async def _answer(work: Any) -> Response:
    def carried_out() -> dict[str, Any]:
        with refusals.readable("designs"):
            return dict(work())

    try:
        return JSONResponse(await run_in_threadpool(carried_out))
    except InputError as error:
        return JSONResponse(refusals.told(error))


def routes() -> list[BaseRoute]:
    """Return these routes."""
    return [Route("/api/project", write, methods=["POST"]), Route("/api/project/open", open_file, methods=["POST"])]
