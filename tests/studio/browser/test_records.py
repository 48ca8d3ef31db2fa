"""A measured record on the page: pasted or opened, units and columns chosen, cut; what was understood stands beside it."""

from __future__ import annotations

import numpy as np
import pytest
from asking import SMALL
from numpy.testing import assert_allclose
from page_reading import open_preset, rest, run_of, solved, system_of, until, violations

import coaxshell as cx

PULSE = "window.coaxshell.state.system.source.pulse"


HELD_FROM = """async start => {
  const {request} = await import('/page/js/api.js');
  const {system} = await request('/api/link/open', {body: {fragment: location.hash.slice(1)}});
  return system?.source.pulse?.start === start;
}"""
"""Whether the address holds, half a second after the form, a pulse that is cut at an instant."""


def kind(page, path, label):
    page.locator(f'[id="kind-{path}"]').evaluate(
        "one => { for (let box = one.closest('details'); box; box = box.parentElement.closest('details')) box.open = true; }"
    )
    page.locator(f'[id="kind-{path}"]').select_option(label=label)


def choose(page, name, value):
    page.locator(f'[id="record-source.pulse-{name}"]').select_option(value)


@pytest.mark.slow
def test_a_record_is_pasted_opened_cut_and_solved(server, open_page, tmp_path):
    page = open_preset(open_page, server, SMALL, preset="absorbers")
    kind(page, "source", "Plane wave")
    until(page, "window.coaxshell.state.system.source.type === 'plane-wave'")
    kind(page, "source.pulse", "Sampled")
    until(page, f"{PULSE}.type === 'sampled' && {PULSE}.time.length === 61")
    rest(page)
    # Pasted without units: what is missing is told, then chosen.
    page.locator("details.paste > summary").click()
    page.locator(".record textarea").fill("t, p\n" + "\n".join(f"{0.01 * k:.2f}, {20 * 0.9**k:.6f}" for k in range(50)))
    page.get_by_role("button", name="Read", exact=True).click()
    page.locator('[id="record-source.pulse-time_unit"]').wait_for()
    choose(page, "time_unit", "ms")
    choose(page, "pressure_unit", "kPa")
    until(page, f"{PULSE}.time.length === 50 && Math.abs({PULSE}.pressure[0] - 2e4) < 1")
    assert_allclose(system_of(page).source.pulse.time[-1], 0.49e-3, rtol=1e-12)
    rest(page)
    assert "50 samples over 490" in page.locator(".record").inner_text()
    assert "peak 20 kPa at 0 s" in page.locator(".record").inner_text().replace("\u202f", " ")
    # A file with units in its headings and a column more.
    time = np.arange(400) * 2e-6
    table = np.column_stack([1e3 * time, 1e-3 * 5e4 * np.exp(-time / 1e-4), np.ones(400)])
    path = tmp_path / "gauge.csv"
    np.savetxt(path, table, delimiter=";", header="time (ms);gauge 1 (kPa);gauge 2 (kPa)", comments="")
    page.locator(".record input[type=file]").set_input_files(path)
    page.locator('[id="record-source.pulse-pressure_column"]').wait_for()
    choose(page, "pressure_column", "gauge 1 (kPa)")
    until(page, f"{PULSE}.time.length === 400")
    field = page.locator('[data-path="source.pulse.start"]')
    field.fill("0.1 ms")
    field.press("Enter")
    until(page, f"{PULSE}.start === 1e-4")
    rest(page)
    system, run = system_of(page), run_of(page)
    assert system.source.pulse.time[-1] == cx.Sampled.from_file(path, pressure_column="gauge 1 (kPa)").time[-1]
    told = page.locator(".record").inner_text().replace("\u202f", " ")
    assert "350 samples over 698 µs of 400 recorded" in told
    assert "peak 18.39 kPa at 0 s, 1/e of it 100 µs later" in told
    stress = np.asarray(solved(system, run["resolution"]).stress("inner", angle=[0, 180])).T
    assert_allclose(run["arrays"]["stress/0"], stress, rtol=0, atol=1e-7 * np.abs(stress).max())
    # Its link is short, and holds it as long as the server runs.
    until(page, HELD_FROM, 1e-4)
    assert len(page.evaluate("location.hash")) < 3000
    again = open_page(f"{server.address}#{page.url.partition('#')[2]}", drawing=False)
    assert system_of(again) == system


def test_a_text_that_is_no_record_is_told_in_words_and_one_is_read_cut_and_solved(linked_page):
    page = linked_page()
    kind(page, "source", "Plane wave")
    until(page, "window.coaxshell.state.system.source.type === 'plane-wave'")
    kind(page, "source.pulse", "Sampled")
    until(page, f"{PULSE}.type === 'sampled'")
    page.locator("details.paste > summary").click()
    page.locator(".record textarea").fill("once upon a time")
    page.get_by_role("button", name="Read", exact=True).click()
    page.locator(".record .problem").wait_for()
    assert "Not read. " in page.locator(".record .problem").inner_text()
    assert violations(page, ".record") == []
    page.locator(".record textarea").fill("t (ms), p (kPa)\n" + "\n".join(f"{0.01 * k:.2f}, {20 * 0.9**k:.6f}" for k in range(50)))
    page.get_by_role("button", name="Read", exact=True).click()
    until(page, f"{PULSE}.time.length === 50 && Math.abs({PULSE}.pressure[0] - 2e4) < 1")
    field = page.locator('[data-path="source.pulse.start"]')
    field.fill("0.1 ms")
    field.press("Enter")
    until(page, f"{PULSE}.start === 1e-4")
    rest(page)
    system, run = system_of(page), run_of(page)
    assert_allclose(system.source.pulse.time[-1], 0.49e-3, rtol=1e-12)
    stress = np.asarray(solved(system, run["resolution"]).stress("inner", angle=[0, 180])).T
    assert_allclose(run["arrays"]["stress/0"], stress, rtol=0, atol=1e-7 * np.abs(stress).max())
