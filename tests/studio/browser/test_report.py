"""The report in a browser: nothing that axe-core finds wrong, no request, ten pages of paper at most."""

from __future__ import annotations

import re

import pytest
from page_reading import violations

import coaxshell as cx
from coaxshell.apps.report import PARTS

PICTURE = b'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 720 400" width="720" height="400"/>'


def pages(paper: bytes) -> int:
    return len(re.findall(rb"/Type\s*/Page\b", paper))


def test_axe_finds_nothing_wrong_and_it_fits_its_paper(browser, tmp_path, monkeypatch):
    monkeypatch.setattr("matplotlib.figure.Figure.savefig", lambda figure, file, **options: file.write(PICTURE))  # the slow test draws
    response = cx.simulate("bare", duration=1.0, time_step=0.05, modes=3)
    path = response.report(tmp_path / "report.html", without=PARTS)
    page = browser.new_page()
    asked = []
    page.on("request", lambda request: asked.append(request.url.partition(":")[0]))
    page.goto(path.as_uri())
    assert set(asked) <= {"file", "data"}
    assert asked.count("file") == 1
    assert violations(page) == []
    assert page.evaluate("() => document.documentElement.scrollWidth <= window.innerWidth")
    assert 4 <= pages(page.pdf(prefer_css_page_size=True)) <= 6
    page.close()


@pytest.mark.slow
def test_all_parts_of_two_runs_fit_ten_pages(browser, tmp_path):
    settings = {"duration": 4.0, "time_step": 0.02, "modes": 12}
    path = cx.simulate("hybrid", **settings).report(tmp_path / "report.html", cx.simulate("bare", **settings))
    page = browser.new_page()
    page.goto(path.as_uri())
    assert page.locator("section").count() == 12
    assert page.locator("text=Left out").count() == 0
    assert pages(page.pdf(prefer_css_page_size=True)) <= 10
    assert violations(page) == []
    page.close()
