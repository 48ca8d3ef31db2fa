"""Changes in the studio's page itself, in Chromium at 1280 x 720: from an event to the curves drawn, and whose processor time that takes.

``python -m benchmarks.studio_page`` measures all, ``python -m benchmarks.studio_page gain space`` some of it (``--help`` names them). Needs
Chromium, which ``make test`` installs. The page is asked nothing while it works: each question would take processor time from what is
measured. Errors and warnings, which curves do not wait for, are left out. Its resolution is that of the preview, so that no full resolution
follows; processor times, of the server with its workers and of the page's main thread, are means.
"""

from __future__ import annotations

import argparse
import shutil
import statistics
import time
from collections.abc import Callable, Iterable
from functools import partial
from typing import Any

from playwright.sync_api import sync_playwright

from benchmarks.studio import processor_of_all, served
from coaxshell.apps.studio import limits
from coaxshell.apps.studio.links import fragment
from coaxshell.model import System, presets

UNDISTURBED, BETWEEN = 0.4, 0.3
"""Seconds after a change in which the page is left alone, and from its answer to the next change."""
SLIDERS = {
    "absorbers": ("absorbers", ("absorbers.mass", "absorbers.damping"), range(180, 210, 3)),
    "hybrid": ("hybrid", ("absorbers.mass", "absorbers.damping"), range(180, 210, 3)),
    "gain": ("hybrid", ("control.derivative",), range(70, 80)),
    "laws": ("laws", ("control[1].derivative",), range(286, 296)),
}
"""By what is measured: preset, entries and places of their sliders."""
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

SPATIAL = {"space": ("bare", "0"), "hybrid-space": ("hybrid", "0"), "stations": ("bare", "0, 0.5")}
"""By what is measured: preset and stations of previews in three dimensions; of the hybrid system the slider of a mass too."""
SIZE = "performance.getEntriesByType('resource').filter(one => one.name.endsWith('/api/solve')).at(-1)?.transferSize ?? 0"


def main() -> None:
    """Start a server and a browser and print the medians of what is asked for."""
    names = [*SLIDERS, "structure", *SPATIAL]
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("what", nargs="*", choices=[[], *names], metavar="what", help=", ".join(names))
    what = parser.parse_args().what or names
    with served() as (address, pid), sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        page = browser.new_page(viewport={"width": 1280, "height": 720})
        page.route("**/judgement", lambda route: route.fulfill(json={"estimates": None, "warnings": []}))
        watch = Watch(page, pid)
        page.request.get(address)  # the key in the address becomes a cookie; opened, the page would begin to solve
        for name in what:
            if name in SPATIAL:
                _in_space(page, watch, address, *SPATIAL[name])
            elif name == "structure":
                _of_structure(page, watch, address)
            else:
                preset, paths, places = SLIDERS[name]
                for path in paths:
                    _open(page, address, _system(preset), limits.table_of(limits.PREVIEW))
                    watch.told(f"{preset}, {path}", _moves(page, path, places))
        browser.close()


def _moves(page: Any, path: str, places: Iterable[int]) -> list[Callable[[], object]]:
    return [partial(page.evaluate, MOVE, [path, str(place)]) for place in places]


def _of_structure(page: Any, watch: Watch, address: str) -> None:
    """Measure entries of the structure, typed."""
    _open(page, address, _system("hybrid"), limits.table_of(limits.PREVIEW))
    page.evaluate("for (const part of document.querySelectorAll('#form details')) part.open = true")
    for path, texts in ENTRIES:
        box = page.locator(f'input[type=text][data-path="{path}"]').first
        watch.told(f"hybrid, {path}", [partial(_type, box, text) for text in texts])


def _in_space(page: Any, watch: Watch, address: str, preset: str, stations: str) -> None:
    """Measure a page from its address to the curves of a preview in three dimensions, and a slider of the absorbers, if there are any."""
    table = limits.table_of(limits.PREVIEW_SPATIAL) | {"stations": [float(one) for one in stations.split(",")]}
    before = watch.spent()[0]
    drawn, whole = _open(page, address, _system(preset), table)
    server = watch.spent()[0] - before
    told = f"{drawn:.1f} s with the page's opening, {whole:.1f} s with the bare system; server {server:.2f} s of processor time"
    print(f"{preset} in three dimensions, stations {stations}: {told}", flush=True)
    if preset == "hybrid":
        watch.told(f"{preset} in three dimensions, absorbers.mass", _moves(page, "absorbers.mass", range(190, 205, 3)))


def _system(name: str) -> System:
    """Return a preset, or the one with electrodes under a law for each shell."""
    if name != "laws":
        return presets.load(name)
    system = presets.load("electrodes")
    assert system.control is not None
    return system.replace(control=[system.control.replace(shells=[shell]) for shell in (0, 1)])


def _open(page: Any, address: str, system: System, resolution: dict[str, Any]) -> tuple[float, float]:
    """Open a system at a resolution; return the seconds until it is drawn, and until it and the bare one are."""
    held = {"v": 1, "system": system.model_dump(mode="json"), "resolution": resolution}
    page.goto(address.partition("?")[0] + "page/icon.svg")
    begun = time.perf_counter()
    page.goto(f"{address}#{fragment(held)}")
    _wait(page, "Boolean(window.coaxshell?.state?.runs?.current)")
    drawn = time.perf_counter() - begun
    _wait(page, "!window.coaxshell.state.job")
    bare = "!window.coaxshell.state.system.control && !window.coaxshell.state.system.absorbers?.count"
    _wait(page, f"Boolean(window.coaxshell.state.runs.bare || ({bare}))")
    whole = time.perf_counter() - begun
    time.sleep(1.5)  # errors and warnings, and what stands for full resolution
    return drawn, whole


def _type(box: Any, text: str) -> None:
    box.fill(text)
    box.press("Enter")


class Watch:
    """What changes on a page take: from event to curves by its own clock, and processor time."""

    def __init__(self, page: Any, pid: int) -> None:
        self._page, self._pid = page, pid
        self._session = page.context.new_cdp_session(page)
        self._session.send("Performance.enable", {"timeDomain": "threadTicks"})

    def spent(self) -> tuple[float, float]:
        """Return processor time of the server with its workers and of the page's main thread so far, s."""
        found = {one["name"]: one["value"] for one in self._session.send("Performance.getMetrics")["metrics"]}
        return processor_of_all(self._pid), found["TaskDuration"]

    def told(self, what: str, changes: list[Callable[[], object]]) -> None:
        """Carry out changes and print what they took, with the size of their answers."""
        before = self.spent()
        taken = [_timed(self._page, change) for change in changes]
        server, page = (1e3 * (after - start) / len(changes) for after, start in zip(self.spent(), before, strict=True))
        size = self._page.evaluate(SIZE)
        spread = f"median {statistics.median(taken):.0f} ms, {min(taken):.0f} to {max(taken):.0f}, first {taken[0]:.0f}"
        print(f"{what}: {spread}; server {server:.0f} ms, page {page:.0f} ms of processor time, answer {size / 1e3:.0f} kB", flush=True)


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
    """Wait for up to two minutes; the page's own policy forbids playwright's way, which evaluates text there."""
    for _ in range(2400):
        if page.evaluate(condition):
            return
        time.sleep(0.05)
    raise TimeoutError(condition)


if __name__ == "__main__":
    main()
