"""The real server in a process of its own: port, signals, host, what it leaves behind."""

from __future__ import annotations

import asyncio
import json
import os
import re
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx2
import pytest
import uvicorn
from asking import KEY, PORT, described

from coaxshell.apps.cli import main
from coaxshell.apps.studio import limits
from coaxshell.apps.studio.app import create_app
from coaxshell.apps.studio.server import Patient, listening
from coaxshell.apps.studio.state import temporary


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    folder = tmp_path_factory.mktemp("temporary")
    with subprocess.Popen(
        [sys.executable, "-m", "coaxshell", "studio", "--no-browser", "--port", "0"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "TMPDIR": str(folder), "XDG_STATE_HOME": str(folder / "state")},
    ) as process:
        address, key = re.search(r"(http://127\.0\.0\.1:\d+)/\?key=(\S+)", process.stdout.readline()).groups()
        with httpx2.Client(base_url=address, timeout=60) as http:
            assert http.get("/").status_code == 401
            assert http.get(f"/?key={key}", follow_redirects=True).status_code == 200  # and the cookie is kept
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


@pytest.mark.parametrize("name", ["http://lab.example.org", "lab:80", "", "a b"])
def test_a_name_that_is_none_of_a_host_is_told_in_one_line(name, capsys):
    assert main(["studio", "--allow-host", name]) == 2
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "--allow-host" in told


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
    places = folder / f"coaxshell-studio-{os.getuid()}"
    assert list(places.iterdir()), "it has a folder of its own"
    assert stat.S_IMODE(places.stat().st_mode) == 0o700
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
    assert list(places.iterdir()) == []
    end = time.monotonic() + 10  # multiprocessing's own tracker ends a moment after the others
    while left := [child for child in children if Path(f"/proc/{child}").exists()]:
        assert time.monotonic() < end, left
        time.sleep(0.05)


class Waiting(asyncio.Protocol):
    """A client that sends what it is given, and notes when it is closed."""

    def __init__(self, data: bytes) -> None:
        self.data, self.closed, self.got = data, asyncio.get_running_loop().create_future(), b""

    def connection_made(self, transport):
        transport.write(self.data)

    def data_received(self, data):
        self.got += data

    def connection_lost(self, exc):
        self.closed.set_result(None)


def test_requests_that_never_finish_are_closed(monkeypatch, capfd):
    """The head of a request, and its body, have so long to come; what is answered in time, and rests, stays open."""
    for name in ("HEAD_SECONDS", "BODY_SECONDS"):
        monkeypatch.setattr(limits, name, 0.4)
    head = f"Host: 127.0.0.1\r\nCookie: coaxshell-{PORT}={KEY}\r\n".encode()
    post = b"POST /api/studies HTTP/1.1\r\n" + head + b"Content-Type: application/json\r\nContent-Length: 99\r\n\r\n{"

    async def story():
        app = create_app(PORT, KEY)
        config = uvicorn.Config(app, http=Patient, log_level="error", lifespan="on", timeout_graceful_shutdown=1)
        server = uvicorn.Server(config)
        with listening(0) as listener:
            running = asyncio.create_task(server.serve([listener]))
            while not server.started:
                await asyncio.sleep(0.02)
            port, loop = listener.getsockname()[1], asyncio.get_running_loop()
            sent = (b"", b"GET / HT", b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n", post, b"GET / HTTP/1.1\r\n" + head + b"\r\n")
            made = [await loop.create_connection(lambda data=data: Waiting(data), "127.0.0.1", port) for data in sent]
            *unfinished, resting = [client for _, client in made]
            await asyncio.wait_for(asyncio.gather(*(one.closed for one in unfinished[:3])), 20)
            while b"too-slow" not in unfinished[3].got:
                await asyncio.sleep(0.02)
            assert b"HTTP/1.1 200" in resting.got
            assert not resting.closed.done()
            app.app.state.studio.close()
            server.should_exit = True
            await running

    with ThreadPoolExecutor(1) as apart:
        apart.submit(lambda: asyncio.run(story())).result()
    assert "Traceback" not in capfd.readouterr().err


def test_a_page_that_leaves_in_the_middle_leaves_no_traceback(client, caplog):
    async def story():
        scope = {"type": "http", "method": "POST", "path": "/api/studies", "query_string": b"", "http_version": "1.1", "root_path": ""}
        headers = {"host": "127.0.0.1", "authorization": f"Bearer {KEY}", "content-type": "application/json", "content-length": "9"}
        scope["headers"] = [(name.encode(), value.encode()) for name, value in headers.items()]
        sent = []

        async def receive():
            return {"type": "http.disconnect"}

        async def send(message):
            sent.append(message)

        await client.app({**scope, "app": client.app.app}, receive, send)
        return sent

    with caplog.at_level("ERROR"):
        assert [message.get("status") for message in client.portal.call(story)] == [408, None]  # to nobody
    assert not caplog.records


@pytest.mark.slow_for("closed terminal")
@pytest.mark.parametrize("number", [signal.SIGHUP, signal.SIGKILL], ids=["closed terminal", "killed"])
def test_nothing_stays_of_a_server_that_was_ended_otherwise(tmp_path, monkeypatch, number):
    """A closed terminal ends it cleanly; what a killed one leaves is removed by the next."""
    environment = {**os.environ, "TMPDIR": str(tmp_path), "XDG_STATE_HOME": str(tmp_path / "state")}
    command = [sys.executable, "-m", "coaxshell", "studio", "--no-browser", "--port", "0"]
    places = tmp_path / f"coaxshell-studio-{os.getuid()}"
    with subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=environment,
        preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),  # tests under nohup ignore it, and so would their children
    ) as process:
        process.stdout.readline()
        (left,) = places.iterdir()
        (left / "upload.nc").write_bytes(b"half")
        process.send_signal(number)
        process.wait(20)
        if number == signal.SIGHUP:
            assert (process.returncode, process.stderr.read()) == (0, "")
            assert not left.exists()
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    with temporary() as folder:
        assert folder.parent == places
        assert not left.exists()
        assert list(places.iterdir()) == [folder]


def test_a_folder_that_others_could_read_is_not_used(tmp_path, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    (tmp_path / f"coaxshell-studio-{os.getuid()}").mkdir(mode=0o777)
    (tmp_path / f"coaxshell-studio-{os.getuid()}").chmod(0o777)
    with temporary() as folder:
        assert stat.S_IMODE(folder.parent.stat().st_mode) == 0o700
