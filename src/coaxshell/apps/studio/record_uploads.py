"""Pressure records that a page sends: read by a worker with the library's one reader, answered as a pulse that the form can hold."""

from __future__ import annotations

from pathlib import PurePath
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import BaseRoute, Route

from coaxshell.apps.studio import bodies, limits, refusals
from coaxshell.errors import InputError
from coaxshell.model import Sampled
from coaxshell.model.naming import suggestion
from coaxshell.model.records import reader, storing

CHOICES = tuple(name for name in reader.OPTIONS if name not in ("sha256", "reference"))
"""Entries of a record that a page may give with it."""


def understood(content: bytes, name: str, options: dict[str, str]) -> dict[str, Any]:
    """Return the pulse in the bytes of a file, or what is wrong, with the columns to choose from; no path is opened.

    A record of more samples than the studio takes is resampled to as many, which its reference says.
    """
    columns: list[str] = []
    try:
        table = reader.table_of(content, name)
        headings = [column.heading for column in table.columns]
        columns = [heading if heading and headings.count(heading) == 1 else str(k) for k, heading in enumerate(headings, start=1)]
        record = Sampled.from_bytes(content, name, **options)
    except InputError as error:
        return {**refusals.told(error), "columns": columns}
    if len(record.time) > limits.SAMPLES:
        time, pressure = record.curve
        record = type(record)(time=time, pressure=pressure, reference=record.reference)
    if len(record.time) > limits.SAMPLES:
        interval = float(record.time[-1] - record.time[0]) / (limits.SAMPLES - 1)
        time, pressure = record.replace(resample=interval).curve
        note = f"; {len(record.time):,} samples resampled to {len(time):,}, one every {interval:.4g} s"
        record = type(record)(time=time, pressure=pressure, reference=record.reference + note)
    listed = {"time": record.time.tolist(), "pressure": record.pressure.tolist()}
    return {"ok": True, "columns": columns, "pulse": {"type": "sampled", **storing.options_of(record), **listed}}


async def upload_record(request: Request) -> Response:
    """Answer with the pulse in a record that is the body; options of its reading and conditioning are the query."""
    from coaxshell.apps.studio.routes import studio_of

    studio = studio_of(request)
    if request.headers.get("content-type", "").split(";")[0].strip().lower() != "application/octet-stream":
        raise refusals.RefusedError(415, "wrong-type", "Content-Type", "is not that of a record", "send application/octet-stream")
    query = dict(request.query_params)
    name = PurePath(query.pop("name", "record").replace("\\", "/")).name[:80] or "record"
    for key, value in query.items():
        if key not in CHOICES:
            problem = InputError(key[:80], "is not an entry of a record", suggestion(key, CHOICES))
            return JSONResponse({**refusals.told(problem), "columns": []})
        if len(value) > limits.TEXT or not value.isprintable():
            raise bodies.bad(key, value, f"give a text of at most {limits.TEXT} letters")
    content = await bodies.read_body(request, limits.UPLOAD_BYTES)
    options = {key: value for key, value in query.items() if value}
    return JSONResponse(await studio.workers.submit(understood, content, name if name.isprintable() else "record", options).future)


def routes() -> list[BaseRoute]:
    """Return this route."""
    return [Route("/api/record", upload_record, methods=["POST"])]
