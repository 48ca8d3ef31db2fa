"""A real server, a real Chromium, and pages that fail their test on any outside request, console error or uncaught exception."""

from __future__ import annotations

import os
import queue
import shutil
import socket
import subprocess
import sys
import threading
from urllib.parse import urlsplit

import pytest
from page_reading import PATIENCE, until, without_drawing
from playwright.sync_api import sync_playwright

FLAGS = [
    *("--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
]


class Server:
    """``coaxshell studio`` as a process of its own."""

    def __init__(self, port: int = 0) -> None:
        command = [sys.executable, "-m", "coaxshell", "studio", "--port", str(port), "--no-browser"]
        environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment)
        lines: queue.Queue[str] = queue.Queue()
        self._reader = threading.Thread(target=lambda: [lines.put(line) for line in self._process.stdout], daemon=True)
        self._reader.start()
        said = []
        while not said or "http://" not in said[-1]:
            said.append(lines.get(timeout=PATIENCE))
        self.address = "http://" + said[-1].partition("http://")[2].split()[0]

    @property
    def port(self) -> int:
        return urlsplit(self.address).port

    def stop(self) -> None:
        """End it as Ctrl-C would."""
        if self._process.poll() is None:
            self._process.terminate()
            try:
                self._process.wait(timeout=20)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._reader.join(timeout=20)
        self._process.stdout.close()


@pytest.fixture(scope="session")
def server():
    server = Server()
    yield server
    server.stop()


@pytest.fixture
def own_server():
    """Give what starts servers that a test may stop; those left over are stopped."""
    started: list[Server] = []

    def start(port: int = 0) -> Server:
        started.append(Server(port))
        return started[-1]

    yield start
    for one in started:
        one.stop()


@pytest.fixture
def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@pytest.fixture(scope="session")
def browser():
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if chromium is None:
        pytest.fail("no Chromium on this machine; on Debian: apt-get install chromium", pytrace=False)
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=chromium, args=FLAGS, headless=True)
        yield browser
        browser.close()


class Watched:
    """What pages did that none may do."""

    def __init__(self) -> None:
        self.faults: list[str] = []
        self.forgiven: list[str] = []
        """Pieces of console messages that a test expects, such as a refused connection while the server is down."""

        self._heard = {
            "request": self._request,
            "console": lambda message: message.type == "error" and self._console(message.text, message.location.get("url", "")),
            "response": lambda response: response.status >= 400 and self._fault(f"{response.status}: {response.url}"),
            "pageerror": lambda error: self._fault(f"exception: {error}"),
        }

    def watch(self, page) -> None:
        for event, hear in self._heard.items():
            page.on(event, hear)

    def leave(self, page) -> None:
        for event, hear in self._heard.items():
            page.remove_listener(event, hear)

    def _request(self, request) -> None:
        parts = urlsplit(request.url)
        if parts.scheme not in ("data", "blob", "about") and parts.hostname != "127.0.0.1":
            self.faults.append(f"request that leaves this machine: {request.url}")

    def _console(self, text: str, url: str) -> None:
        if not url.endswith("/favicon.ico"):  # asked for by the browser where the kept page waits, a picture that names no icon
            self._fault(f"console: {text} {url}".rstrip())

    def _fault(self, text: str) -> None:
        if not any(piece in text for piece in self.forgiven):
            self.faults.append(text)


@pytest.fixture
def watched():
    watched = Watched()
    yield watched
    assert watched.faults == []


@pytest.fixture(scope="session")
def kept_page(browser):
    """One page for one test after another: every other compiles plotly's script once more, which takes two seconds of a processor."""
    context = browser.new_context(accept_downloads=True)
    context.set_default_timeout(1e3 * PATIENCE)
    yield context.new_page()
    context.close()


@pytest.fixture
def open_page(browser, kept_page, server, watched):
    """Give what opens the page as one who comes for the first time and waits for its first answer; the second one has a window apart."""
    opened = []

    def start(address: str | None = None, *, width=1280, height=720, theme="light", wait=True, drawing=True):
        address = address or server.address
        if not opened and address.startswith(server.address):
            page = kept_page
            page.set_viewport_size({"width": width, "height": height})
            page.emulate_media(color_scheme=theme)
        else:
            context = browser.new_context(viewport={"width": width, "height": height}, color_scheme=theme, accept_downloads=True)
            context.set_default_timeout(1e3 * PATIENCE)
            page = context.new_page()
        opened.append(page)
        watched.watch(page)
        if not drawing:
            without_drawing(page)
        page.goto(address)
        if wait:
            until(page, "window.coaxshell?.state.runs.current && window.coaxshell.state.runs.bare")
        return page

    yield start
    for page in opened:
        watched.leave(page)
        if page is not kept_page:
            page.context.close()
            continue
        page.unroute_all()
        page.mouse.move(0, 0)
        page.evaluate("() => { localStorage.clear(); sessionStorage.clear(); }")
        page.goto(f"{server.address}/page/icon.svg")  # of the same origin, or Chromium would give its next page a process of its own


@pytest.fixture
def page(open_page):
    return open_page()
