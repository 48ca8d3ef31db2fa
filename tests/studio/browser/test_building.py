"""A system is built from nothing on the page: shells with their fluids, layers, sources, absorbers taken hold of on the section."""

from __future__ import annotations

import pytest
from asking import SMALL
from page_reading import until, violations

import coaxshell as cx
from coaxshell.apps.studio.links import fragment

SYSTEM = "window.coaxshell.state.system"
ABSORBERS = f"{SYSTEM}.absorbers.map(({{angle}}) => angle)"


def linked(server, system, resolution=SMALL):
    held = {"v": 1, "system": system.model_dump(mode="json"), "resolution": resolution}
    return f"{server.address}#{fragment(held)}"


@pytest.fixture
def opened(open_page, server):
    def start(system, **options):
        page = open_page(linked(server, system), wait=False, drawing=False, **options)
        until(page, "window.coaxshell?.state.runs.current")
        return page

    return start


def held(page, expression):
    return page.evaluate(f"() => {expression}")


MADE = """async () => {
  const {withShellAfter, withoutShell, withWallsExchanged, freeAngle, singly} = await import('/page/js/building.js');
  const {split} = await import('/page/js/laws.js');
  const system = {
    shells: [1, 2, 4].map(radius => ({radius, layers: [{thickness: radius / 100, role: radius === 4 ? 'sensor' : 'core'}]})),
    fluids: ['a', 'b', 'c', 'd'],
    absorbers: [{inner_shell: 0}, {inner_shell: 1}], control: {shells: [1, 2]},
  };
  const told = ({shells, fluids, absorbers, control}) =>
    [shells.map(({radius}) => radius), fluids.join(''), absorbers.map(({inner_shell}) => inner_shell), control?.shells ?? null];
  const past = {...system, absorbers: [{inner_shell: 0, outer_shell: 2, mass: 1}, {outer_shell: null}]};
  return {
    past: [withShellAfter(past, 0), withShellAfter(past, 2), withoutShell(past, 1), withoutShell(past, 2)].map(({absorbers}) => absorbers),
    crossed: freeAngle([{angle: 0}, {angle: 90, outer_shell: 2}], {inner_shell: 1}),
    after: [0, 2].map(i => told(withShellAfter(system, i))),
    without: [0, 1, 2].map(i => told(withoutShell(system, i))),
    walls: withWallsExchanged(system, 1).shells.map(({radius, layers}) => [radius, layers[0].thickness]),
    alone: withShellAfter({...system, shells: system.shells.slice(0, 1), fluids: ['vacuum', 'water']}, 0).fluids,
    free: [[], [{angle: 90}, {angle: 270}, {angle: 10, inner_shell: 1}], [{angle: 0}, {angle: 90}]].map(some => freeAngle(some, {})),
    laws: split({numerator: [2, 4], matrix: [[1, 0.3], [0.6, 0.5]], shells: 'all'}, [1, 2].map(radius => ({radius, layers: []}))),
    two: withoutShell({...system, control: [{shells: [0]}, {shells: [2]}]}, 0).control,
    ring: singly({count: 4, offset: 45, mass: 2, inner_shell: 1}),
  };
}"""


def test_what_hangs_on_a_shell_s_place_goes_with_it(linked_page):
    made = linked_page().evaluate(MADE)
    assert made["after"] == [[[1, 1.5, 2, 4], "abbcd", [0, 2], [2, 3]], [[1, 2, 4, 5], "abccd", [0, 1], [1, 2]]]
    assert made["without"] == [[[2, 4], "acd", [0], [0, 1]], [[1, 4], "abd", [], [1]], [[1, 2], "abd", [0], None]]
    assert made["walls"] == [[1, 0.01], [2, 0.04], [4, 0.02]], "the radii stay"
    assert made["past"] == [
        [{"inner_shell": 0, "outer_shell": 3, "mass": 1}, {"inner_shell": 0}],
        [{"inner_shell": 0, "outer_shell": 2, "mass": 1}, {"inner_shell": 0}],
        [{"inner_shell": 0, "mass": 1}],
        [{"inner_shell": 0}],
    ], "what it passes comes and goes, what it holds takes it along"
    assert made["crossed"] == -90, "an absorber is in every gap that it crosses"
    assert made["alone"] == ["vacuum", "water", "water"], "the first gap is full of what is outside"
    assert made["free"][0] == 0
    assert made["free"][1] in (0, 180)
    assert made["free"][2] == -135
    assert [(law["numerator"], law["matrix"], law["shells"]) for law in made["laws"]] == [([2, 4], None, [0]), ([1, 2], None, [1])]
    assert made["two"] == {"shells": [1]}, "of two laws one is left"
    assert made["ring"] == [{"mass": 2, "inner_shell": 1, "angle": angle} for angle in (45, 135, -135, -45)]


