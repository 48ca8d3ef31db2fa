"""A folder that keeps every finished case of a study: safe to kill at any moment, safe for several writers.

One file a case, named by the hash of all that its numbers depend on, written to a temporary name and renamed; ``study.json`` says
whose cases they are. Failed cases lie beside as ``HASH.failed.json``.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from coaxshell._version import __version__
from coaxshell.errors import InputError
from coaxshell.model.system import System
from coaxshell.numerics.files import reason, write_text
from coaxshell.numerics.identity import libraries, package_digest
from coaxshell.numerics.scratch import reclaim, scratch
from coaxshell.solver.settings import NUMERICS_VERSION, Settings
from coaxshell.studies.evaluation import Outcome, failure
from coaxshell.studies.metrics import Metric

MANIFEST = "study.json"
FORMAT_VERSION = 1


def numerics() -> str:
    """Return the version of the numerics, for a person."""
    return f"{__version__}, numerics {NUMERICS_VERSION}"


def origin() -> str:
    """Return all that a case's numbers depend on beside its study: version, code and key libraries, in words."""
    return f"{numerics()}, code {package_digest()}, {libraries()}"


def digest(data: Any) -> str:
    """Return the hash of plain data, the same for the same numbers on any machine."""
    text = json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def case_key(system: System, metrics: Sequence[Metric], resolution: Settings) -> str:
    """Return the name under which a case is kept: the hash of its physics, metrics, resolution and the code of all of them."""
    asked = {metric.name: metric.identity for metric in metrics}
    return digest({"system": system.canonical(), "metrics": asked, "resolution": resolution.arguments(), "numerics": origin()})


class Store:
    """The cases of one study in a folder.

    Parameters
    ----------
    folder : Path
        Made if it is not there.
    study : mapping
        Plain data that tell one study from another, by parts ("scenario", "over", ...): a difference is told by the part's name.
    metrics : sequence of Metric
        Their values are what is kept, in this order.
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
        self.folder, self.metrics, self._where = Path(folder), tuple(metrics), where
        manifest = {"format": FORMAT_VERSION, "numerics": origin(), "study": {key: digest(part) for key, part in study.items()}}
        try:
            self._open({**manifest, "description": dict(study)}, resume=resume)
        except OSError as error:
            raise InputError(
                where, f"{str(self.folder)!r} cannot be used ({reason(error)})", "give a folder that you may write to"
            ) from None

    def _open(self, manifest: dict[str, Any], *, resume: bool) -> None:
        path = self.folder / MANIFEST
        if self.folder.is_dir() and not path.is_file() and any(not name.name.startswith(".") for name in self.folder.iterdir()):
            raise InputError(self._where, f"{str(self.folder)!r} holds something else than a study", "give an empty or a new folder")
        self.folder.mkdir(parents=True, exist_ok=True)
        reclaim(self.folder)
        if path.is_file():
            self._same(_read(path), manifest)
            if not resume:
                kept = sum(1 for _ in self.folder.glob("*.json")) - 1
                remedy = "use resume (--resume) to go on with it, or remove it"
                raise InputError(self._where, f"{str(self.folder)!r} already holds {kept} cases of this study", remedy)
            return
        with scratch(self.folder, sweep=False) as place:
            made = place / MANIFEST
            made.write_text(json.dumps(manifest, indent=1), encoding="utf-8")
            try:
                os.link(made, path)  # fails if another writer was first, where a rename would not
            except FileExistsError:
                self._same(_read(path), manifest)

    def _same(self, found: dict[str, Any] | None, ours: dict[str, Any]) -> None:
        name, another = str(self.folder), "give another folder, or remove this one"
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
        """Return the name of a case."""
        return case_key(system, self.metrics, resolution)

    def load(self, key: str) -> Outcome | None:
        """Return the outcome of a case, None if it is not there. Accidents count as not there: they are tried again."""
        data = _read(self.folder / f"{key}.json")
        if data is not None and set(data.get("values", ())) == {metric.name for metric in self.metrics}:
            values = tuple(float(data["values"][metric.name]) for metric in self.metrics)
            return Outcome(values, warnings=tuple(data.get("warnings", ())), seconds=float(data.get("seconds", 0.0)))
        failed = _read(self.folder / f"{key}.failed.json")
        if failed is not None and failed.get("expected"):
            return failure(self.metrics, str(failed["reason"]), seconds=float(failed.get("seconds", 0.0)))
        return None

    def save(self, key: str, outcome: Outcome) -> None:
        """Keep the outcome of a case; InputError if there is no room."""
        data: dict[str, Any] = {"seconds": outcome.seconds}
        if outcome.failed:
            data |= {"reason": outcome.reason, "expected": outcome.expected}
        else:
            named = {metric.name: value for metric, value in zip(self.metrics, outcome.values, strict=True)}
            data |= {"values": named, "warnings": list(outcome.warnings)}
        path = self.folder / (f"{key}.failed.json" if outcome.failed else f"{key}.json")
        write_text(path, json.dumps(data), self._where, durable=False)  # cut short by a power cut, it counts as not there
        if not outcome.failed:
            (self.folder / f"{key}.failed.json").unlink(missing_ok=True)  # an accident that has been made good


def _read(path: Path) -> dict[str, Any] | None:
    """Return the table of a JSON file; None if it is not there or cut short (after a power cut a new file may be empty)."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, ValueError):
        return None
    return data if isinstance(data, dict) else None
