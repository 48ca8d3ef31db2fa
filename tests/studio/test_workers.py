"""Worker processes that get stuck: ended, their person told, and replaced."""

from __future__ import annotations

import asyncio
import os
import platform
import subprocess
import sys
import time

import pytest
from asking import reporting, shared_worker

from coaxshell.apps.studio import limits, workers
from coaxshell.errors import InputError


@pytest.fixture(scope="module")
def carried_out():
    """Tell stories with one worker, looked at often; one that was ended has been replaced for the next."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(workers, "WATCHED_EVERY", 0.05)
        with shared_worker() as told:
            yield told


@pytest.mark.slow
def test_a_task_that_reports_nothing_is_ended_and_the_next_one_runs(carried_out):
    async def story(crew):
        first = await crew.submit(os.getpid).future
        with pytest.raises(InputError, match=r"made no progress for 0\.5 s"):
            await crew.submit(time.sleep, 600).future
        limits.SILENT_SECONDS = 60.0  # the new process has to start
        return first, await crew.submit(os.getpid).future

    first, second = carried_out(story, SILENT_SECONDS=0.5)
    assert first != second


def test_a_task_that_reports_may_take_its_time(carried_out):
    async def story(crew):
        await crew.submit(reporting, 0.0).future  # has this file read there
        limits.SILENT_SECONDS = 2.0
        return await crew.submit(reporting, 4.0).future

    assert carried_out(story, SILENT_SECONDS=60.0) == "done"


def test_a_dropped_task_that_does_not_look_up_is_ended_soon(carried_out):
    async def story(crew):
        stuck = crew.submit(time.sleep, 600, live=False)
        await asyncio.sleep(0.1)
        crew.drop(stuck)
        with pytest.raises(asyncio.CancelledError):
            await stuck.future
        return await crew.submit(os.getpid).future

    assert carried_out(story, DROPPED_SECONDS=0.2) > 0


ANEW = """
import resource, numpy
from coaxshell.apps.studio import memory
memory.keep_freed()
def filled():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(8):
        numpy.ones(2**20)
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before
print(filled(), filled())
"""
"""Eight megabytes, eight times: pages that the system has cleared the first time and the second."""


def test_a_worker_uses_again_what_it_has_freed():
    first, again = map(int, subprocess.run([sys.executable, "-c", ANEW], capture_output=True, text=True, check=True).stdout.split())
    assert again < 100 or platform.libc_ver()[0] != "glibc", (first, again)
