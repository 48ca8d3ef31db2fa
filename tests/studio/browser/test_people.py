"""Fit for people: no violation that axe-core finds, light and dark, every tab; keyboard; nothing wider than its window."""

from __future__ import annotations

import pytest
from asking import SMALL
from page_reading import open_preset, system_of, until, violations

import coaxshell as cx
from coaxshell.model.places import region_side, shell_name, shell_phrase

TABS = ("peaks", "wave", "wall", "energy", "designs", "studies")


DRAWN = """theme => document.documentElement.dataset.theme === theme && [...document.querySelectorAll('.js-plotly-plot')].every(
  plot => !plot.offsetParent || plot.layout.font.color === getComputedStyle(document.documentElement).getPropertyValue('--muted').trim(),
)"""
"""Whether what is shown has been drawn in the colours of a theme."""

COLOURS = ["color-contrast", "link-in-text-block"]
"""The rules of axe-core's defaults that look at colours."""


@pytest.mark.slow
def test_axe_finds_nothing_wrong_in_either_theme(open_page, server):
    page = open_preset(open_page, server, SMALL, preset="hybrid")
    for theme, rules in (("light", None), ("dark", COLOURS)):  # what has no colour is the same in both

        def nothing_is_wrong(what, place="#more", theme=theme, rules=rules):
            until(page, DRAWN, theme)
            assert violations(page, place, rules) == [], f"{what}, {theme}"

        page.emulate_media(color_scheme=theme)
        for tab in TABS:
            page.locator(f"#tab-{tab}").click()
            nothing_is_wrong(tab)
        # Warnings of the run before, while those of the new one are computed, can still be read.
        page.locator("#tab-peaks").click()
        page.locator(".warnings li").first.wait_for()
        page.evaluate("document.getElementById('peaks').classList.add('unjudged')")
        nothing_is_wrong("not judged yet")
        page.locator("#form details").evaluate_all("boxes => boxes.forEach(box => { box.open = true; })")
        nothing_is_wrong("the whole page", None)


def test_axe_finds_nothing_wrong_on_a_dark_phone_with_a_problem_shown(linked_page):
    page = linked_page(preset="hybrid", width=390, height=844, theme="dark")
    until(page, DRAWN, "dark")
    for tab in TABS:
        page.locator(f"#tab-{tab}").click()
        until(page, DRAWN, "dark")
        assert violations(page, "#more") == [], tab
    page.locator("#form details").evaluate_all("boxes => boxes.forEach(box => { box.open = true; })")
    field = page.locator('input[type="text"][data-path="absorbers.mass"]')
    field.fill("heavy")
    field.press("Enter")
    page.locator("#field-problem").wait_for()
    assert violations(page) == []


def test_nothing_is_wider_than_the_window_and_the_tabs_move_by_arrow_keys(linked_page):
    page = linked_page(preset="hybrid")
    for width, height in ((1280, 720), (390, 844)):
        page.set_viewport_size({"width": width, "height": height})
        for tab in TABS:
            page.locator(f"#tab-{tab}").click()
            until(page, "width => document.documentElement.scrollWidth <= width", width)  # plots follow the window in a moment
    page.locator("#tab-peaks").focus()
    page.keyboard.press("ArrowRight")
    assert page.evaluate("document.activeElement.id") == "tab-wave"
    page.keyboard.press("End")
    assert page.evaluate("document.activeElement.id") == "tab-studies"


def test_the_theme_can_be_switched_and_is_kept(open_page):
    page = open_page(wait=False, drawing=False)
    until(page, "window.coaxshell?.state.system")
    assert page.evaluate("document.documentElement.dataset.theme") == "light"
    page.locator("#theme").click()
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    page.reload()
    until(page, "window.coaxshell?.state.system")
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
    assert system_of(page) == cx.presets.load("hybrid"), "what a first page shows"


NAMES = """async count => {
  const {shellName, shellPhrase, regionSide} = await import('/page/js/words.js'), upTo = length => Array.from({length}, (_, i) => i);
  return [...[shellName, shellPhrase].map(name => upTo(count).map(i => name(i, count))), upTo(count + 1).map(i => regionSide(i, count))];
}"""


TOLD = """async () => {
  const {inWords} = await import('/page/js/words.js'), {span} = await import('/page/js/ranges.js');
  const {spelt} = await import('/page/js/study_fields.js');
  return [inWords('use wetted = "faces" (about 6 %) or theory = "elastic"'), inWords('use refinement = 2'), spelt('inner.peak_stress'),
          spelt('shells[0].layers[1].thickness'), span('control.derivative', 0, true), span('control.derivative', 0)];
}"""


def test_the_page_tells_entries_by_its_own_words_and_ranges_of_gains_by_their_layers(linked_page):
    assert linked_page().evaluate(TOLD) == [
        "use Wetted “faces” (about 6 %) or Theory “elastic”",
        "use Refinement 2",
        "inner · peak stress",
        "inner · layer 2 · thickness",
        {"from": 0, "to": 10, "scale": "linear"},
        {"from": -1000, "to": 0, "scale": "linear"},
    ]


def test_the_page_names_shells_and_fluids_as_the_library_does(linked_page):
    page = linked_page()
    for count in (1, 2, 3, 12):
        library = [[name(i, count) for i in range(count)] for name in (shell_name, shell_phrase)]
        assert page.evaluate(NAMES, count) == [*library, [region_side(i, count) for i in range(count + 1)]]
