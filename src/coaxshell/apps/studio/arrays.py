"""Numbers in bulk as one body: length of the header, the header in JSON, the arrays (see docs/studio-api.md)."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from starlette.responses import Response

from coaxshell.numerics.finite import require_finite

MEDIA_TYPE = "application/x-coaxshell-arrays"


class Packed(NamedTuple):
    """A header, and the arrays that it lists as bytes."""

    header: dict[str, Any]
    data: bytes


class Item(NamedTuple):
    """An array with its unit, and what else its entry in the header says."""

    values: npt.NDArray[Any]
    unit: str
    more: Mapping[str, Any] = {}


def packed(header: Mapping[str, Any], items: Mapping[str, Item]) -> Packed:
    """Return header and arrays, floats of any size as float32 unless they are float16, each starting on a multiple of 8."""
    entries, parts, offset = [], [], 0
    for name, (values, unit, more) in items.items():
        kind = values.dtype if values.dtype in (np.dtype("uint8"), np.dtype("float16")) else np.dtype("float32")
        with np.errstate(over="ignore"):  # beyond single precision is infinity here, and refused on the next line
            array = np.ascontiguousarray(values, dtype=kind.newbyteorder("<"))
        require_finite(array, name, remedy="it is no number, or too large for the page: look for extreme entries")
        entries.append({"name": name, "dtype": kind.name, "shape": list(array.shape), "offset": offset, "unit": unit, **more})
        parts.append(array.tobytes() + bytes(-array.nbytes % 8))
        offset += len(parts[-1])
    return Packed({**header, "arrays": entries}, b"".join(parts))


def answer(content: Packed, **more: Any) -> Response:
    """Return the response with further entries of the header."""
    return Response(encoded(Packed({**content.header, **more}, content.data)), media_type=MEDIA_TYPE)


def encoded(content: Packed) -> bytes:
    """Return the body."""
    text = json.dumps(content.header, allow_nan=False).encode()
    text += b" " * (-(4 + len(text)) % 8)
    return len(text).to_bytes(4, "little") + text + content.data


def decoded(body: bytes) -> tuple[dict[str, Any], dict[str, npt.NDArray[Any]]]:
    """Return header and arrays of a body: what the page does, for programs in Python."""
    length = int.from_bytes(body[:4], "little")
    header = json.loads(body[4 : 4 + length])
    arrays = {}
    for entry in header["arrays"]:
        shape, dtype = tuple(entry["shape"]), np.dtype(entry["dtype"]).newbyteorder("<")
        arrays[entry["name"]] = np.frombuffer(body, dtype, int(np.prod(shape)), 4 + length + entry["offset"]).reshape(shape)
    return header, arrays
