"""Panels beside the curves show the library's numbers in words and pictures; the first minute leads through the page."""

from __future__ import annotations

import pytest
from asking import SMALL
from page_reading import open_preset, until, violations

import coaxshell as cx


def test_stress_map_spectra_and_control(linked_page):
    page = linked_page(preset="electrodes", theme="dark")
    library = cx.simulate("electrodes", **SMALL)
    page.locator("#tab-stressed").click()
    until(page, "document.getElementById('stressed-plot')?.data?.length === 2")
    peak = library.peak_stress("inner")
    told = page.locator("#stressed-peak").inner_text()
    assert f"{peak.value / 1e3:.4g}\u202fkPa" in told
    assert f"layer of {peak.material}" in told
    page.locator("#tab-spectra").click()
    until(page, "document.getElementById('spectra-plot')?.data?.length === 4")
    largest = float(library.shock_spectrum("outer").sel(angle=0).max())
    assert page.evaluate("Math.max(...document.getElementById('spectra-plot').data[0].y)") == pytest.approx(largest, rel=1e-6)
    assert "is left in the last" in page.locator("#spectra .warnings").inner_text()
    page.locator("#tab-control").click()
    until(page, "document.getElementById('loops-plot')?.data?.length >= 3")
    phase = float(library.stability_margins()["phase_margin"].min())
    assert f"{phase:.3g}°" in page.locator("#control").inner_text()
    assert page.locator("#control .light").first.inner_text().endswith("enough")
    assert page.locator("#control meter").count() == 2
    assert violations(page, "#more") == []
    page.locator('[data-path="control"]').select_option(label="None")
    until(page, "document.getElementById('control').textContent.includes('Nothing is fed back')")


def test_costs_stand_beside_choices_and_the_first_minute_leads_through(server, open_page):
    page = open_preset(open_page, server, SMALL, drawing=False)
    until(page, r"/^elastic .[\d.]+.m?s.$/.test(document.querySelector('[data-cost=\"theory/1/elastic\"]').textContent)")
    assert "(" in page.locator('[data-cost="dimensions/3"]').text_content()
    assert not page.locator("#guide").is_visible(), "a link is no first visit"
    page.locator("#first-minute").press("Enter")
    assert page.locator("#guide-count").inner_text() == "1 of 5"
    assert violations(page, "#guide") == []
    page.locator('input[type="range"][data-path="absorbers.count"]').press("ArrowLeft")
    until(page, "document.getElementById('guide-count').textContent === '2 of 5'")
    page.locator("#pin").click()
    until(page, "document.getElementById('guide-count').textContent === '3 of 5'")
    page.locator("#tab-wave").click()
    until(page, "document.getElementById('guide-count').textContent === '4 of 5'")
    page.locator("#tab-designs").click()
    page.get_by_role("button", name="Keep this design").click()
    until(page, "document.getElementById('guide-count').textContent === '5 of 5'")
    page.locator("#guide-next").click()
    assert not page.locator("#guide").is_visible()
