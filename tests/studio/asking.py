"""Requests as the page makes them, and workers without a server."""

from __future__ import annotations

import asyncio
import itertools
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

import pytest

from coaxshell.apps.studio import limits, memory, worker, workers
from coaxshell.apps.studio.arrays import decoded
from coaxshell.model import presets

PORT, KEY = 8765, "a-key-of-the-tests-and-of-no-one-else"
SMALL = {"duration": 2.0, "time_step": 0.02, "modes": 12}
"""A resolution that takes hundredths of a second."""

_revisions = itertools.count()


def described(name="hybrid"):
    return presets.load(name).model_dump(mode="json")


def solve(client, system, *, who="tab", slot="current", revision=None, resolution=None, **more):
    revision = next(_revisions) if revision is None else revision
    body = {"client": who, "slot": slot, "revision": revision, "system": system, "resolution": resolution or SMALL, **more}
    return client.post("/api/solve", json=body)


def solved(client, system, **options):
    answer = solve(client, system, **options)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"] == "application/x-coaxshell-arrays", answer.text
    return decoded(answer.content)


def start(client, **entries):
    answer = client.post("/api/jobs", json={"client": "tab", **entries})
    assert answer.status_code == 202, answer.text
    return answer.json()["job"]


def ended(client, job, seconds=60):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        job = client.get(f"/api/jobs/{job['id']}").json()["job"]
        if job["state"] in ("done", "failed", "cancelled"):
            return job
        time.sleep(0.02)
    raise AssertionError(f"still {job['state']} after {seconds} s")


def reporting(seconds):
    """Report progress ever so often, in a worker."""
    for number in range(10):
        time.sleep(seconds / 10)
        worker.report(number / 10, "at it")
    return "done"


def taking(size):
    """Hold some memory for good, in a worker."""
    worker._Here.held = getattr(worker._Here, "held", bytearray()) or bytearray(size)
    for place in range(0, size, 4096):
        worker._Here.held[place] = 1
    return memory.held()


@contextmanager
def shared_worker():
    """Give what tells coroutine functions, one after another, with one worker, since it takes seconds to start."""

    async def made():
        crew = workers.Workers(1)
        await crew.submit(worker.ready).future  # reports nothing meanwhile
        return crew

    async def closed(crew):
        crew.close()

    # In a thread of their own: the browser of other tests may have left a loop running in this one.
    with ThreadPoolExecutor(1) as apart:
        runner = asyncio.Runner()

        def run(story, *arguments):
            return apart.submit(lambda: runner.run(story(*arguments))).result()

        def told(story, **seconds):
            with pytest.MonkeyPatch.context() as patch:
                for name, value in seconds.items():
                    patch.setattr(limits, name, value)
                return run(story, crew)

        crew = run(made)
        try:
            yield told
        finally:
            run(closed, crew)
            apart.submit(runner.close).result()


def carried_out(story, **seconds):
    """Return what a coroutine function finds with a worker of its own, under other limits than usual."""
    with shared_worker() as told:
        return told(story, **seconds)
