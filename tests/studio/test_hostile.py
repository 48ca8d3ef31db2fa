"""No body, however malformed or hostile, makes the server fail, show its insides or fall silent."""

from __future__ import annotations

import asyncio
import logging
import resource
import time
from contextlib import contextmanager

import pytest
from asking import described, solved
from grave import uploads
from hostile import requests

PATHS = [
    "/api/runs/..%2f..%2fetc%2fpasswd",
    "/api/runs/%00",
    "/api/runs/a/download.toml",
    "/api/jobs/../x",
    "/api/jobs/" + "a" * 4000,
    "/api/events",
    "/api/events?client=../x",
    "/api/events?client=tab&client=../x",
    "/api/jobs?client=",
    "/api/runs/x/point?x=1&y=1",
    "/api/runs/x/energy?every=0",
    "/api/runs/x/costs?every=-1&size=nan",
    "/api/runs/..%2f/costs?half_width=1e999",
    "/page/%2e%2e%2fapp.py",
    "/api",
    "/api/",
    "/api/schema/../../etc/passwd",
    "/api/runs/x/figure.png?quantity=../&time=nan",
    "/api/jobs/x/frames?start=1e9",
    "/api/jobs/x/designs/..%2f1",
    "/api/jobs/x/file?what=../best.toml",
    "/api/study",
    "/vendor/../app.py",
]


def largest():
    """Return the most bytes that this process has ever held."""
    return 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


@contextmanager
def watched_loop(client):
    """Give what tells the longest that the event loop has worked at one go since it was last asked, in seconds of the processor."""
    found = [0.0]

    async def watch():
        last = time.thread_time()
        while True:
            await asyncio.sleep(0.001)
            now = time.thread_time()
            found[0], last = max(found[0], now - last), now

    def longest():
        value, found[0] = found[0], 0.0
        return value

    task = client.portal.start_task_soon(watch)
    try:
        yield longest
    finally:
        task.cancel()


@pytest.mark.parametrize(
    ("seed", "count", "longest_body", "least"),
    [(1, 300, 30_000, 600), pytest.param(2, 2_500, 10**7, 3_000, marks=pytest.mark.slow)],
    ids=["some", "all"],
)
def test_hostile_bodies(client, caplog, seed, count, longest_body, least):
    """None makes the server fail, or takes a second of the event loop's processor time or 300 MB; afterwards it still works."""
    statuses: dict[int, int] = {}
    with caplog.at_level(logging.ERROR), watched_loop(client) as longest:
        for method, path, body in requests(seed, count):
            if len(body) > longest_body:
                continue
            before = largest()
            answer = client.request(method, path, content=body, headers={"Content-Type": "application/json"})
            statuses[answer.status_code] = statuses.get(answer.status_code, 0) + 1
            assert answer.status_code < 500, (path, body[:500], answer.text)
            assert "Traceback" not in answer.text
            assert "root:" not in answer.text, "a file of this machine was shown"
            if answer.status_code >= 400:
                assert set(answer.json()["error"]) == {"code", "where", "problem", "remedy"}
            assert longest() < 1.0, (path, body[:500])
            assert largest() - before < 300e6, (path, body[:500])
        for kind, content in uploads():
            answer = client.post("/api/upload", content=content, headers={"Content-Type": kind})
            assert answer.status_code < 500, (kind, content[:500], answer.text)
    assert sum(statuses.values()) >= least
    assert not caplog.records
    for job in client.get("/api/jobs?client=tab").json()["jobs"]:
        client.delete(f"/api/jobs/{job['id']}")
    assert solved(client, described("bare"))[0]["ok"], "the server still works"


@pytest.mark.parametrize("path", PATHS)
def test_paths_that_lead_nowhere(client, path):
    answer = client.get(path)
    assert 400 <= answer.status_code < 500
    assert "root:" not in answer.text


@pytest.mark.parametrize("method", ["PUT", "PATCH", "DELETE", "GET", "OPTIONS", "TRACE", "BREW"])
def test_methods_that_are_not_there(client, method):
    assert client.request(method, "/api/solve").status_code == 405
