"""Three dimensions on the page: chosen, solved with progress, read at stations, laid flat, kept in links; fit for people."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose
from page_reading import run_of, shown_curves, unpacked, until, violations

import coaxshell as cx
from coaxshell.apps.studio.links import fragment

SINGLE = 1.001 * 2.0**-24
SPACE = {"duration": 1.0, "time_step": 0.02, "modes": 6, "refinement": 1, "dimensions": 3, "stations": [0.0, 0.5]}
SOLVED = "window.coaxshell?.state.runs.current?.stations?.length === 2 && !window.coaxshell.state.job"
WALL = """() => {
  const {x, y, z} = document.getElementById('wall-plot').data[0];
  const bytes = new Uint8Array(Float32Array.from(z.flatMap(line => Array.from(line))).buffer);
  return {x: Array.from(x), y: Array.from(y), z: btoa(String.fromCharCode(...bytes))};
}"""


def linked(server, preset="bare", **changes):
    held = {"v": 1, "system": cx.presets.load(preset).model_dump(mode="json"), "resolution": {**SPACE, **changes}}
    return f"{server.address}#{fragment(held)}"


@pytest.fixture
def page(open_page, server):
    page = open_page(linked(server), wait=False)
    until(page, SOLVED)
    return page


def test_histories_and_walls_are_the_library_s_at_each_station(page):
    library = cx.simulate("bare", **SPACE)
    page.locator("#station").select_option("0.5")
    until(page, "window.coaxshell.state.station === 0.5")
    until(page, "document.getElementById('curves').getAttribute('aria-label').includes('z = 0.5')")
    ours = library.stress("inner", angle=[0, 180], station=0.5).to_numpy().T
    drawn = [y for name, _, y, _ in shown_curves(page) if name == "current"]
    for history in ours:
        shape = history / np.abs(history).max()
        assert any(np.allclose(y / np.abs(y).max(), shape, atol=1e-5) for y in drawn)
    bars = {(bar["name"], bar["shell"]): bar for bar in run_of(page)["bars"]}
    largest = library.summary().largest[1]["von_mises_stress"]
    assert (bars["von_mises_stress", 1]["value"], bars["von_mises_stress", 1]["station"]) == (largest["value"], largest["station"])
    assert page.locator("table.along tbody tr").count() > 20
    assert not page.locator(".of-old").is_visible()
    page.locator("#tab-wall").click()
    until(page, "document.getElementById('wall-plot').data")
    page.locator("#wall-scrub").focus()
    page.keyboard.press("End")
    until(page, "document.getElementById('wall-time').textContent.startsWith('t = 1 ')")
    told = page.evaluate(WALL)
    assert told["y"] == [-0.5, 0.0, 0.5]
    drawn = unpacked(told["z"], "Float32Array").reshape(3, -1)
    ours = library.stress("outer", angle=told["x"])[-1].to_numpy()
    scale = np.abs(ours).max() / np.abs(drawn[1:]).max()
    assert_allclose(drawn[1:] * scale, ours, rtol=0, atol=1e-5 * np.abs(ours).max())


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["along", "all"])
def test_cuts_and_energy_wait_until_asked_for_and_tell_their_cost(page, whole):
    page.locator("#tab-wave").press("Enter")
    until(page, r"/about [\d.]+.(s|min)/.test(document.getElementById('wave-ask').textContent)")
    page.locator("#wave-ask").press("Enter")
    assert page.evaluate("document.activeElement.id") == "wave-cut"
    until(page, "document.getElementById('field-current').getAttribute('aria-label').endsWith('along the axis')")
    assert not page.locator("#wave-ask").is_visible()
    page.locator("#field-current").press("ArrowUp")
    assert "z = 0.05 (radii)" in page.locator("#wave-point").inner_text()
    page.set_viewport_size({"width": 390, "height": 844})
    until(page, "document.documentElement.scrollWidth <= 390")  # plots follow the window in a moment
    assert violations(page, "#more") == []
    if not whole:
        return
    page.set_viewport_size({"width": 1280, "height": 720})
    page.locator("#wave-cut").select_option(label="across, z = 0.5\u202fm")
    page.locator("#wave-ask").press("Enter")
    until(page, "document.getElementById('field-current').getAttribute('aria-label').endsWith('across, z = 0.5\\u202fm')")
    assert "y = 0.05 (radii)" in page.locator("#wave-point").inner_text()
    page.locator("#wave-cut").select_option("along")
    assert page.locator("#wave-ask").is_visible(), "one cut a run is kept"
    assert violations(page, "#more") == []
    page.locator("#tab-energy").click()
    until(page, r"/whole length, about [\d.]+.(s|min)/.test(document.getElementById('energy-ask')?.textContent)")
    page.locator("#energy-ask").press("Enter")
    until(page, "document.getElementById('energy-plot')?.data")
    assert violations(page, "#more") == []
    page.locator('[data-path="resolution.dimensions"]').select_option("2")
    until(page, "window.coaxshell.state.runs.current && !window.coaxshell.state.runs.current.stations")
    assert "stations" not in page.evaluate("window.coaxshell.state.resolution")
    page.locator("#tab-wave").click()
    until(page, "document.getElementById('field-current').getAttribute('aria-label').endsWith('system')")
    assert not page.locator("#wave-cut").is_visible()


def test_what_is_described_is_solved_before_the_bare_system(kept_page, open_page, server):
    asked = []

    def told(what, request):
        if request.url.endswith("/api/jobs"):
            asked.append((what, request.post_data_json["slot"]))

    heard = {"request": lambda request: told("asked", request), "response": lambda response: told("answered", response.request)}
    for event, hear in heard.items():
        kept_page.on(event, hear)
    page = open_page(linked(server, "hybrid", stations=[0.0], modes=3, time_step=0.05), drawing=False)
    for event, hear in heard.items():
        page.remove_listener(event, hear)
    assert asked == [(what, f"{slot}-full") for slot in ("current", "bare") for what in ("asked", "answered")]


def test_three_dimensions_are_chosen_and_told_their_cost(linked_page):
    page = linked_page({**SPACE, "dimensions": 2, "stations": [0.0]}, preset="bare")
    page.locator('details[data-group="dimensions"]').evaluate("box => { box.open = true; }")
    page.locator('[data-path="resolution.dimensions"]').select_option("3")
    until(page, "window.coaxshell.state.resolution.dimensions === 3")
    until(page, "/full resolution takes about [\\d.]+.(s|min)/i.test(document.getElementById('cost')?.textContent)")
    field = page.locator('[data-path="resolution.stations"]')
    field.fill("0, 1 s")
    field.press("Enter")
    page.locator("#field-problem").wait_for()
    assert "is not a length" in page.locator("#field-problem").inner_text()
    field.fill("0, 40 cm")
    field.press("Enter")
    until(page, "window.coaxshell.state.runs.current?.stations?.length === 2")
    assert page.evaluate("window.coaxshell.state.runs.current.stations") == [0.0, 0.4]


@pytest.mark.slow
def test_three_dimensions_are_chosen_by_keyboard_with_their_cost_and_can_be_stopped(open_page, server):
    page = open_page(linked(server, dimensions=2, stations=[0.0], modes=40, time_step=1e-3, duration=4.0), wait=False)
    until(page, "window.coaxshell?.state.runs.current?.full")
    held = []
    page.route("**/api/runs/*", lambda route: held.append(route))  # the preview is not shown before it is stopped
    page.locator('details[data-group="dimensions"] > summary').press("Enter")
    page.locator('[data-path="resolution.dimensions"]').focus()
    page.keyboard.press("t")
    page.keyboard.press("ArrowDown")
    until(page, "window.coaxshell.state.resolution.dimensions === 3")
    until(page, "/full resolution takes about [\\d.]+.(s|min)/i.test(document.getElementById('cost')?.textContent)")
    until(page, "window.coaxshell.state.job?.fraction > 0")
    page.locator("#cancel").click()
    assert "Stopped" in page.locator("#state").inner_text()
    assert page.locator("#refine").inner_text() == "Solve the preview"
    assert page.locator(".of-old").is_visible()
    for route in held:
        route.continue_()
    page.unroute_all()
    field = page.locator('[data-path="resolution.stations"]')
    field.fill("0, 1 s")
    field.press("Enter")
    page.locator("#field-problem").wait_for()
    assert "is not a length" in page.locator("#field-problem").inner_text()
    field.fill("0, 40 cm")
    field.press("Enter")
    until(page, "window.coaxshell.state.runs.current?.stations?.length === 2")
    assert page.evaluate("window.coaxshell.state.runs.current.stations") == [0.0, 0.4]
    assert page.locator("#refine").inner_text().startswith("Full resolution, about")
    assert not page.locator(".of-old").is_visible()


SIZES = [(1280, 800, "dark"), (1920, 1080, "light"), (390, 844, "light")]


@pytest.mark.slow
@pytest.mark.parametrize("size", SIZES, ids=["dark", "wide", "phone"])
def test_axe_finds_nothing_wrong_and_nothing_is_too_wide(open_page, server, size):
    width, height, theme = size
    page = open_page(linked(server), width=width, height=height, theme=theme, wait=False)
    until(page, SOLVED)
    page.locator('details[data-group="dimensions"]').evaluate("box => { box.open = true; }")
    for tab in ("peaks", "wall", "energy", "wave"):
        page.locator(f"#tab-{tab}").click()
        if tab == "wall":
            until(page, "document.getElementById('wall-plot').data")
        assert violations(page, "#more") == [], tab
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert violations(page) == []
