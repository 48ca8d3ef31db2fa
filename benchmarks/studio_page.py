"""Changes in the studio's page itself, in Chromium at 1280 x 720: from an event to the curves drawn.

``python -m benchmarks.studio_page``. Needs Chromium, which ``make test`` installs. The page is asked nothing while it works: each question
would take processor time from what is measured.
"""

from __future__ import annotations

import shutil
import statistics
import time
from collections.abc import Callable
from functools import partial
from typing import Any

from playwright.sync_api import sync_playwright

from benchmarks.studio import served

UNDISTURBED, BETWEEN = 0.4, 0.3
"""Seconds after a change in which the page is left alone, and from its answer to the next change."""
SLIDERS = (
    ("absorbers", "absorbers.mass", range(180, 210, 3)),
    ("absorbers", "absorbers.damping", range(180, 210, 3)),
    ("hybrid", "absorbers.mass", range(180, 210, 3)),
    ("hybrid", "absorbers.damping", range(180, 210, 3)),
    ("hybrid", "control.derivative", range(70, 80)),
)
"""Preset, entry and places of its slider."""
ENTRIES = (
    ("shells[0].layers[1].thickness", [f"{10 + 0.1 * step} mm" for step in range(1, 9)]),
    ("shells[1].layers[1].material.density", [f"{7000 + 10 * step} kg/m^3" for step in range(1, 9)]),
    ("shells[0].radius", [f"{0.5 + 0.01 * step} m" for step in range(1, 9)]),
)
"""Entries of the hybrid system's structure, typed."""
MOVE = """([path, place]) => {
  const slider = document.querySelector(`input[type=range][data-path="${path}"]`);
  slider.value = place;
  slider.dispatchEvent(new Event("input", { bubbles: true }));
}"""


def main() -> None:
    """Start a server and a browser and print the medians."""
    with served() as (address, _), sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1280, "height": 720})
        page.goto(address)
        for preset, path, places in SLIDERS:
            _choose(page, preset)
            _told(f"{preset}, {path}", [_timed(page, partial(page.evaluate, MOVE, [path, str(place)])) for place in places])
        page.evaluate("for (const part of document.querySelectorAll('#form details')) part.open = true")
        for path, texts in ENTRIES:
            box = page.locator(f'input[type=text][data-path="{path}"]').first
            _told(f"{preset}, {path}", [_timed(page, partial(_type, box, text)) for text in texts])
        browser.close()


def _choose(page: Any, preset: str) -> None:
    _wait(page, "Boolean(window.coaxshell?.state?.runs?.current)")
    page.locator("#preset").select_option(label=preset)
    time.sleep(4)  # its full resolution comes by itself


def _type(box: Any, text: str) -> None:
    box.fill(text)
    box.press("Enter")


def _timed(page: Any, change: Callable[[], object]) -> float:
    """Return the page's own measure of a change, ms."""
    before = page.evaluate("window.coaxshell.times.length")
    change()
    time.sleep(UNDISTURBED)
    _wait(page, f"window.coaxshell.times.length > {before}")
    taken = float(page.evaluate("window.coaxshell.times.at(-1)"))
    time.sleep(BETWEEN)
    return taken


def _wait(page: Any, condition: str) -> None:
    """Wait for up to half a minute; the page's own policy forbids playwright's way, which evaluates text there."""
    for _ in range(600):
        if page.evaluate(condition):
            return
        time.sleep(0.05)
    raise TimeoutError(condition)


def _told(what: str, taken: list[float]) -> None:
    print(f"{what}: median {statistics.median(taken):.0f} ms, {min(taken):.0f} to {max(taken):.0f}, first {taken[0]:.0f}", flush=True)


if __name__ == "__main__":
    main()
