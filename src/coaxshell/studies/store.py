"""Folders that keep finished work: safe to kill at any moment, safe for several writers.

One file a piece, named by the hash of all that its numbers depend on, written to a temporary name and renamed. In the folder of a
study ``study.json`` says whose cases they are; failed cases lie beside the others as ``HASH.failed.json``.
"""

from __future__ import annotations

import hashlib
import json
import os
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model.system import System
from coaxshell.numerics.files import reason, replacing, write_text
from coaxshell.numerics.identity import origin
from coaxshell.numerics.scratch import reclaim, scratch
from coaxshell.solver.settings import Settings
from coaxshell.studies.evaluation import Outcome, failure
from coaxshell.studies.metrics import Metric

MANIFEST = "study.json"
FORMAT_VERSION = 1
Array = npt.NDArray[Any]


def digest(data: Any) -> str:
    """Return the hash of plain data, the same for the same numbers on any machine."""
    text = json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


class Store:
    """Pieces of finished work in a folder: arrays by name, and a table of plain values each.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    where : str
        What errors call it.

    Raises
    ------
    InputError
        The folder cannot be written to.
    """

    def __init__(self, folder: Path, where: str = "store") -> None:
        self.folder, self._where = Path(folder), where
        try:
            self._open()
        except OSError as error:
            problem = f"{str(self.folder)!r} cannot be used ({reason(error)})"
            raise InputError(where, problem, "give a folder that you may write to") from None

    def _open(self) -> None:
        self.folder.mkdir(parents=True, exist_ok=True)
        reclaim(self.folder)

    def get(self, key: str) -> tuple[dict[str, Array], dict[str, Any]] | None:
        """Return the arrays and the values of a piece; None if it is not there or cannot be read."""
        values = _read(self.folder / f"{key}.json")
        if values is not None:
            return {}, values
        try:
            with (self.folder / f"{key}.npz").open("rb") as file, np.load(file) as stored:
                arrays = {name: stored[name] for name in stored.files if name != "values"}
                return arrays, json.loads(str(stored["values"]))
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
            return None

    def put(self, key: str, arrays: Mapping[str, Array], values: Mapping[str, Any]) -> None:
        """Keep a piece; InputError if there is no room. Cut short by a power cut, it counts as not there."""
        if not arrays:
            write_text(self.folder / f"{key}.json", json.dumps(values), self._where, durable=False)
            return
        with replacing(self.folder / f"{key}.npz", self._where, durable=False) as made:
            np.savez(made, allow_pickle=False, values=np.array(json.dumps(values)), **arrays)

    def __contains__(self, key: str) -> bool:
        return any((self.folder / f"{key}{suffix}").is_file() for suffix in (".json", ".npz"))


class StudyStore(Store):
    """The cases of one study in a folder, or the blocks of one run in three dimensions.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    study : mapping
        Plain data that tell one study from another, by parts ("scenario", "over", ...): a difference is told by the part's name.
    metrics : sequence of Metric
        Their values are what is kept of cases, in this order.
    resume : bool
        Whether the folder may already hold this study.
    where : str
        What errors call it.

    Raises
    ------
    InputError
        The folder cannot be written to, holds something else, another study, or this one though *resume* is false.
    """

    def __init__(
        self, folder: Path, study: Mapping[str, Any], metrics: Sequence[Metric], *, resume: bool = False, where: str = "store"
    ) -> None:
        self.metrics, self._resume = tuple(metrics), resume
        parts = {key: digest(part) for key, part in study.items()}
        self._manifest: dict[str, Any] = {"format": FORMAT_VERSION, "numerics": origin(), "study": parts, "description": dict(study)}
        super().__init__(folder, where)

    def _open(self) -> None:
        path = self.folder / MANIFEST
        if self.folder.is_dir() and not path.is_file() and any(not name.name.startswith(".") for name in self.folder.iterdir()):
            raise InputError(self._where, f"{str(self.folder)!r} holds something else than a study", "give an empty or a new folder")
        super()._open()
        if path.is_file():
            self._same(_read(path))
            if not self._resume:
                kept = sum(1 for _ in self.folder.glob("*.json")) - 1
                blocks = sum(1 for _ in self.folder.glob("*.npz"))
                what = f"{blocks} blocks of this run" if blocks else f"{kept} cases of this study"
                remedy = "use resume (--resume) to go on with it, or remove it"
                raise InputError(self._where, f"{str(self.folder)!r} already holds {what}", remedy)
            return
        with scratch(self.folder, sweep=False) as place:
            made = place / MANIFEST
            made.write_text(json.dumps(self._manifest, indent=1), encoding="utf-8")
            try:
                os.link(made, path)  # fails if another writer was first, where a rename would not
            except FileExistsError:
                self._same(_read(path))

    def _same(self, found: dict[str, Any] | None) -> None:
        name, another, ours = str(self.folder), "give another folder, or remove this one", self._manifest
        if found is None or "study" not in found:
            raise InputError(self._where, f"{name!r} has a damaged {MANIFEST}", another)
        if found.get("format") != FORMAT_VERSION or found.get("numerics") != ours["numerics"]:
            theirs = found.get("numerics", "another version")
            raise InputError(self._where, f"{name!r} was made by coaxshell {theirs}; this is {ours['numerics']}", another)
        theirs, mine = found["study"], ours["study"]
        differ = [key for key in {**theirs, **mine} if theirs.get(key) != mine.get(key)]
        if differ:
            raise InputError(self._where, f"{name!r} holds another study: its {' and '.join(differ)} differ", another)

    def key(self, system: System, resolution: Settings) -> str:
        """Return the name under which a case is kept: the hash of its physics, metrics, resolution and the code of all of them."""
        asked = {metric.name: metric.identity for metric in self.metrics}
        return digest({"system": system.canonical(), "metrics": asked, "resolution": resolution.arguments(), "numerics": origin()})

    def load(self, key: str) -> Outcome | None:
        """Return the outcome of a case, None if it is not there. Accidents count as not there: they are tried again."""
        _, data = self.get(key) or ({}, {})
        if set(data.get("values", ())) == {metric.name for metric in self.metrics}:
            values = tuple(float(data["values"][metric.name]) for metric in self.metrics)
            return Outcome(values, warnings=tuple(data.get("warnings", ())), seconds=float(data.get("seconds", 0.0)))
        _, failed = self.get(f"{key}.failed") or ({}, {})
        if failed.get("expected"):
            return failure(self.metrics, str(failed["reason"]), seconds=float(failed.get("seconds", 0.0)))
        return None

    def save(self, key: str, outcome: Outcome) -> None:
        """Keep the outcome of a case; InputError if there is no room."""
        data: dict[str, Any] = {"seconds": outcome.seconds}
        if outcome.failed:
            self.put(f"{key}.failed", {}, data | {"reason": outcome.reason, "expected": outcome.expected})
            return
        named = {metric.name: value for metric, value in zip(self.metrics, outcome.values, strict=True)}
        self.put(key, {}, data | {"values": named, "warnings": list(outcome.warnings)})
        (self.folder / f"{key}.failed.json").unlink(missing_ok=True)  # an accident that has been made good


def _read(path: Path) -> dict[str, Any] | None:
    """Return the table of a JSON file; None if it is not there or cut short (after a power cut a new file may be empty)."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
    return data if isinstance(data, dict) else None
