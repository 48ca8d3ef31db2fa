"""An optimisation from the page: the library's numbers, its best adopted, a front chosen from, cancelled, bad input beside its field."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest
from asking import SMALL
from numpy.testing import assert_allclose
from page_reading import open_preset, rest, run_of, solved, system_of, until, violations

import coaxshell as cx

RANGES = {"absorbers.mass": cx.Range(1, 10), "absorbers.damping": cx.Range(1e4, 1e8, "log")}

FIRST_OF_FRONT = """() => {
  const plot = document.getElementById('study-plot'), {xaxis, yaxis} = plot._fullLayout, {left, top} = plot.getBoundingClientRect();
  const [front] = plot.data.filter(trace => trace.name === 'front');
  return [left + xaxis._offset + xaxis.l2p(front.x[0]), top + yaxis._offset + yaxis.l2p(front.y[0])];
}"""


@pytest.fixture
def studies(open_page, server):
    """Give what opens the page at a small resolution with the optimisation's form."""

    def start(**options):
        return with_form(open_preset(open_page, server, SMALL, **options))

    return start


def with_form(page):
    page.locator("#tab-studies").click()
    page.get_by_role("radio", name="Optimise").check(force=True)
    return page


def fill(page, **entries):
    """Fill the form in as a person does: by the labels' own inputs, in order."""
    for name, value in entries.items():
        field = page.locator(f'#optimise [name="{name.replace("__", ".")}"]')
        if field.evaluate("one => one.tagName") == "SELECT":
            field.select_option(value)
        else:
            field.fill(value)


def describe(page, evaluations="12"):
    fill(page, variables__0__path="absorbers.mass", variables__0__from="1 kg/m", variables__0__to="10", variables__0__scale="linear")
    page.get_by_role("button", name="Add a variable").click()
    fill(page, variables__1__path="absorbers.damping", variables__1__from="1e4", variables__1__to="1e8", variables__1__scale="log")
    fill(page, evaluations=evaluations, seed="3")


def start(page):
    """Start an optimisation; what a test before has come to on the page is gone."""
    page.evaluate("document.getElementById('study-result').replaceChildren()")
    page.get_by_role("button", name="Start optimisation").click()


def number(text):
    """Return the value of a cell such as 105.8 kPa, without its prefix."""
    return float(text.replace("\u2212", "-").replace("\u202f", " ").split()[0])


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["adopted", "taken home"])
def test_the_best_is_the_library_s_and_can_be_adopted_and_taken_back(linked_page, whole):
    page = with_form(linked_page())
    describe(page)
    page.get_by_role("button", name="Add a limit").click()
    fill(page, constraints__0__metric="absorbers.mass", constraints__0__value="200")
    start(page)
    page.locator("#study-use").wait_for()
    ours = cx.optimise(
        cx.presets.load("absorbers"),
        variables=RANGES,
        objectives="inner.peak_stress",
        constraints="absorbers.mass <= 200 kg/m",
        evaluations=12,
        seed=3,
        workers=1,
        **SMALL,
    )
    cells = page.locator(".optimum tbody").first.locator("tr").nth(1).locator("td").all_inner_texts()
    assert_allclose([number(text) for text in cells[:2]], [ours.baseline.objectives[0] / 1e3, ours.best.objectives[0] / 1e3], rtol=2e-3)
    curves = page.evaluate("document.getElementById('study-plot').data.map(({name, y}) => [name, Array.from(y)])")
    assert [name for name, _ in curves] == ["designs", "baseline", "best so far"], "what breaks the limit on the mass is not run"
    values = [one.objectives[0] if one.feasible else None for one in ours.history]
    shown = dict(curves)["designs"]
    assert [value is None for value in shown] == [value is None for value in values]
    assert_allclose([1e3 * value for value in shown if value is not None], [value for value in values if value is not None], rtol=1e-12)
    themes = set()
    for _ in range(1 + whole):  # the test before may have chosen either
        themes.add(page.evaluate("document.documentElement.dataset.theme"))
        assert violations(page, "#more") == [], themes
        page.locator("#theme").click()
    assert len(themes) == 1 + whole
    before = system_of(page)
    page.locator("#study-use").click()
    until(page, "window.coaxshell.state.system.name.endsWith('optimised')")
    rest(page)
    assert system_of(page) == ours.system
    if not whole:
        return
    run = run_of(page)
    stress = np.asarray(solved(ours.system, run["resolution"]).stress("inner", angle=[0, 180])).T
    assert_allclose(run["arrays"]["stress/0"], stress, rtol=0, atol=1e-7 * np.abs(stress).max())
    page.locator("#undo").click()
    until(page, "!window.coaxshell.state.system.name.endsWith('optimised')")
    assert system_of(page) == before
    for name, beginning, ending in (("TOML", "absorbers-best-", ".toml"), ("CSV", "absorbers-designs-", ".csv")):
        with page.expect_download() as saved:
            page.locator("#study-jobs .job").first.get_by_role("link", name=name).click()
        assert saved.value.suggested_filename.startswith(beginning)
        assert saved.value.suggested_filename.endswith(ending)
        assert saved.value.failure() is None


