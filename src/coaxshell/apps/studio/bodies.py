"""Bodies of requests, read within bounds, and their entries, checked."""

from __future__ import annotations

import asyncio
import json
import math
from typing import Any, NoReturn

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request

from coaxshell.apps.studio import limits
from coaxshell.apps.studio.refusals import RefusedError

NAME_LENGTH = 64
LONG = 20_000
"""Bytes from which on a body is read beside the event loop."""
NO_BRACKETS = bytes(set(range(256)) - set(b"[]{}"))


async def read_body(request: Request, most: int = limits.BODY_BYTES) -> bytes:
    """Return the body; RefusedError as soon as it is longer than allowed."""
    announced = request.headers.get("content-length", "0")
    if announced.isdigit() and int(announced[:20]) > most:
        raise _too_large(most)
    parts, total = [], 0
    try:
        async with asyncio.timeout(limits.BODY_SECONDS):
            async for part in request.stream():
                total += len(part)
                if total > most:
                    raise _too_large(most)
                parts.append(part)
    except TimeoutError:
        raise RefusedError(408, "too-slow", "body", f"has not come within {limits.BODY_SECONDS:g} s", "send it again") from None
    return b"".join(parts)


async def read_table(request: Request, most: int = limits.BODY_BYTES) -> dict[str, Any]:
    """Return a JSON body, which must be an object; RefusedError otherwise."""
    if request.headers.get("content-type", "").split(";")[0].strip().lower() != "application/json":
        raise RefusedError(415, "wrong-type", "Content-Type", "is not JSON", "send application/json")
    body = await read_body(request, most)
    return await run_in_threadpool(parse_table, body) if len(body) > LONG else parse_table(body)


def parse_table(body: bytes) -> dict[str, Any]:
    """Return JSON text as a dict; RefusedError for anything that is not a JSON object of finite numbers and moderate depth."""
    try:
        if depth_of(body) > limits.NESTING:
            raise ValueError(f"nested deeper than {limits.NESTING} levels")
        data = json.loads(body.decode("utf-8"), parse_constant=_constant, parse_float=_finite)
        if b"\\u" in body:
            json.dumps(data, ensure_ascii=False).encode("utf-8")  # half a surrogate pair is no character: nothing could send it back
    except (ValueError, RecursionError) as error:
        raise RefusedError(400, "malformed", "body", f"is not JSON: {str(error)[:120]}", "send one JSON object in UTF-8") from None
    if not isinstance(data, dict):
        raise RefusedError(400, "malformed", "body", "is not a JSON object", "send one JSON object in UTF-8")
    return data


def depth_of(text: bytes) -> int:
    """Return an upper bound of the depth of nesting: the largest number of brackets open at once, those in texts counted too."""
    depth = most = 0
    for byte in text.translate(None, delete=NO_BRACKETS):
        depth += 1 if byte in b"[{" else -1
        most = max(most, depth)
        if most > limits.NESTING:
            break
    return most


def name_of(data: dict[str, Any], entry: str) -> str:
    """Return a short name such as a client's; RefusedError otherwise."""
    value = data.get(entry)
    if not isinstance(value, str) or not is_name(value):
        raise bad(entry, value, f"give 1 to {NAME_LENGTH} letters, digits, - or _")
    return value


def is_name(value: str) -> bool:
    """Tell whether a text is a short name."""
    return 0 < len(value) <= NAME_LENGTH and value.isascii() and value.replace("-", "a").replace("_", "a").isalnum()


def text_of(data: dict[str, Any], entry: str) -> str:
    """Return a short text for people, "" when left out; RefusedError otherwise."""
    value = data.get(entry, "")
    if not isinstance(value, str) or len(value) > limits.TEXT:
        raise bad(entry, value, f"give a text of at most {limits.TEXT} letters")
    return value


def whole_of(data: dict[str, Any], entry: str, least: int, most: int, default: int | None = None) -> int:
    """Return a whole number within bounds, also from a text of digits; RefusedError otherwise."""
    value = data.get(entry, default)
    if isinstance(value, str) and value.isascii() and value.isdigit() and len(value) < 18:
        value = int(value)
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
        raise bad(entry, value, f"give a whole number from {least} to {most}")
    return value


def number_of(data: dict[str, Any], entry: str, least: float, most: float, default: float | None = None) -> float:
    """Return a number within bounds, also from a text; RefusedError otherwise."""
    value = data.get(entry, default)
    try:
        number = float("nan") if isinstance(value, bool) or value is None else float(value)
    except (TypeError, ValueError, OverflowError):
        number = float("nan")
    if not least <= number <= most:
        raise bad(entry, value, f"give a number from {least:g} to {most:g}")
    return number


def one_of(data: dict[str, Any], entry: str, allowed: tuple[str, ...], default: str | None = None) -> str:
    """Return one of some texts; RefusedError otherwise."""
    value = data.get(entry, default)
    if not isinstance(value, str) or value not in allowed:
        raise bad(entry, value, f"must be one of {', '.join(allowed)}")
    return value


def bad(where: str, value: object, remedy: str) -> RefusedError:
    """Return the refusal of an entry."""
    return RefusedError(400, "bad-request", where, f"{value!r:.60} is not allowed" if value is not None else "is missing", remedy)


def _finite(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text:.20} is not a finite number")
    return number


def _constant(text: str) -> NoReturn:
    raise ValueError(f"{text} is not a finite number")


def _too_large(most: int) -> RefusedError:
    return RefusedError(413, "too-large", "body", "is too large", f"at most {most / 1e6:g} MB")