def test_a_system_is_begun_from_nothing_and_a_shell_added_by_keyboard(linked_page):
    page = linked_page(preset="bare")
    page.locator("#preset").select_option(label="nothing: one shell")
    until(page, f"{SYSTEM}.name === 'new system' && {SYSTEM}.shells.length === 1")
    page.locator('details[data-group="shells"]').evaluate("box => { box.open = true; }")
    page.get_by_role("button", name="Add shell").press("Enter")
    until(page, "document.activeElement.textContent.startsWith('Outer shell')")  # what is new has the focus
    page.locator('[data-group="shells[1].layers"] > .buttons button').press("Enter")
    until(page, "document.activeElement.textContent.startsWith('Layer 2')")
    page.get_by_role("button", name="Move Layer 2 inwards").press("Enter")
    page.locator("#section").get_by_role("button", name="Add absorber").press("Enter")
    until(page, f"{SYSTEM}.absorbers.length === 1")
    until(page, "window.coaxshell.state.runs.current.shells.length === 2 && !window.coaxshell.state.problems.length")
    cx.System.model_validate(held(page, SYSTEM))
    page.locator("#undo").click()
    until(page, f"{SYSTEM}.absorbers.length === 0")


@pytest.mark.slow
def test_a_system_is_built_from_nothing_by_keyboard(opened):
    page = opened(cx.presets.load("bare"))
    page.locator("#preset").select_option(label="nothing: one shell")
    until(page, f"{SYSTEM}.name === 'new system' && {SYSTEM}.shells.length === 1")
    page.locator('details[data-group="shells"] > summary').press("Enter")
    page.get_by_role("button", name="Add shell").press("Enter")
    until(page, "document.activeElement.textContent.startsWith('Outer shell')")  # what is new has the focus
    assert held(page, f"{SYSTEM}.fluids.map(({{name}}) => name)") == ["air", "freshwater", "freshwater"]
    page.locator('[data-group="shells[1].layers"] > .buttons button').press("Enter")
    until(page, "document.activeElement.textContent.startsWith('Layer 2')")
    page.locator('select[data-path="shells[1].layers[1].material"]').select_option(label="pzt-4")
    until(page, f"{SYSTEM}.shells[1].layers[1].role === 'passive'")
    page.locator('input[data-path="shells[1].layers[1].thickness"][type=text]').fill("1 mm")
    page.keyboard.press("Enter")
    until(page, f"{SYSTEM}.shells[1].layers[1].thickness === 0.001")
    page.get_by_role("button", name="Move Layer 2 inwards").press("Enter")
    until(page, f"{SYSTEM}.shells[1].layers[0].thickness === 0.001")
    until(page, "document.activeElement.closest('[data-group]').dataset.group === 'shells[1].layers[0]'")  # the form is made anew
    page.locator('[data-act="shells[1]:in"]').press("Enter")
    until(page, "document.activeElement.closest('[data-group]').dataset.group === 'shells[0]'")
    assert held(page, f"{SYSTEM}.shells.map(({{radius, layers}}) => [radius, layers.length])") == [[0.5, 2], [0.625, 1]]
    for count in (1, 2):
        page.locator("#section").get_by_role("button", name="Add absorber").press("Enter")
        until(page, f"{SYSTEM}.absorbers.length === {count} && document.querySelectorAll('[role=slider]').length === {count + 1}")
    assert held(page, ABSORBERS) == [0, 180]
    page.locator('details[data-group="source"] > summary').press("Enter")
    page.locator('select[id="kind-source"]').select_option(label="Several, one by one")
    until(page, f"Array.isArray({SYSTEM}.source) && document.querySelector('[data-group=\"source[0]\"]') !== null")
    page.get_by_role("button", name="Add source").press("Enter")
    until(page, f"{SYSTEM}.source.length === 2")
    until(page, "window.coaxshell.state.runs.current.shells.length === 2 && !window.coaxshell.state.problems.length")
    cx.System.model_validate(held(page, SYSTEM))
    for _ in range(10):
        page.locator("#undo").click()
    until(page, f"{SYSTEM}.shells.length === 1 && {SYSTEM}.absorbers.length === 0")
    page.locator("h1").click()
    page.keyboard.press("Control+Shift+z")
    until(page, f"{SYSTEM}.shells.length === 2")


