"""The pressure field on the page: it moves, and its values are the library's."""

from __future__ import annotations

import re

import numpy as np
from numpy.testing import assert_allclose
from page_reading import rest, run_of, system_of, until

import coaxshell as cx
from coaxshell.studio.links import fragment

PIXELS = """id => {
  const canvas = document.getElementById(id);
  return Array.from(canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data);
}"""
PREFIX = {"": 1.0, "k": 1e3, "M": 1e6, "m": 1e-3}


def pixels(page, name):
    return np.array(page.evaluate(PIXELS, f"field-{name}"))


SMALL = {"duration": 2.0, "time_step": 0.01, "modes": 20, "refinement": 1}


def test_the_field_plays_and_its_values_are_the_library_s(server, open_page):
    held = {"v": 1, "system": cx.presets.load("absorbers").model_dump(mode="json"), "resolution": SMALL}
    page = open_page(f"{server.address}#{fragment(held)}")
    rest(page)
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
    box = page.locator("#field-current").bounding_box()
    page.mouse.move(box["x"] + 0.625 * box["width"], box["y"] + 0.40 * box["height"])
    told = page.locator("#wave-point").inner_text().replace("\u2212", "-").replace("\u202f", " ")
    x, y = (float(text) for text in re.search(r"x = (-?[\d.]+), y = (-?[\d.]+)", told).groups())
    assert_allclose([x, y], [0.75, 0.6], atol=0.03)
    value, prefix = re.search(r"current (-?[\d.]+) (\w*)Pa", told).groups()
    settings = run_of(page)["resolution"]
    response = cx.simulate(system_of(page), **{name: settings[name] for name in ("duration", "time_step", "modes")})
    every = page.evaluate("window.coaxshell.state.runs.current.arrays.time.values.length")
    frame = np.floor(1.0 / (np.ceil(every / 160) * settings["time_step"])) * np.ceil(every / 160) * settings["time_step"]
    near = np.linspace(-0.03, 0.03, 5)
    field = np.asarray(response.pressure(x=x + near, y=y + near, time=[frame], front="matched"))
    margin = 0.02 * 2.5e4
    assert field.min() - margin <= float(value) * PREFIX[prefix] <= field.max() + margin
