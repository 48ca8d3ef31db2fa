"""What the server knows while it runs: runs by name, the newest revision of each slot, jobs, workers, one temporary folder."""

from __future__ import annotations

import asyncio
import hashlib
import os
import secrets
import stat
import tempfile
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coaxshell.apps.studio import limits, memory, worker
from coaxshell.apps.studio.arrays import Packed
from coaxshell.apps.studio.jobs import Jobs
from coaxshell.apps.studio.kept_records import KeptRecords
from coaxshell.apps.studio.refusals import RefusedError
from coaxshell.apps.studio.workers import Work, Workers
from coaxshell.model import System
from coaxshell.numerics.cache import ByteBoundedCache
from coaxshell.numerics.scratch import scratch
from coaxshell.solver.settings import Settings

_LETTER = 6
"""Bytes that a description takes for each letter of its text, about."""


@dataclass(frozen=True)
class Run:
    """A system at a resolution, and its name."""

    name: str
    system: System
    settings: Settings
    bytes: int

    @property
    def pair(self) -> tuple[System, Settings]:
        """What a worker needs."""
        return self.system, self.settings

    @property
    def place(self) -> Any:
        """What names the structure that it needs."""
        return worker.structure_key(*self.pair)


@dataclass
class Slot:
    """The newest revision of a place of a page, asked for and answered, and the work for it."""

    revision: int = -1
    answered: int = -1
    work: Work | None = None


class Studio:
    """All of it; made when the server starts, closed when it ends."""

    def __init__(self) -> None:
        self.id = secrets.token_urlsafe(9)
        self._ending = ExitStack()
        self.folder = self._ending.enter_context(temporary())
        self.workers = Workers()
        self.jobs = Jobs(self.workers)
        self.records = KeptRecords()
        self.curves: ByteBoundedCache[Packed] = ByteBoundedCache(limits.CURVE_BYTES, lambda content: len(content.data) + 4_000)
        self.closing = False
        self._runs: ByteBoundedCache[Run] = ByteBoundedCache(limits.RUN_BYTES, lambda run: run.bytes)
        self._slots: OrderedDict[tuple[str, str], Slot] = OrderedDict()
        self._secret = secrets.token_bytes(32)

    def run_of(self, system: System, settings: Settings) -> Run:
        """Return the run of a system at a resolution; its name cannot be guessed, so that no other site can ask for it."""
        text = f"{system.model_dump_json()}{settings}".encode()
        name = hashlib.blake2b(text, key=self._secret, digest_size=16).hexdigest()
        found = self._runs.get(name)
        if found is None:
            found = Run(name, system, settings, _LETTER * len(text) + 4_000)
            self._runs.put(name, found)
        return found

    def run(self, name: str) -> Run:
        """Return a run by its name; RefusedError when it is not known."""
        found = self._runs.get(name)
        if found is None:
            raise RefusedError(
                404, "unknown-run", "run", "is not known here", "solve again: it was forgotten, or the server has started anew"
            )
        return found

    def slot(self, client: str, name: str) -> Slot:
        """Return the slot of a client; the ones not used for longest are forgotten."""
        found = self._slots.setdefault((client, name), Slot())
        self._slots.move_to_end((client, name))
        if len(self._slots) > limits.SLOTS:
            self._slots.popitem(last=False)
        return found

    async def curves_of(self, run: Run) -> Packed:
        """Return the curves of a run, kept or solved now."""
        found = self.curves.get(run.name)
        if found is None:
            found = await self.workers.submit(worker.solve, *run.pair, place=run.place).future
            self.curves.put(run.name, found)
        return found

    def file(self, suffix: str) -> Path:
        """Return the name of a new file in the server's own folder."""
        return self.folder / f"{secrets.token_hex(8)}.{suffix}"

    def close_streams(self) -> None:
        """End the streams of events, so that the server can end."""
        self.closing = True
        self.jobs.wake_all()

    def close(self) -> None:
        """End the workers and remove the folder."""
        self.close_streams()
        self.workers.close()
        self._ending.close()

    async def rest(self) -> None:
        """Give memory back whenever nothing has been asked for in a while, as long as the server runs."""
        rested = True
        while True:
            await asyncio.sleep(limits.REST_SECONDS / 8)
            resting = self.workers.rest(limits.REST_SECONDS)
            if resting and (not rested or len(self.curves)):
                self.curves.clear()
                memory.give_back()
            rested = resting


@contextmanager
def temporary() -> Iterator[Path]:
    """Yield a folder of one's own for files; what servers that were killed have left of theirs is removed first."""
    base = Path(tempfile.gettempdir(), f"coaxshell-studio-{getattr(os, 'getuid', lambda: '')()}")
    try:
        base.mkdir(mode=0o700, exist_ok=True)
        state = base.lstat()
        if os.name == "posix" and (state.st_uid != os.getuid() or stat.S_IMODE(state.st_mode) != 0o700 or not stat.S_ISDIR(state.st_mode)):
            raise PermissionError("somebody else's")
    except OSError:
        base = Path(tempfile.mkdtemp(prefix="coaxshell-studio-"))
    with scratch(base) as folder:
        yield folder
