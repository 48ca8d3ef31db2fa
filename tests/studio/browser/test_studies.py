"""A sweep started from the page comes to the library's numbers; one that runs can be cancelled; a bad one is told."""

from __future__ import annotations

import numpy as np
import pytest
from asking import SMALL
from numpy.testing import assert_allclose
from page_reading import open_preset, until

import coaxshell as cx

SECONDS = {"duration": 4.0, "time_step": 0.01, "modes": 20}
"""A resolution at which a sweep of some tens of runs takes seconds."""

ENTRIES = (
    "entries => { const f = document.getElementById('sweep').elements; for (const [k, v] of Object.entries(entries)) f[k].value = v; }"
)


def start(page, *, refused=False, **entries):
    """Start a sweep and wait until it is listed, unless it is refused, before those of earlier tests; what these have come to is gone."""
    page.locator("#tab-studies").click()
    page.get_by_role("radio", name="Sweep").check(force=True)
    page.locator("#sweep").wait_for()
    before = page.evaluate("document.getElementById('study-jobs').children.length")
    page.evaluate("document.getElementById('study-result').replaceChildren()")
    page.evaluate(ENTRIES, {name.rstrip("_"): str(value) for name, value in entries.items()})
    page.locator("#sweep button.main").click()
    if not refused:
        until(page, "before => document.getElementById('study-jobs').children.length > before", before)


def test_a_sweep_from_the_page_comes_to_the_library_s_numbers(linked_page):
    page = linked_page()
    start(page, path="absorbers.count", from_=10, to=14, count=3, scale="linear", metric="inner.peak_stress")
    until(page, "document.getElementById('study-plot')?.data?.length")
    shown = np.array(page.evaluate("Array.from(document.getElementById('study-plot').data[0].y)"), dtype=float)
    ours = cx.sweep(cx.presets.load("absorbers"), {"absorbers.count": [10, 12, 14]}, ["inner.peak_stress"], workers=1, **SMALL)
    values = np.asarray(ours["inner.peak_stress"], dtype=float)
    assert_allclose(shown / shown[0], values / values[0], rtol=1e-6)
    with page.expect_download() as saved:
        page.locator('#study-jobs a[href$="/file"]').first.click()
    assert saved.value.failure() is None


def test_a_sweep_can_be_cancelled(linked_page):
    page = linked_page(SECONDS, preset="hybrid")
    start(page, path="absorbers.mass", from_=1, to=100, count=200, scale="linear", metric="inner.peak_stress")
    mine = page.locator("#study-jobs .job").first
    mine.get_by_role("button", name="Cancel").click()
    until(page, "document.querySelector('#study-jobs .job').dataset.state === 'cancelled'")


def again(page):
    """Load the page anew; what its address holds, the tab too, is shown before another tab is chosen."""
    page.reload()
    until(page, "window.coaxshell?.state.runs.current")
    page.locator("#tab-studies").click()


@pytest.mark.parametrize("count", [6, pytest.param(30, marks=pytest.mark.slow)])
def test_a_sweep_outlives_its_page_being_loaded_anew(server, open_page, count):
    page = open_preset(open_page, server, SMALL if count == 6 else SECONDS, preset="hybrid")
    start(page, path="absorbers.mass", from_=2, to=90, count=count, scale="linear", metric="outer.peak_stress")
    mine = page.locator("#study-jobs .job").filter(has_text="outer · peak stress over absorbers · mass").first
    mine.wait_for()
    unheard = []

    def not_yet(route):
        if unheard:
            return route.continue_()
        unheard.append(route)
        return route.fulfill(json={"jobs": []})  # as if the server had not heard yet that the page before has gone

    page.route("**/api/studies", not_yet)
    again(page)
    mine.wait_for()
    assert unheard
    if count > 6:
        until(page, "count => document.getElementById('study-plot')?.data?.[0].x.length === count", count)
        assert mine.get_attribute("data-state") == "done"
        again(page)
    mine.get_by_role("button", name="Show").click()
    until(page, "count => document.getElementById('study-plot')?.data?.[0].x.length === count", count)
    assert mine.get_attribute("data-state") == "done"


def test_a_plot_drawn_while_another_tab_is_shown_fits(linked_page):
    page = linked_page()
    start(page, path="absorbers.mass", from_=2, to=60, count=8, scale="linear", metric="inner.rms_stress")
    page.locator("#tab-peaks").click()
    until(page, "document.getElementById('study-plot')?.data?.[0].x.length === 8")
    page.locator("#tab-studies").click()
    box, drawn = (f"document.querySelector('#study-plot{inner}').clientWidth" for inner in ("", " .main-svg"))
    until(page, f"Math.abs({box} - {drawn}) <= 1")


def test_an_impossible_sweep_is_told_in_words(linked_page):
    page = linked_page()
    start(page, path="absorbers.mass", from_=-5, to=10, count=3, scale="log", metric="inner.peak_stress", refused=True)
    page.locator("#sweep-problem").wait_for()
    assert page.locator("#sweep-problem").inner_text()