def test_absorbers_are_dragged_and_moved_by_keys(linked_page):
    page = linked_page(preset=cx.presets.load("absorbers").with_overrides({"absorbers.count": 4}))
    page.get_by_role("slider", name="Ring of 4 absorbers").press("Shift+ArrowRight")
    until(page, f"{SYSTEM}.absorbers.offset === 10")
    page.get_by_role("button", name="Place one by one").click()
    until(page, f"{SYSTEM}.absorbers.length === 4")
    assert held(page, ABSORBERS) == [10, 100, -170, -80]
    box = page.locator('[data-handle="absorbers[1]"] .mass').bounding_box()
    middle = page.locator("#section svg circle").first.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    centre = (middle["x"] + middle["width"] / 2, middle["y"] + middle["height"] / 2)
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(centre[0] + 60, centre[1] - 60, steps=4)
    until(page, f"Math.abs({SYSTEM}.absorbers[1].angle - 45) <= 1")
    page.mouse.up()
    before = held(page, f"{SYSTEM}.absorbers[1].angle")
    page.keyboard.press("ArrowLeft")  # the one that was dragged has the focus
    until(page, f"{SYSTEM}.absorbers[1].angle === {before - 1}")
    page.keyboard.press("ArrowUp")
    page.keyboard.press("Delete")
    until(page, f"{SYSTEM}.absorbers.length === 3 && document.querySelectorAll('[role=slider]').length === 4")
    assert held(page, "document.activeElement.dataset.handle") == "absorbers[0]"
    page.keyboard.press("Insert")
    until(page, "document.activeElement.dataset.handle === 'absorbers[3]'")
    page.keyboard.press("ArrowDown")  # the source comes after them
    page.keyboard.press("ArrowLeft")
    until(page, f"{SYSTEM}.source.angle === -1")
    page.locator('details[data-group="shells"]').evaluate("box => { box.open = true; }")
    page.get_by_role("button", name="Add shell").press("Enter")
    until(page, f"{SYSTEM}.shells.length === 3")
    between = page.locator('select[data-path="absorbers[0].inner_shell"]')
    between.locator("option").nth(2).wait_for(state="attached")
    page.evaluate("document.querySelectorAll('#form details[data-group^=absorbers]').forEach(one => { one.open = true; })")
    assert between.locator("option").all_text_contents() == ["inner and middle", "middle and outer", "inner and outer"]
    between.select_option(label="inner and outer")
    until(page, f"{SYSTEM}.absorbers[0].outer_shell === 2 && {SYSTEM}.absorbers[1].outer_shell == null")
    assert between.evaluate("one => one.selectedOptions[0].textContent") == "inner and outer"
    until(page, "!document.documentElement.classList.contains('stale')")
    assert violations(page, "#section") == []


def test_one_law_for_all_becomes_one_for_each_shell(linked_page):
    page = linked_page(preset=cx.presets.load("electrodes").with_overrides({"control.derivative": [2.0, 1.0]}))
    page.locator('details[data-group="control"]').evaluate("box => { box.open = true; }")
    assert page.locator('input[type=text][data-path="control.derivative"]').input_value() == "2, 1"  # a list of gains, one a shell
    page.locator('select[data-path="control"]').select_option(label="One law for each shell")
    until(page, f"{SYSTEM}.control.length === 2")
    assert held(page, f"{SYSTEM}.control.map(({{derivative, shells}}) => [derivative, shells])") == [[2, [0]], [1, [1]]]
    page.locator('input[type=text][data-path="control[1].segments"]').fill("8")
    page.keyboard.press("Enter")
    until(page, f"{SYSTEM}.control.every(({{segments}}) => segments === 8)")  # all walls are cut alike
    cx.System.model_validate(held(page, SYSTEM))


