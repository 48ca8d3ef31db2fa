"""The pressure field on the page: it moves, and its values are the library's."""

from __future__ import annotations

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose
from page_reading import PACKED, open_preset, run_of, system_of, unpacked, until

import coaxshell as cx

PIXELS = f"""id => {{
  {PACKED}
  const canvas = document.getElementById(id);
  return packed(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data);
}}"""
PREFIX = {"": 1.0, "k": 1e3, "M": 1e6, "m": 1e-3}


def pixels(page, name):
    return unpacked(page.evaluate(PIXELS, f"field-{name}"), "Uint8ClampedArray")


SMALL = {"duration": 2.0, "time_step": 0.01, "modes": 20, "refinement": 1}


def test_the_field_plays_and_its_values_are_the_library_s(linked_page):
    page = linked_page(SMALL)
    page.locator("#tab-wave").click()
    until(page, "document.getElementById('wave-time').textContent.includes('t =')")
    page.locator("#scrub").evaluate("input => { input.value = 1.0; input.dispatchEvent(new Event('input')); }")
    still = {name: pixels(page, name) for name in ("bare", "current")}
    assert len(np.unique(still["current"])) > 50
    page.locator("#play").click()
    until(page, "Number(document.getElementById('scrub').value) > 1.3")
    page.locator("#play").click()
    for name, before in still.items():
        assert np.mean(pixels(page, name) != before) > 0.02
    page.locator("#scrub").evaluate("input => { input.value = 1.0; input.dispatchEvent(new Event('input')); }")
    settings = run_of(page)["resolution"]
    response = cx.simulate(system_of(page), **{name: settings[name] for name in ("duration", "time_step", "modes")})
    page.locator("#field-current").focus()
    for _ in range(4):
        page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowUp")
    assert "about" in reading(page)  # from the picture, at once
    until(page, "!/about|above|below/.test(document.getElementById('wave-point').textContent)")
    told = reading(page)
    assert "x = -0.20, y = 0.05" in told
    exact = float(response.pressure(x=[-0.2], y=[0.05], time=[1.0]).squeeze())
    assert_allclose(pascal(told, "current"), exact, rtol=6e-3)


def reading(page):
    return page.locator("#wave-point").inner_text().replace("\u2212", "-").replace("\u202f", " ")


def pascal(told, name):
    value, prefix = re.search(rf"{name} (-?[\d.]+) (\w*)Pa", told).groups()
    return float(value) * PREFIX[prefix]


def test_what_the_shells_radiate_is_seen_beside_the_front(linked_page):
    """A hundredth of the largest pressure has a colour of its own, and the colours' bar says the same as the picture."""
    page = linked_page(SMALL)
    shades = page.evaluate(
        "import('/page/js/maps.js').then(({ words }) => [...words()].map((word) => [0, 8, 16].map((bits) => (word >> bits) & 255)))"
    )
    plain, faint, end = (np.array(shades[q]) for q in (128, 128 + round(0.04 * 127), 255))
    assert np.abs(faint - plain).max() >= 15
    assert np.abs(end - plain).max() > 150


@pytest.mark.slow
def test_all_panels_share_their_colours_and_a_pinned_run_has_one(server, open_page):
    page = open_preset(open_page, server, SMALL)
    page.locator("#pin").click()
    until(page, "!!window.coaxshell.state.runs.pinned")
    page.locator("#tab-wave").click()
    until(page, "document.getElementById('wave-time').textContent.includes('t =') && !document.getElementById('wave-state').textContent")
    page.locator("#scrub").evaluate("input => { input.value = 0.1; input.dispatchEvent(new Event('input')); }")
    corner = {name: pixels(page, name).reshape(480, 480, 4)[:100] for name in ("bare", "pinned", "current")}
    assert np.ptp(corner["bare"][..., 1].astype(int)) > 50  # the front, which has not met the shells there
    for name in ("pinned", "current"):
        assert np.abs(corner[name].astype(int) - corner["bare"].astype(int)).max() <= 6  # two levels