@pytest.mark.slow
def test_a_design_of_the_front_is_adopted_by_the_keyboard_on_a_phone(studies):
    page = studies(width=390, height=844)
    describe(page)
    fill(page, objectives__1__metric="absorbers.mass")
    fill(page, evaluations="40")
    start(page)
    design = page.locator("#study-design")
    design.wait_for()
    assert design.locator("option").count() > 1
    design.focus()
    page.keyboard.press("End")
    until(page, "window.coaxshell.state.system.name.endsWith('optimised')")
    rest(page)
    mass = sum(absorber.mass for absorber in system_of(page).absorber_list)
    shown = page.locator(".optimum tbody").first.locator("tr").nth(2).locator("td").nth(1).inner_text()
    assert_allclose(number(shown), mass, rtol=1e-3)
    page.locator("#study-plot").scroll_into_view_if_needed()
    x, y = page.evaluate(FIRST_OF_FRONT)
    page.mouse.move(x, y)
    page.locator("#study-plot .hovertext").first.wait_for()
    before = system_of(page).absorbers.mass  # before the click, which may be answered at once
    page.mouse.click(x, y)
    until(page, "value => window.coaxshell.state.system.absorbers.mass !== value", before)
    assert design.evaluate("select => select.selectedIndex") == 0
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    assert violations(page) == []


@pytest.mark.slow
def test_a_running_one_tells_its_best_and_can_be_cancelled(linked_page):
    page = with_form(linked_page())
    describe(page, "2000")
    start(page)
    until(page, "/designs, best inner · peak stress [\\d.]+ \\w*Pa/.test(document.querySelector('#study-jobs .job .note')?.textContent)")
    page.locator("#study-jobs .job").first.get_by_role("button", name="Cancel").click()
    until(page, "document.querySelector('#study-jobs .job').dataset.state === 'cancelled'")


@pytest.mark.slow
@pytest.mark.parametrize("each", ["mirror", "single"])
def test_choices_absorbers_of_their_own_and_generations_are_the_library_s(studies, each):
    page = studies()
    fill(page, variables__0__path="shells[1].layers[1].thickness", variables__0__scale="list")
    assert page.locator('[name="variables.0.values"]').input_value() != "", "the ends of the range are offered"
    fill(page, variables__0__values="4 mm; 6 mm;8 mm")
    page.get_by_role("button", name="Add a variable").click()
    fill(
        page,
        variables__1__path="absorbers[*].mass",
        variables__1__from="1",
        variables__1__to="10 kg/m",
        variables__1__each=each,
        variables__1__scale="linear",
    )
    assert page.locator('[name="variables.1.scale"] option[value="list"]').count() == 0
    fill(page, evaluations="12", population="6", seed="2")
    assert violations(page, "#studies") == []
    start(page)
    page.locator("#study-use").wait_for()
    ours = cx.optimise(
        cx.presets.load("absorbers"),
        variables={"shells[1].layers[1].thickness": ["4 mm", "6 mm", "8 mm"], "absorbers[*].mass": cx.Range(1, "10 kg/m", each=each)},
        objectives="inner.peak_stress",
        evaluations=12,
        population=6,
        seed=2,
        workers=1,
        **SMALL,
    )
    curves = page.evaluate("Object.fromEntries(document.getElementById('study-plot').data.map(({name, y}) => [name, Array.from(y)]))")
    assert_allclose([1e3 * value for value in curves["designs"]], [one.objectives[0] for one in ours.history], rtol=1e-12)


@pytest.mark.slow
def test_wrong_choices_and_generations_are_told_beside_them(studies):
    page = studies()
    for entries, field, words in (
        ({"population": "2"}, "population", "4 to"),
        ({"population": "6", "variables__0__scale": "list", "variables__0__values": "4 kg/m; heavy"}, "variables.0.values", "heavy"),
        ({"variables__0__values": " ; "}, "variables.0.values", ""),
    ):
        fill(page, **entries)
        start(page)  # the button has the focus until the answer comes
        page.locator("#optimise-problem").wait_for()
        until(page, "name => document.activeElement.name === name", field)
        assert words in page.locator("#optimise-problem").inner_text()
    assert violations(page, "#studies") == []


def test_what_is_wrong_is_told_beside_its_field(studies):
    page = studies(drawing=False)
    assert [page.locator(f'[name="variables.0.{end}"]').input_value() for end in ("from", "to")] == ["1 kg/m", "100 kg/m"]
    describe(page)
    fill(page, variables__1__to="heavy")
    start(page)
    page.locator("#optimise-problem").wait_for()
    field = page.locator('[name="variables.1.to"]')
    assert field.get_attribute("aria-invalid") == "true"
    assert page.evaluate("document.activeElement.name") == "variables.1.to"
    assert violations(page, "#studies") == []
    fill(page, variables__1__to="1e8", population="2")
    start(page)
    until(page, "document.activeElement.name === 'population'")
    assert "4 to" in page.locator("#optimise-problem").inner_text()
    fill(page, population="6", evaluations="none")
    start(page)
    until(page, "document.activeElement.name === 'evaluations'")
    assert field.get_attribute("aria-invalid") is None
    page.get_by_role("button", name="Add a limit").click()
    start(page)
    until(page, "document.activeElement.name === 'constraints.0.value'")
    assert "the limit is empty" in page.locator("#optimise-problem").inner_text()


KINDS = (("Optimise", "objectives"), ("Sweep", "over"))


@pytest.mark.parametrize("kinds", [KINDS[:1], pytest.param(KINDS, marks=pytest.mark.slow)], ids=["optimise", "sweep too"])
def test_the_study_file_is_shown(linked_page, kinds):
    page = with_form(linked_page())
    for kind, entry in kinds:
        page.get_by_role("radio", name=kind).check(force=True)
        page.locator("#study-file summary").click()
        until(page, "entry => document.getElementById('study-text').value.includes(entry)", entry)
        told = tomllib.loads(page.locator("#study-text").input_value())
        assert told["scenario"] == "absorbers"
        assert told["resolution"]["modes"] == SMALL["modes"]
        assert entry in told
        assert violations(page, "#studies") == []
        page.locator("#study-file summary").click()
