"""The pages as a browser lays them out on a desk and on a phone: nothing lies on anything else, nothing is wider than the screen."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright

BUILT = Path(__file__).parents[1] / "built"
PAGES = ("index", "getting-started", "theory", "faq", "studio", "howto/my-record", "generated/quantities", "generated/commands")
# Pairs of an equation's number and the last of its signs that is seen, where they overlap; those that scroll are scrolled to their ends.
OVERLAPS = """() => [...document.querySelectorAll("div.math")].filter((block) => {
  const number = block.querySelector(".eqno"), formula = block.querySelector("math");
  block.scrollLeft = block.scrollWidth;
  return number && formula && number.getBoundingClientRect().left < formula.getBoundingClientRect().right;
}).map((block) => block.textContent.slice(0, 60))"""


@pytest.fixture(scope="module")
def browser():
    """Debian's own chromium where there is one; else the browser that playwright brings."""
    path = next((found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), None)
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=["--no-sandbox", "--disable-gpu"])
        yield browser
        browser.close()


@pytest.fixture(params=[1280, 390], ids=["desk", "phone"])
def page(browser, request):
    page = browser.new_page(viewport={"width": request.param, "height": 900})
    yield page
    page.close()


@pytest.mark.parametrize("name", PAGES)
def test_a_page_is_no_wider_than_its_screen(page, name):
    page.goto((BUILT / f"{name}.html").as_uri())
    assert page.evaluate("document.documentElement.scrollWidth") <= page.viewport_size["width"]


def test_numbers_of_equations_stand_beside_them(page):
    page.goto((BUILT / "theory.html").as_uri())
    assert page.evaluate("document.querySelectorAll('div.math .eqno').length") > 40
    assert page.evaluate(OVERLAPS) == []


def test_the_search_finds_what_a_newcomer_types(page):
    for word, title in {"pandas": "ParaView, CSV, MATLAB, pandas", "pressure record": "My own pressure record"}.items():
        page.goto((BUILT / "search.html").as_uri() + f"?q={word}")
        page.get_by_role("main").get_by_role("link", name=title).first.wait_for(timeout=30_000)
