"""Read a measured pressure record from the bytes of a file, or from pandas, xarray and numpy objects."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from coaxshell.errors import InputError
from coaxshell.limits import RECORD_BYTES, RECORD_COLUMNS, Limit
from coaxshell.model.naming import suggestion
from coaxshell.model.records.binary_tables import mat_table, wav_table
from coaxshell.model.records.choosing import READING, choose
from coaxshell.model.records.columns import Table
from coaxshell.model.records.text_tables import text_table
from coaxshell.numerics.reading import regular_bytes

CONDITIONING = ("scale", "offset", "baseline", "start", "end", "shift", "resample", "taper", "reference")
OPTIONS = (*READING, *CONDITIONING, "sha256")
"""All entries that may stand beside ``file``."""

_FOREIGN = {
    b"\x89HDF": "is an HDF5 file (MATLAB 7.3 writes these)",
    b"PK\x03\x04": "is a spreadsheet or an archive",
    b"\xd0\xcf\x11\xe0": "is a spreadsheet",
    b"\x1f\x8b": "is compressed",
    b"%PDF": "is a PDF file",
    b"\x93NUM": "is a numpy file",
    b"\x89PNG": "is a picture",
}


def of_file(path: str | Path, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the entries of the record in a regular file; see :func:`of_bytes`."""
    return of_bytes(regular_bytes(Path(path), RECORD_BYTES, "give the path of a record: CSV, .mat or .wav"), str(path), options)


def of_bytes(content: bytes, name: str, options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the entries of :class:`coaxshell.Sampled` for the record in the bytes of a file.

    Parameters
    ----------
    content : bytes
        Text of any common dialect, a MATLAB file up to version 7, or a sound file.
    name : str
        What errors and the record's reference call it.
    options : mapping
        Any of :data:`OPTIONS`: ``time_column``, ``pressure_column`` (name or number from 1 on), ``time_unit``, ``pressure_unit``,
        ``interval`` (without a column of times), ``sha256`` of the bytes, and the entries of :class:`coaxshell.Sampled`.

    Raises
    ------
    InputError
        Naming the file, the line or the option.
    """
    RECORD_BYTES.check(len(content), name)
    given = checked_options(options)
    _verify(content, given.pop("sha256", None), name)
    return _entries(table_of(content, name), given, name)


def of_data(data: Any, options: Mapping[str, Any], name: str = "data") -> dict[str, Any]:
    """Return the entries of the record in a pandas Series or DataFrame, an xarray DataArray or Dataset, or an array of two columns."""
    from coaxshell.model.records.objects import object_table

    given = checked_options(options)
    if "sha256" in given:
        raise InputError("sha256", "belongs to a file", "leave it out")
    return _entries(object_table(data, name), given, name)


def checked_options(options: Mapping[str, Any]) -> dict[str, Any]:
    """Return the options of a record that are set; InputError for one that is none."""
    for key in options:
        if key not in OPTIONS:
            raise InputError(str(key)[:80], "is not an entry beside the file of a record", suggestion(str(key), OPTIONS))
    return {key: value for key, value in options.items() if value is not None}


def table_of(content: bytes, name: str, most: Limit = RECORD_COLUMNS) -> Table:
    """Return the columns of a file by what it holds, whatever it is called; of a text, at most so many."""
    if content[:4] in (b"RIFF", b"RIFX", b"RF64") and content[8:12] == b"WAVE":
        return wav_table(content, name)
    if content[:10] == b"MATLAB 5.0":
        return mat_table(content, name)
    for mark, kind in _FOREIGN.items():
        if content.startswith(mark):
            raise InputError(name, kind, "give it as CSV text, a MATLAB file up to version 7 (save with -v7), or .wav")
    return text_table(content, name, most)


def _entries(table: Table, given: dict[str, Any], name: str) -> dict[str, Any]:
    if table.full_scale and "scale" not in given:
        raise InputError("scale", f"is missing: {name} holds shares of a full scale, not pressures", "give the pressure at full scale (Pa)")
    chosen = choose(table, given, name)
    rest = {key: value for key, value in given.items() if key not in READING}
    return {"reference": f"{Path(name).name}: {chosen.account}", **rest, "time": chosen.time, "pressure": chosen.values}


def _verify(content: bytes, wanted: Any, name: str) -> None:
    if wanted is None:
        return
    found = hashlib.sha256(content).hexdigest()
    if not isinstance(wanted, str) or wanted.lower() != found:
        raise InputError(
            f"{name}, sha256",
            f"the file is not the one that was described: its SHA-256 is {found}",
            "find the right file, or correct sha256",
        )