def test_limits_of_current_a_bridge_out_of_balance_and_dead_belts_are_typed_and_refused_at_their_fields(linked_page):
    law = cx.Feedback(numerator=[0.0, 1e-3], denominator=[1.0], transducers="electrodes")
    page = linked_page(preset=cx.presets.load("electrodes").replace(control=law))
    page.locator('details[data-group="control"]').evaluate("box => { box.open = true; }")
    names = ("current_limit", "bridge_imbalance", "dead_belts", "dead_electrodes")
    field = {name: page.locator(f'input[type=text][data-path="control.{name}"]') for name in names}

    def typed(name, text):
        field[name].fill(text)
        field[name].press("Enter")

    typed("current_limit", "20 A/m^2")
    until(page, f"{SYSTEM}.control.current_limit === 20 && !document.documentElement.classList.contains('stale')")
    typed("current_limit", "-1")
    page.locator("#field-problem").wait_for()
    assert field["current_limit"].get_attribute("aria-invalid") == "true"
    typed("current_limit", "")
    until(page, f"{SYSTEM}.control.current_limit === null && !window.coaxshell.state.problems.length")
    typed("bridge_imbalance", "0.01")
    until(page, f"{SYSTEM}.control.bridge_imbalance === 0.01 && !document.documentElement.classList.contains('stale')")
    typed("bridge_imbalance", "-2")
    page.locator("#field-problem").wait_for()
    assert field["bridge_imbalance"].get_attribute("aria-invalid") == "true"
    typed("bridge_imbalance", "0")
    typed("dead_belts", "2, -1")
    typed("dead_electrodes", "0, 3; -1, 5")
    until(page, f"{SYSTEM}.control.dead_electrodes?.length === 2 && window.coaxshell.state.problems.length >= 1")
    assert held(page, f"[{SYSTEM}.control.dead_belts, {SYSTEM}.control.dead_electrodes]") == [[2, -1], [[0, 3], [-1, 5]]]
    until(page, "document.getElementById('form').textContent.includes('electrodes that are not cut along the axis')")  # no pitch
    assert field["dead_belts"].get_attribute("aria-invalid") == "true"
    assert violations(page, 'details[data-group="control"]') == []
    typed("dead_belts", "")
    typed("dead_electrodes", "")
    until(page, f"{SYSTEM}.control.dead_electrodes === null && !window.coaxshell.state.problems.length")


@pytest.mark.slow
def test_each_shell_has_a_law_of_its_own_by_keyboard(opened):
    system = cx.presets.load("electrodes").with_overrides({"control.derivative": [2.0, 1.0]})
    page = opened(system)
    gain = page.locator('input[type=text][data-path="control.derivative"]')
    assert gain.input_value() == "2, 1"  # a list of gains, one a shell
    page.locator('select[data-path="control"]').select_option(label="One law for each shell")
    until(page, f"{SYSTEM}.control.length === 2")
    assert held(page, f"{SYSTEM}.control.map(({{derivative, shells}}) => [derivative, shells])") == [[2, [0]], [1, [1]]]
    page.locator('input[type=range][data-path="control[1].derivative"]').press("ArrowRight")
    until(page, f"{SYSTEM}.control[1].derivative > 1 && {SYSTEM}.control[0].derivative === 2")
    page.locator('[data-group="control"] > .buttons button').first.wait_for()
    assert page.locator('[data-group="control"] > .buttons button').is_disabled(), "no shell is without"
    page.locator('input[type=text][data-path="control[1].segments"]').fill("8")
    page.keyboard.press("Enter")
    until(page, f"{SYSTEM}.control.every(({{segments}}) => segments === 8)")  # all walls are cut alike
    page.locator('select[id="kind-control[0]"]').select_option(label="Feedback")
    until(page, f"{SYSTEM}.control[0].numerator?.length === 2")
    assert held(page, f"{SYSTEM}.control[0].numerator") == [pytest.approx(2.0 * system.transit_time, rel=1e-7), 0]
    assert held(page, f"{SYSTEM}.control[0].segments") == 8
    page.locator('select[id="kind-control[0]"]').select_option(label="PD control")
    until(page, f"{SYSTEM}.control[0].derivative === 2")
    page.locator('[data-act="control[0]:out"]').press("Enter")
    until(page, f"{SYSTEM}.control[1].shells[0] === 0 && document.activeElement.closest('[data-group]').dataset.group === 'control[1]'")
    page.locator('[data-path="control[0].shells[0]"]').press("Space")
    page.locator("#field-problem").wait_for()
    assert "under control[0] already" in page.locator("#field-problem").inner_text()
    page.locator('[data-path="control[0].shells[0]"]').press("Space")
    until(page, "!window.coaxshell.state.problems.length")
    assert violations(page, '[data-group="control"]') == []
    page.locator('[data-act="control[1]:remove"]').press("Enter")
    until(page, f"{SYSTEM}.control.shells?.[0] === 1 && document.activeElement.dataset.path === 'control'")
    page.locator("#undo").click()
    until(page, f"{SYSTEM}.control.length === 2")
    cx.System.model_validate(held(page, SYSTEM))
