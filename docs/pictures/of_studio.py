"""The studio photographed: its page at first sight, in three dimensions, and two designs compared."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image, ImageOps
from playwright.sync_api import Page, sync_playwright

import coaxshell as cx
from coaxshell.apps.studio.links import fragment

WITHOUT_NETWORK = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update", "--disable-sync"]
PATIENCE = 60_000
"""Milliseconds."""
WITHOUT_TIME = """() => {
  const told = document.createTreeWalker(document.getElementById('state'), NodeFilter.SHOW_TEXT);
  while (told.nextNode()) told.currentNode.nodeValue = told.currentNode.nodeValue.replace(/(step [^,)]*), [^)]*\\)/, '$1)');
}"""
"""Leaves out how long the run took here, which would make a picture of every machine another one."""
AT_REST = "!window.coaxshell?.state?.job && Boolean(window.coaxshell?.state?.runs?.current)"


@contextmanager
def page_of(system: cx.System, resolution: dict[str, Any], width: int, height: int) -> Iterator[Page]:
    """Give the studio's page with a system at a resolution, its curves drawn, in a window of its own."""
    command = [sys.executable, "-m", "coaxshell", "studio", "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server, sync_playwright() as driver:
        assert server.stdout is not None
        address = re.search(r"http://127\.0\.0\.1:\S+", server.stdout.readline())
        assert address is not None
        browser = driver.chromium.launch(executable_path=shutil.which("chromium"), args=WITHOUT_NETWORK)
        try:
            page = browser.new_page(viewport={"width": width, "height": height})
            page.set_default_timeout(PATIENCE)
            held = {"v": 1, "system": system.model_dump(mode="json"), "resolution": resolution}
            page.goto(f"{address.group()}#{fragment(held)}")
            rest(page)
            yield page
        finally:
            browser.close()
            server.terminate()


def rest(page: Page, condition: str = AT_REST) -> None:
    """Wait until a condition of the page holds and what is drawn no longer changes; asked from outside, for the page evaluates no text."""
    for _ in range(PATIENCE // 200):
        page.wait_for_timeout(200)
        if page.evaluate(f"() => Boolean({condition})"):
            page.wait_for_timeout(2000)
            return
    raise TimeoutError(condition)


def photograph(page: Any, target: Path, height: int | None = None) -> None:
    """Keep what is seen of a page, or of a part of it, down to a height."""
    image = Image.open(BytesIO(page.screenshot())).convert("RGB")
    image = image.crop((0, 0, image.width, height or image.height))
    ImageOps.posterize(image, 6).save(target, optimize=True)


def home(target: Path) -> None:
    """The page with the paper's hybrid system beside the bare one."""
    with page_of(cx.presets.load("hybrid"), {"duration": 5.0, "time_step": 2e-3, "modes": 100}, 1280, 960) as page:
        page.locator("#tab-peaks").click()
        rest(page)
        page.evaluate(WITHOUT_TIME)
        photograph(page, target)


def space(target: Path) -> None:
    """Stations, histories at one of them, and a wall laid flat."""
    stations = [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5]
    resolution = {"duration": 4.0, "time_step": 4e-3, "modes": 40, "dimensions": 3, "stations": stations}
    system = cx.presets.load("active")
    with page_of(system, resolution, 1280, 960) as page:
        page.locator("#station").select_option("0.5")
        page.locator("#tab-wall").click()
        rest(page, "document.getElementById('wall-plot').data")
        page.locator("#wall-scrub").evaluate("e => { e.value = String(Math.round(0.31 * e.max)); e.dispatchEvent(new Event('input')); }")
        rest(page)
        page.evaluate(WITHOUT_TIME)
        photograph(page, target)


def designs(target: Path) -> None:
    """Three designs compared, a law for each shell: what differs, the stress over time, the largest magnitudes."""
    laws = [cx.PDControl(proportional=0, derivative=2, transducers="electrodes", shells=[shell]) for shell in ("inner", "outer")]
    system = cx.presets.load("electrodes-hybrid").replace(control=laws)
    changes = (("equal gains", None, ""), ("more inside", "control[0].derivative", "6"), ("lighter absorbers", "absorbers.mass", "5 kg/m"))
    with page_of(system, {"duration": 4.0, "time_step": 5e-3, "modes": 60}, 1280, 1700) as page:
        page.locator("#tab-designs").click()
        page.evaluate("for (const part of document.querySelectorAll('#form details')) part.open = true")
        for name, path, text in changes:
            if path is not None:
                field = page.locator(f'input[type="text"][data-path="{path}"]')
                field.fill(text)
                field.press("Enter")
                rest(page)
            page.locator("#design-name").fill(name)
            page.get_by_role("button", name="Keep this design").click()
        rest(page, "document.getElementById('designs-plot').data?.length === 3")
        page.wait_for_timeout(8000)  # until what was told of the last one is gone
        photograph(page.locator("#designs"), target, height=1006)
