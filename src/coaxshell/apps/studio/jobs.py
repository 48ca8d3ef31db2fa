"""Jobs that a page starts, watches and cancels: full resolution, fields, films."""

from __future__ import annotations

import asyncio
import secrets
import time
from collections import OrderedDict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from coaxshell.apps.studio import limits
from coaxshell.apps.studio.refusals import RefusedError
from coaxshell.apps.studio.workers import Work, Workers
from coaxshell.errors import InputError

WAITING, RUNNING, DONE, FAILED, CANCELLED = "waiting", "running", "done", "failed", "cancelled"
ENDED = (DONE, FAILED, CANCELLED)
STUDIES = ("sweep", "optimise")
TOLD = ("id", "client", "kind", "title", "slot", "revision", "state", "fraction", "stage", "error")


@dataclass(eq=False)
class Job:
    """One job; ``name`` is its system's, ``version`` counts its changes, and ``left`` tells that its page has gone."""

    client: str
    kind: str
    title: str = ""
    slot: str | None = None
    revision: int | None = None
    run: str | None = None
    file: Path | None = None
    name: str = ""
    id: str = field(default_factory=lambda: secrets.token_urlsafe(12))
    state: str = WAITING
    fraction: float = 0.0
    stage: str = "waiting"
    began: float | None = None
    ended: float | None = None
    error: dict[str, str] | None = None
    result: Any = None
    work: Work | None = None
    version: int = 0
    left: bool = False

    def told(self) -> dict[str, Any]:
        """Return what the page is told."""
        seconds = 0.0 if self.began is None else (self.ended or time.monotonic()) - self.began
        left = seconds * (1 / self.fraction - 1) if self.state == RUNNING and self.fraction > 0.02 else None
        plain = {name: getattr(self, name) for name in TOLD}
        return {**plain, "run": self.run if self.state == DONE else None, "seconds": seconds, "seconds_left": left}


