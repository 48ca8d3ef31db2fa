"""Records in scenario files, without loss: a few samples as lists, many as one text or in a file of their own beside, with a checksum."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.naming import suggestion
from coaxshell.model.records.binary_text import digest, packed, unpacked
from coaxshell.model.records.reader import CONDITIONING
from coaxshell.model.records.sampled import Sampled
from coaxshell.numerics.files import replacing

LISTED = 1000
"""Samples up to which they are written as lists of numbers that a person can read."""


def options_of(record: Sampled) -> dict[str, Any]:
    """Return the entries of a record, other than its samples, that differ from their defaults."""
    return {name: value for name in CONDITIONING if (value := getattr(record, name)) != record.default_of(name)}


def table(record: Sampled, file: str = "", checksum: str = "") -> dict[str, Any]:
    """Return a record as the table of a TOML text: lists, one text, or the name and checksum of a file that holds its samples."""
    time, pressure = np.asarray(record.time), np.asarray(record.pressure)
    if file:
        samples: dict[str, Any] = {"file": file, "sha256": checksum}
    elif len(time) <= LISTED:
        samples = {"time": record.time.tolist(), "pressure": record.pressure.tolist()}
    else:
        samples = {"samples": packed(time, pressure), "sha256": digest(time, pressure)}
    return {"type": "sampled", **options_of(record), **samples}


def write(record: Sampled, beside: Path) -> tuple[str, str] | tuple[()]:
    """Write a long record to a file of its own beside a TOML file; return its name and checksum, nothing for a short one.

    Its name holds the checksum: a file of that name is this one.
    """
    if len(record.time) <= LISTED:
        return ()
    content = csv_text(record)
    total = hashlib.sha256(content).hexdigest()
    name = f"{beside.stem}-record-{total[:12]}.csv"
    with replacing(beside.parent / name) as partial:
        partial.write_bytes(content)
    return name, total


def csv_text(record: Sampled) -> bytes:
    """Return the samples of a record as CSV from which the very same numbers are read."""
    rows = map("%r,%r".__mod__, zip(record.time.tolist(), record.pressure.tolist(), strict=True))
    return ("time (s),pressure (Pa)\n" + "\n".join(rows) + "\n").encode()


def from_text(samples: Any, options: Mapping[str, Any]) -> Sampled:
    """Return the record whose samples are one text, and its other entries *options*; InputError if it is damaged."""
    allowed = (*CONDITIONING, "sha256")
    for key in options:
        if key not in allowed:
            raise InputError(str(key)[:80], "is not an entry beside the samples of a record", suggestion(str(key), allowed))
    if not isinstance(samples, str):
        raise InputError("samples", f"{shown(samples)} is no packed record", "give the text that was written, or time and pressure")
    try:
        time, pressure = unpacked(samples)
    except InputError as error:
        raise InputError("samples", error.problem, error.remedy) from None
    wanted = options.get("sha256")
    if wanted is not None and wanted != digest(time, pressure):
        raise InputError("sha256", "is not that of the samples", "the text was changed: write it again")
    return Sampled(time=time, pressure=pressure, **{key: value for key, value in options.items() if key != "sha256"})
