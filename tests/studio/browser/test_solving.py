"""The page solves what the library solves: on loading, on every change, and in full resolution."""

from __future__ import annotations

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose
from page_reading import rest, run_of, shown_curves, solved, system_of, until

import coaxshell as cx

SINGLE = 1.001 * 2.0**-24
"""Histories travel in single precision."""


def assert_same_stress(page, system):
    """Compare what is shown with the library's answer at the resolution of what is shown: the full one may have come meanwhile."""
    run = run_of(page)
    response = solved(system, run["resolution"])
    for index, shell in enumerate(("inner", "outer")):
        ours = np.asarray(response.stress(shell, angle=[0, 180])).T
        assert_allclose(run["arrays"][f"stress/{index}"], ours, rtol=0, atol=SINGLE * np.abs(ours).max())
    summary = response.summary()
    values = {(bar["name"], bar["shell"]): bar["value"] for bar in run["bars"] if "shell" in bar and bar["shell"] is not None}
    for index, shell in enumerate(summary.shells):
        assert_allclose(values["stress", index], shell.stress.value, rtol=1e-9)
        assert_allclose(values["stress_rms", index], shell.stress_rms, rtol=1e-9)


@pytest.mark.slow
def test_the_first_page_shows_the_library_s_hybrid_case(page):
    assert system_of(page) == cx.presets.load("hybrid")
    until(page, "window.coaxshell.state.runs.current.full")  # nothing more is on its way that could change it meanwhile
    page.wait_for_timeout(300)
    assert_same_stress(page, cx.presets.load("hybrid"))
    drawn = shown_curves(page)
    assert {name for name, *_ in drawn} >= {"current", "bare"}
    stress = run_of(page)["arrays"]["stress/0"][0]
    shapes = [y / np.abs(y).max() for name, _, y, _ in drawn if name == "current"]
    assert any(len(y) == len(stress) and np.allclose(y, stress / np.abs(stress).max(), atol=1e-5) for y in shapes)
    assert page.locator("#peaks table").is_visible()


@pytest.fixture
def small_page(linked_page):
    """The same system at a resolution that takes hundredths of a second."""
    return linked_page(preset="hybrid")


def test_a_slider_changes_the_curves_to_the_library_s_numbers(small_page):
    page = small_page
    slider = page.locator('input[type="range"][data-path="absorbers.count"]')
    slider.focus()
    for _ in range(3):
        slider.press("ArrowLeft")
    rest(page)
    system = system_of(page)
    assert system.absorbers.count == 22
    assert_same_stress(page, system)
    times = page.evaluate("window.coaxshell.times")
    assert len(times) >= 2


LINES = """() => [...document.querySelectorAll('#curves .scatterlayer .trace')].map(one => {
  const {trace} = one.__data__[0], d = one.querySelector('.js-line').getAttribute('d');
  const {[trace.yaxis.replace('y', 'yaxis')]: axis} = document.getElementById('curves')._fullLayout;
  return trace.name === 'current' && d.slice(1).split('L').map(place => axis.p2l(Number(place.split(',')[1])));
}).filter(Boolean)"""
"""What the lines of the current system mean on their axes."""


LOOK = f"""() => {{
  const lines = {LINES}, box = document.getElementById('curves'), before = lines();
  const told = window.told = {{before, moved: null, drawn: null, early: 0}};
  const seen = new MutationObserver(() => {{
    if (told.moved || JSON.stringify(lines()) === JSON.stringify(before)) return;
    told.moved = lines();
    seen.disconnect();
  }});
  seen.observe(box, {{subtree: true, childList: true, attributeFilter: ['d']}});
  box.on('plotly_afterplot', () => {{ if (told.moved) told.drawn ??= lines(); else told.early += 1; }});
}}"""
"""Keep what the lines mean when they first differ, and when plotly next draws: the page does both sooner than anyone outside could ask."""


def test_lines_that_a_slider_moves_are_those_that_plotly_draws_at_rest(linked_page):
    page = linked_page()
    page.evaluate(LOOK)
    page.locator('input[type="range"][data-path="absorbers.mass"]').press("ArrowRight")
    until(page, "window.told.drawn !== null")
    before, moved, drawn, early = page.evaluate("[window.told.before, window.told.moved, window.told.drawn, window.told.early]")
    assert early == 0
    assert len(moved) == len(drawn) == 4
    assert_allclose(moved, drawn, rtol=0, atol=4e-4 * np.abs(drawn).max())  # a hundredth of a pixel, to which both are rounded
    assert np.abs(np.subtract(moved, before)).max() > 2e-3 * np.abs(drawn).max()


