"""No body, however malformed or hostile, makes the server fail, show its insides or fall silent."""

from __future__ import annotations

import logging

import pytest
from asking import described, solved
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


def test_more_than_a_thousand_hostile_bodies(client, caplog):
    header = {"Content-Type": "application/json"}
    statuses: dict[int, int] = {}
    with caplog.at_level(logging.ERROR):
        for method, path, body in requests():
            answer = client.request(method, path, content=body, headers=header)
            statuses[answer.status_code] = statuses.get(answer.status_code, 0) + 1
            assert answer.status_code < 500, (path, body[:500], answer.text)
            assert "Traceback" not in answer.text
            assert "root:" not in answer.text, "a file of this machine was shown"
            if answer.status_code >= 400:
                assert set(answer.json()["error"]) == {"code", "where", "problem", "remedy"}
    assert sum(statuses.values()) >= 1200
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