class Jobs:
    """All jobs, and the waking of those who watch them.

    Parameters
    ----------
    workers : Workers
    """

    def __init__(self, workers: Workers) -> None:
        self.workers = workers
        self._jobs: OrderedDict[str, Job] = OrderedDict()
        self._watchers: dict[str, set[asyncio.Event]] = {}
        self._tasks: set[asyncio.Task[None]] = set()

    def start(self, job: Job, task: Any, *arguments: Any, place: Any = None) -> Job:
        """Queue a job; RefusedError when its client or the server has too many."""
        open_jobs = [other for other in self.of(job.client) if other.state not in ENDED]
        if job.kind == "solve":
            for other in open_jobs:
                if (other.kind, other.slot) == ("solve", job.slot):
                    self.cancel(other)
        if len([other for other in self.of(job.client) if other.state not in ENDED]) >= limits.JOBS_OF_CLIENT:
            raise RefusedError(429, "busy", "jobs", f"{len(open_jobs)} are open", "wait for one or cancel it")
        job.work = self.workers.submit(
            task, *arguments, place=place, live=False, study=job.kind in STUDIES, started=lambda: self._began(job)
        )
        self._jobs[job.id] = job
        self._tidy()
        waiter = asyncio.get_running_loop().create_task(self._watched(job, job.work))
        self._tasks.add(waiter)
        waiter.add_done_callback(self._tasks.discard)
        self._changed(job)
        return job

    def done(self, job: Job) -> Job:
        """Keep a job that was done before it began."""
        job.state, job.fraction, job.stage = DONE, 1.0, "done"
        self._jobs[job.id] = job
        self._tidy()
        self._changed(job)
        return job

    def of(self, client: str) -> list[Job]:
        """Return the jobs of a client."""
        return [job for job in self._jobs.values() if job.client == client]

    def get(self, name: str) -> Job:
        """Return a job; RefusedError when there is none of that name."""
        if name not in self._jobs:
            raise RefusedError(404, "unknown-job", "job", "is not known here", "it was forgotten, or the server has started anew")
        return self._jobs[name]

    def finished(self, name: str) -> Job:
        """Return a job that is done; RefusedError when it is not."""
        job = self.get(name)
        if job.state == FAILED and job.error is not None:
            raise RefusedError(409, "failed", job.error["where"], job.error["problem"], job.error["remedy"])
        if job.state != DONE:
            code = "cancelled" if job.state == CANCELLED else "not-ready"
            raise RefusedError(409, code, "job", f"is {job.state}", "start it again" if code == "cancelled" else "wait until it is done")
        return job

    def cancel(self, job: Job) -> None:
        """Stop a job; forget one that has ended."""
        if job.state in ENDED:
            self._forget(job)
            return
        self._end(job, CANCELLED)
        if job.work is not None:
            self.workers.drop(job.work)

    def watch(self, client: str, event: asyncio.Event | None = None) -> asyncio.Event:
        """Return an event, a new one unless given, that is set whenever a job of the client changes; RefusedError when too many watch."""
        if event is None:
            if len({watcher for events in self._watchers.values() for watcher in events}) >= limits.STREAMS:
                raise RefusedError(429, "busy", "events", "too many pages are open", "close some")
            event = asyncio.Event()
        self._watchers.setdefault(client, set()).add(event)
        for job in self.of(client):
            job.left = False
        return event

    def unwatch(self, client: str, event: asyncio.Event) -> None:
        """Forget such an event; what is open when the last of a client's is gone may stop soon."""
        self._watchers.get(client, set()).discard(event)
        if self._watchers.get(client):
            return
        self._watchers.pop(client, None)
        for job in self.of(client):
            job.left = True
        asyncio.get_running_loop().call_later(limits.GONE_SECONDS, self._gone, client)

    def _gone(self, client: str) -> None:
        """Stop what only a page that has not come back would have shown; its studies go on, for another page to take over."""
        for job in self.of(client):
            if job.left and job.kind not in STUDIES and job.state not in ENDED:
                self.cancel(job)

    def take_over(self, client: str) -> list[Job]:
        """Give a client the studies that pages have left behind, running or done, and return them, the oldest first."""
        found = [job for job in self._jobs.values() if job.left and job.kind in STUDIES and job.state not in (FAILED, CANCELLED)]
        for job in found:
            job.client, job.left = client, client not in self._watchers
            self._changed(job)
        return found

    def wake_all(self) -> None:
        """Set all events."""
        for events in self._watchers.values():
            for event in events:
                event.set()

    async def _watched(self, job: Job, work: Work) -> None:
        while not work.future.done():
            await asyncio.wait([work.future], timeout=0.15)
            if job.state == RUNNING and not work.future.done():
                fraction, stage = self.workers.progress(work)
                if (fraction, stage) != (job.fraction, job.stage):
                    job.fraction, job.stage = fraction, stage
                    self._changed(job)
        if job.state in ENDED:
            if job.file is not None:
                job.file.unlink(missing_ok=True)
            if not work.future.cancelled():
                work.future.exception()  # looked at, so that asyncio does not complain
        elif work.future.cancelled():
            self._end(job, CANCELLED)
        elif (error := work.future.exception()) is not None:
            bad = (
                error
                if isinstance(error, InputError)
                else InputError("server", "the job failed unexpectedly", "the terminal that runs coaxshell studio says why")
            )
            job.error = {"where": bad.where, "problem": bad.problem, "remedy": bad.remedy}
            self._end(job, FAILED)
        else:
            # The curves of a run are kept by their own name, by size.
            job.result, job.fraction, job.stage = None if job.kind == "solve" else work.future.result(), 1.0, "done"
            self._end(job, DONE)
        job.work = None  # with all that it was given

    def _began(self, job: Job) -> None:
        if job.state == WAITING:
            job.state, job.began = RUNNING, time.monotonic()
            self._changed(job)

    def _end(self, job: Job, state: str) -> None:
        job.state, job.ended = state, time.monotonic()
        self._changed(job)

    def _changed(self, job: Job) -> None:
        job.version += 1
        for event in self._watchers.get(job.client, ()):
            event.set()

    def _forget(self, job: Job) -> None:
        self._jobs.pop(job.id, None)
        if job.file is not None:
            job.file.unlink(missing_ok=True)

    def _tidy(self) -> None:
        """Forget the oldest ended jobs when there are too many, or their files take too much room."""
        ended = [job for job in self._jobs.values() if job.state in ENDED]
        room = sum(job.file.stat().st_size for job in ended if job.file is not None and job.file.exists())
        while ended and (len(ended) > limits.JOBS_KEPT or room > limits.FIELD_BYTES):
            oldest = ended.pop(0)
            room -= oldest.file.stat().st_size if oldest.file is not None and oldest.file.exists() else 0
            self._forget(oldest)
