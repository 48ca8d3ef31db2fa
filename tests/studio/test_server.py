"""The real server in a process of its own: port, signals, host, what it leaves behind."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import httpx2
import pytest
from asking import described


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    folder = tmp_path_factory.mktemp("temporary")
    with subprocess.Popen(
        [sys.executable, "-m", "coaxshell", "studio", "--no-browser", "--port", "0"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "TMPDIR": str(folder)},
    ) as process:
        address = re.search(r"http://127\.0\.0\.1:\d+", process.stdout.readline()).group()
        with httpx2.Client(base_url=address, timeout=60) as http:
            yield process, http, folder
        process.kill()


def test_it_listens_on_this_machine_only(server):
    _, http, _ = server
    port = http.base_url.port
    assert http.get("/").status_code == 200
    rows = [line.split() for line in Path("/proc/net/tcp").read_text().splitlines()[1:]]
    assert {row[1].split(":")[0] for row in rows if row[1].endswith(f":{port:04X}") and row[3] == "0A"} == {"0100007F"}
    assert http.get("/", headers={"Host": f"evil.example:{port}"}).status_code == 403
    assert http.post("/api/solve", json={}, headers={"Origin": "http://evil.example"}).status_code == 403


def test_a_port_in_use_is_told_in_one_line(server):
    _, http, _ = server
    done = subprocess.run(
        [sys.executable, "-m", "coaxshell", "studio", "--no-browser", "--port", str(http.base_url.port)], capture_output=True, text=True
    )
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert "in use" in done.stderr


def test_requests_cut_short_do_no_harm(server):
    _, http, _ = server
    for data in (
        b"POST /api/solve HTTP/1.1\r\nHost: x\r\nContent-Length: 100\r\n\r\n{",
        b"\x00" * 100,
        b"GET / HTTP/9\r\n\r\n",
        b"GET /" + b"a" * 99_000,
    ):
        with socket.create_connection(("127.0.0.1", http.base_url.port)) as connection:
            connection.sendall(data)
    assert http.get("/").status_code == 200


def test_events_tell_of_jobs_and_it_ends_cleanly_on_interrupt(server):
    process, http, folder = server
    body = {"client": "tab", "kind": "solve", "slot": "a", "revision": 1, "system": described("bare"), "resolution": {"modes": 10}}
    seen: list[tuple[str, dict]] = []
    with http.stream("GET", "/api/events?client=other&client=tab") as stream:
        name = ""
        for line in stream.iter_lines():
            if line.startswith("event: "):
                name = line[7:]
            elif line.startswith("data: "):
                seen.append((name, json.loads(line[6:])))
                if name == "hello":
                    assert http.post("/api/jobs", json=body).status_code == 202
                if seen[-1][1].get("state") == "done":
                    break
    assert seen[0][0] == "hello"
    assert {name for name, _ in seen[1:]} == {"job"}
    assert [told["fraction"] for _, told in seen[1:]] == sorted(told["fraction"] for _, told in seen[1:])
    assert list(folder.iterdir()), "it has a folder of its own"
    heavy = {**body, "system": described("hybrid"), "revision": 2, "resolution": {"duration": 10.0, "time_step": 1e-3, "modes": 150}}
    http.post("/api/jobs", json=heavy)
    live = {"client": "tab", "slot": "live", "revision": 1, "system": described("hybrid"), "resolution": {"modes": 100}}
    statuses: list[int] = []
    waiting = threading.Thread(target=lambda: statuses.append(http.post("/api/solve", json=live).status_code), daemon=True)
    waiting.start()
    listener = threading.Thread(target=lambda: http.get("/api/events?client=tab"), daemon=True)
    listener.start()
    time.sleep(0.3)
    children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
    assert children
    process.send_signal(signal.SIGINT)
    assert process.wait(20) == 0
    assert process.stderr.read() == ""
    waiting.join(20)
    assert statuses in ([200], [503])
    assert list(folder.iterdir()) == []
    end = time.monotonic() + 10  # multiprocessing's own tracker ends a moment after the others
    while left := [child for child in children if Path(f"/proc/{child}").exists()]:
        assert time.monotonic() < end, left
        time.sleep(0.05)