def test_a_typed_quantity_is_read_with_its_unit_and_can_be_undone(small_page):
    page = small_page
    field = page.locator('input[type="text"][data-path="source.peak_pressure"]')
    page.locator('details[data-group="source"]').evaluate("box => { box.open = true; }")
    field.fill("50 kPa")
    field.press("Enter")
    until(page, "window.coaxshell.state.system.source.peak_pressure === 5e4")
    rest(page)
    assert_same_stress(page, cx.presets.load("hybrid").with_overrides({"source.peak_pressure": "50 kPa"}))
    page.locator("#undo").click()
    until(page, "window.coaxshell.state.system.source.peak_pressure === 2.5e4")


def test_bad_input_is_told_beside_its_field_in_the_library_s_words(small_page):
    page = small_page
    page.locator('details[data-group="absorbers"]').evaluate("box => { box.open = true; }")
    field = page.locator('input[type="text"][data-path="absorbers.mass"]')
    field.fill("-3 kg")
    field.press("Enter")
    message = page.locator("#field-problem")
    message.wait_for()
    with pytest.raises(cx.InputError) as told:
        cx.presets.load("hybrid").with_overrides({"absorbers.mass": "-3 kg"})
    assert told.value.problem in message.inner_text()
    assert told.value.remedy in message.inner_text()
    assert field.get_attribute("aria-invalid") == "true"
    assert "Not solved" in page.locator("#state").inner_text()
    field.fill("3 kg")
    field.press("Enter")
    until(page, "window.coaxshell.state.system.absorbers.mass === 3")
    rest(page)
    assert page.locator("#field-problem").count() == 0


def test_full_resolution_is_asked_for_once_what_was_under_way_is_cancelled(linked_page):
    page = linked_page({"duration": 4.0, "time_step": 2e-3, "modes": 60}, preset="active")
    page.locator('details[data-group="source"]').evaluate("box => { box.open = true; }")
    field = page.locator('input[type="text"][data-path="source.peak_pressure"]')
    field.fill("73 kPa")
    field.press("Enter")
    until(page, "(({full, system}) => full && system.source.peak_pressure === 73e3)(window.coaxshell.state.runs.current)")
    assert run_of(page)["resolution"]["modes"] == 60
    page.locator("#refine").wait_for(state="hidden")  # the run of the link before was whole too


@pytest.mark.slow
def test_full_resolution_follows_by_itself_and_can_be_cancelled(page):
    held = []
    page.route("**/api/runs/*", lambda route: held.append(route))  # it is not done before it is cancelled
    field = page.locator('input[type="text"][data-path="absorbers.mass"]')
    field.fill("7.3 kg")  # nobody has asked for this one before
    field.press("Enter")
    page.locator("#progress").wait_for()
    page.locator("#cancel").click()
    page.locator("#progress").wait_for(state="hidden")
    for route in held:
        route.continue_()
    page.unroute_all()
    page.locator("#refine").wait_for()
    assert "Preview" in page.locator("#state").inner_text()
    page.locator("#refine").click()
    until(page, "window.coaxshell.state.runs.current.full")
    run = run_of(page)
    assert (run["resolution"]["modes"], run["resolution"]["time_step"]) == (150, 1e-3)
    assert len(run["arrays"]["time"]) == 5001


def test_a_pinned_run_stays_while_the_system_changes(linked_page):
    page = linked_page({"duration": 5.0, "time_step": 0.02, "modes": 12}, preset="hybrid")
    page.locator("#pin").click()
    until(page, "window.coaxshell.state.runs.pinned")
    before = run_of(page, "pinned")["arrays"]["stress/0"]
    page.locator("#preset").select_option(label="active")
    until(page, "window.coaxshell.state.system.name && window.coaxshell.state.system.absorbers.length === 0")
    rest(page)
    pinned, current = run_of(page, "pinned")["arrays"]["stress/0"], run_of(page)["arrays"]["stress/0"]
    assert_allclose(pinned, before, rtol=0, atol=0)
    assert np.abs(current - before).max() > 0.1 * np.abs(before).max()
    assert "pinned" in {name for name, *_ in shown_curves(page)}
    told = page.locator("#peaks td.better, #peaks td.worse").all_inner_texts()
    assert told
    assert all(re.fullmatch(r"(smaller|larger) by \d+\.\d\u202f%|[\d.]+ times as large", text) for text in told), told
    growing = {(bar["name"], bar["shell"]) for bar in run_of(page)["bars"] if bar.get("growing")}
    assert ("displacement_head", 0) in growing
    row = page.locator("#peaks tr", has=page.locator("[data-bar='displacement_head/0']"))
    assert row.locator("td").last.inner_text() == "still growing"  # it depends on the run's length, and is no change for better or worse
    assert row.locator("td.better, td.worse").count() == 0
    page.locator("#pin").click()
    until(page, "!window.coaxshell.state.runs.pinned")
