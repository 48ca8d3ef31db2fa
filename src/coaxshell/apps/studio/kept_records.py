"""Long pressure records that links lead to: kept by checksum as long as the server runs, so that a link stays short."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from typing import Any

from coaxshell.apps.studio import limits
from coaxshell.errors import InputError
from coaxshell.numerics.cache import ByteBoundedCache

COLUMNS = ("time", "pressure")


class KeptRecords:
    """Records of sampled pulses by their checksum; the ones not used for longest are forgotten."""

    def __init__(self) -> None:
        self._kept: ByteBoundedCache[dict[str, Any]] = ByteBoundedCache(
            limits.RECORD_BYTES, lambda record: 32 * sum(len(record[name]) for name in COLUMNS)
        )

    def shortened(self, content: dict[str, Any]) -> tuple[dict[str, Any], int]:
        """Return what a link holds with checksums in the place of long records, which are kept, and how many samples those have."""
        samples = 0

        def short(pulse: dict[str, Any]) -> dict[str, Any]:
            nonlocal samples
            columns = [column for column in map(pulse.get, COLUMNS) if isinstance(column, list)]
            if len(columns) < len(COLUMNS) or not all(limits.LINKED_SAMPLES < len(column) <= limits.SAMPLES for column in columns):
                return pulse
            record = dict(zip(COLUMNS, columns, strict=True))
            name = hashlib.blake2b(json.dumps(record).encode(), digest_size=16).hexdigest()
            self._kept.put(name, record)
            samples += len(record["time"])
            return {**{key: value for key, value in pulse.items() if key not in COLUMNS}, "kept": name}

        return _changed(content, short), samples

    def restored(self, content: dict[str, Any]) -> dict[str, Any]:
        """Return what a link holds with the records in their places.

        Raises
        ------
        InputError
            A record is not kept here: the server has started anew, or is another one.
        """

        def whole(pulse: dict[str, Any]) -> dict[str, Any]:
            if "kept" not in pulse:
                return pulse
            record = self._kept.get(pulse["kept"]) if isinstance(pulse["kept"], str) else None
            if record is None:
                remedy = "open the scenario's file, or the record's, which hold it"
                raise InputError("link", "leads to a record that only the server it was made with had, while it ran", remedy)
            return {**{key: value for key, value in pulse.items() if key != "kept"}, **record}

        return _changed(content, whole)


def _changed(content: dict[str, Any], change: Callable[[dict[str, Any]], dict[str, Any]]) -> dict[str, Any]:
    """Return a link's content with each table that may be a pulse changed; the rest is not looked at."""
    system = content.get("system")
    if not isinstance(system, dict):
        return content
    source = system.get("source")
    if isinstance(source, list):
        return {**content, "system": {**system, "source": [_of_source(one, change) for one in source[: limits.SOURCES + 1]]}}
    return {**content, "system": {**system, "source": _of_source(source, change)}}


def _of_source(source: Any, change: Callable[[dict[str, Any]], dict[str, Any]]) -> Any:
    if not isinstance(source, dict) or not isinstance(source.get("pulse"), dict):
        return source
    return {**source, "pulse": change(source["pulse"])}
