"""A real server, a real Chromium, and pages that fail their test on any outside request, console error or uncaught exception."""

from __future__ import annotations

import itertools
import os
import queue
import shutil
import socket
import subprocess
import sys
import threading
from urllib.parse import urlsplit

import pytest
from asking import SMALL
from page_reading import PATIENCE, rest, until, without_drawing
from playwright.sync_api import sync_playwright

import coaxshell as cx
from coaxshell.apps.studio.links import fragment

LINKS = itertools.count()
"""Tells links apart, so that a test knows when the page has opened its own."""

OF_ITS_OWN = """([slots, wanted]) => slots.every(slot => {
  const {system, runs: {[slot]: run}} = window.coaxshell.state, more = slot === 'bare' ? {absorbers: [], control: null} : {};
  const described = one => JSON.stringify({...one, ...more, name: ''});
  const fits = ([name, value]) => run.resolution[name] === value;
  return run?.full && described(run.system) === described(system) && Object.entries(wanted).every(fits);
})"""
"""Whether the runs on the page are of the link's system at its resolution, and no finer one follows."""

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

    @property
    def origin(self) -> str:
        """Return the address of a page that has been opened, without the key that opens one."""
        return f"http://127.0.0.1:{self.port}"

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


ELSEWHERE = "/page/icon.svg"
"""Where the kept page waits: of the same origin, or Chromium would give its next page a process of its own."""


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
        if page is kept_page and not page.url.endswith(ELSEWHERE):
            leave(page, server)
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
        leave(page, server)


def leave(page, server) -> None:
    """Forget all that a page has kept, and let it wait elsewhere."""
    page.mouse.move(0, 0)
    if page.url.startswith(server.origin):
        page.evaluate("() => { localStorage.clear(); sessionStorage.clear(); }")
    page.goto(f"{server.origin}{ELSEWHERE}")


@pytest.fixture
def linked_page(kept_page, server, watched):
    """Give what opens a preset by a link on the page that the test before has left, which is not loaded anew.

    Loading it takes 2 to 3 seconds of a processor, following a link in it a tenth of that. What the test before has pinned, chosen or
    kept stays, so this is for tests that say what they start from.
    """
    page = kept_page

    def start(resolution=SMALL, preset="absorbers", *, width=1280, height=720, theme="light"):
        page.set_viewport_size({"width": width, "height": height})
        page.emulate_media(color_scheme=theme)
        watched.watch(page)
        system = preset if isinstance(preset, cx.System) else cx.presets.load(preset)
        mark = f"link {next(LINKS)}"
        view = {"tab": "peaks", "unit": "transits", "from": mark}
        held = {"v": 1, "system": system.model_dump(mode="json"), "resolution": resolution, "view": view}
        here = page.url.startswith(f"{server.origin}/#")
        page.goto(f"{f'{server.origin}/' if here else server.address}#{fragment(held)}")
        until(page, "mark => window.coaxshell?.state.from === mark", mark)
        rest(page)
        slots = ["current", "bare"] if system.absorber_list or system.control else ["current"]
        until(page, OF_ITS_OWN, [slots, {name: resolution[name] for name in ("modes", "time_step", "duration")}])
        return page

    yield start
    watched.leave(page)
    page.unroute_all()
    page.mouse.move(0, 0)


@pytest.fixture
def page(open_page):
    return open_page()
