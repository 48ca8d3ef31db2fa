"""Named designs: kept, compared in the library's numbers, differences marked, taken home and opened again."""

from __future__ import annotations

import numpy as np
import pytest
from asking import SMALL
from numpy.testing import assert_allclose
from page_reading import open_preset, until, violations

import coaxshell as cx

SOLVED = "rows => document.querySelector('#designs [aria-label=\"Designs compared\"] thead')?.querySelectorAll('th').length === rows + 1"


def keep(page, name):
    page.locator("#design-name").fill(name)
    page.get_by_role("button", name="Keep this design").click()


def mass(page, text, value):
    field = page.locator('input[type="text"][data-path="absorbers.mass"]')
    field.fill(text)
    field.press("Enter")
    until(page, f"window.coaxshell.state.system.absorbers.mass === {value}")


def cells(page, table, row):
    found = page.get_by_role("region", name=table).locator("tbody tr", has=page.get_by_role("rowheader", name=row, exact=True))
    return found.first.locator("td").all_inner_texts()


@pytest.mark.parametrize("again", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["compared", "opened again"])
def test_designs_are_kept_compared_and_opened_again(server, open_page, again):
    page = open_preset(open_page, server, SMALL)
    page.locator("#tab-designs").click()
    assert "No design is kept yet" in page.locator("#designs").inner_text()
    keep(page, "light")
    mass(page, "40 kg/m", 40)
    keep(page, "heavy")
    until(page, SOLVED, 2)
    light, heavy = (cx.simulate(cx.presets.load("absorbers").with_overrides({"absorbers.mass": m}), **SMALL) for m in (10, 40))
    peaks = [run.summary().shells[0].stress.value for run in (light, heavy)]
    shown = cells(page, "Designs compared", "peak stress anywhere")
    assert [text.partition("\u202fkPa")[0] for text in shown] == [f"{peak / 1e3:.4g}" for peak in peaks]
    percent = 100 * (peaks[1] / peaks[0] - 1)
    assert f"{'smaller' if percent < 0 else 'larger'} by {abs(percent):.1f}" in shown[1]
    assert page.locator("#designs .most").count() >= 4
    assert cells(page, "What differs", "Absorbers, mass") == ["10\u202fkg/m", "40\u202fkg/m"]
    assert page.locator("#designs .differs").all_inner_texts() == ["40\u202fkg/m"]
    until(page, "document.getElementById('designs-plot').data?.length === 2")
    drawn = page.evaluate("document.getElementById('designs-plot').data.map(({name, y}) => [name, Array.from(y)])")
    ours = np.asarray(heavy.stress("inner", angle=0))
    assert drawn[1][0] == "heavy"
    assert_allclose(np.array(drawn[1][1]) / np.abs(drawn[1][1]).max(), ours / np.abs(ours).max(), rtol=0, atol=1e-6)
    assert violations(page, "#designs") == []
    if not again:
        return
    with page.expect_download() as saved:
        page.get_by_role("button", name="Save project").click()
    path = saved.value.path()
    page.reload()
    until(page, SOLVED, 2)  # kept over a reload
    for name in ("light", "heavy"):
        page.get_by_role("button", name=f"Remove {name}").click()
    page.locator("#file").set_input_files({"name": "p.toml", "mimeType": "application/toml", "buffer": path.read_bytes()})
    until(page, SOLVED, 2)
    page.get_by_role("button", name="Put into the form: light").click()
    until(page, "window.coaxshell.state.system.absorbers.mass === 10 && window.coaxshell.state.from === 'light'")
    page.get_by_role("button", name="Keep this design").click()
    until(page, SOLVED, 3)
    for width in (1280, 390):
        page.set_viewport_size({"width": width, "height": 844})
        until(page, "width => document.documentElement.scrollWidth <= width", width)  # plots follow the window in a moment
