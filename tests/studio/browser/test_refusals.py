"""What is refused is told in words beside its field, whatever its kind; what is shown of an earlier state says so."""

from __future__ import annotations

import json

import pytest
from page_reading import rest, until

PROBLEM = {"where": "absorbers.mass", "problem": "is a sheep", "remedy": "give a goat"}
TWO = {"ok": False, "problem": PROBLEM, "problems": [PROBLEM, {**PROBLEM, "where": "control"}]}
KINDS = {
    "a problem with the description": (200, TWO),
    "a refused request": (422, {"error": {"code": "limit", **PROBLEM}}),
    "too many requests": (429, {"error": {"code": "busy", **PROBLEM}}),
    "a server that fails": (500, {"error": {"code": "internal", **PROBLEM}}),
    "an answer without words": (502, None),
}
ROUTES = ("validate", "solve", "jobs")


def answering(status, body):
    """Return what answers a request of the page in the server's place."""
    kind, text = ("application/json", json.dumps(body)) if body else ("text/html", "<h1>")
    return lambda route: route.fulfill(status=status, content_type=kind, body=text)


def change(page, path, text):
    field = page.locator(f'input[type="text"][data-path="{path}"]')
    field.evaluate(
        "input => { for (let box = input.closest('details'); box; box = box.parentElement.closest('details')) box.open = true; }"
    )
    field.fill(text)
    field.press("Enter")
    return field


EACH = tuple((route, kind) for route in ROUTES for kind in KINDS)
"""Every kind of refusal of every route; the small version has three, of which one has no words."""


@pytest.mark.parametrize("asked", [EACH[1::6], pytest.param(EACH, marks=pytest.mark.slow)], ids=["some", "all"])
def test_every_kind_of_refusal_is_words_in_their_place(linked_page, watched, asked):
    watched.forgiven += ["Failed to load resource", "422:", "429:", "500:", "502:"]
    page = linked_page(preset="hybrid")
    for mass, (route, kind) in enumerate(asked, 20):
        status, body = KINDS[kind]
        body = body and json.loads(json.dumps(body).replace("a sheep", f"sheep {mass}"))  # what is waited for was not told before
        page.route(f"**/api/{route}", answering(status, body))
        change(page, "absorbers.mass", f"{mass} kg/m")
        words = f"is sheep {mass}" if body else "the server answered 502"
        until(page, "words => document.getElementById('state').textContent.includes(words)", words)
        shown = page.locator("body").inner_text()
        assert "[object" not in shown, (route, kind)
        assert "undefined" not in shown, (route, kind)
        if body:
            assert f"is sheep {mass}; give a goat" in page.locator("#field-problem").inner_text(), (route, kind)
        assert page.evaluate("document.getElementById('curves').data.length") == 8, "the curves stay, the bare ones too"
        page.unroute(f"**/api/{route}")
    change(page, "absorbers.mass", "10 kg/m")
    until(page, "!document.querySelector('#form .problem') && !document.documentElement.classList.contains('stale')")


def test_peaks_that_could_not_be_had_are_asked_for_again(linked_page, watched):
    watched.forgiven += ["Failed to load resource", "429:"]
    page, refused, held = linked_page(), [], []

    def once(route):
        if refused:
            return route.continue_()
        refused.append(route.request.url)
        return answering(*KINDS["too many requests"])(route)

    page.route("**/api/jobs", lambda route: held.append(route))  # full resolution would bring peaks of its own
    page.route("**/api/runs/*/bars", once)
    change(page, "absorbers.mass", "17.3 kg/m")  # which nobody has asked for before: an answer that is kept has its peaks
    until(page, "window.coaxshell.state.system.absorbers.mass === 17.3")
    rest(page)
    assert len(refused) == 1
    assert not page.evaluate("window.coaxshell.state.runs.current.full")
    assert page.locator("#peaks:not(.unmeasured) table").count() == 1
    for route in held:
        route.continue_()
    page.unroute_all()


@pytest.mark.parametrize("mended", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["told", "mended"])
def test_wrong_entries_are_told_together_the_one_just_edited_first(linked_page, mended):
    page = linked_page(preset="hybrid")
    change(page, "absorbers.mass", "-3 kg/m")
    until(page, "document.querySelectorAll('#form [aria-invalid]').length === 1")
    change(page, "absorbers.damping", "heavy")
    until(page, "document.querySelectorAll('#form [aria-invalid]').length === 2")
    modes = change(page, "resolution.modes", "301")
    until(page, "document.querySelectorAll('#form [aria-invalid]').length === 3")
    assert "301 orders are too many here; at most 300" in page.locator("#field-problem").inner_text()
    assert modes.get_attribute("aria-describedby") == "field-problem"
    assert "Orders: 301" in page.locator("#state").inner_text()
    assert "and 2 more" in page.locator("#state").inner_text()
    assert page.locator(".of-old").is_visible()
    # what is compared with the bare system follows its curves
    until(page, "window.coaxshell.state.runs.bare && document.querySelector('.peaks .better, .peaks .worse')")
    if not mended:
        return
    change(page, "resolution.modes", "12")
    until(page, "document.querySelectorAll('#form [aria-invalid]').length === 2")
    change(page, "absorbers.mass", "3 kg/m")
    until(page, "document.querySelectorAll('#form [aria-invalid]').length === 1")
    change(page, "absorbers.damping", "")  # an emptied field holds nothing, and says so
    until(page, "document.querySelector('[data-path=\"absorbers.damping\"][type=text]').parentElement.textContent.includes('\\'\\'')")
    change(page, "absorbers.damping", "1e5")
    until(page, "!document.querySelector('#form [aria-invalid]') && !document.documentElement.classList.contains('stale')")
    assert not page.locator(".of-old").is_visible()
    # A preview that the limits of full resolution allow never speaks of its own.
    change(page, "resolution.refinement", "8")
    change(page, "resolution.duration", "40")
    rest(page)
    until(page, "!document.documentElement.classList.contains('stale')")
    assert page.locator("#form .problem").count() == 0


@pytest.mark.parametrize("presets", [0, pytest.param(2, marks=pytest.mark.slow)], ids=["undone", "begun anew"])
def test_changes_are_undone_and_redone_and_a_preset_chosen_again_starts_anew(linked_page, presets):
    page = linked_page(preset="hybrid")
    mass = "window.coaxshell.state.system.absorbers.mass"
    change(page, "absorbers.mass", "11 kg/m")
    until(page, f"{mass} === 11")
    change(page, "absorbers.mass", "12 kg/m")
    until(page, f"{mass} === 12")
    page.locator("h1").click()
    page.keyboard.press("Control+z")
    until(page, f"{mass} === 11")
    page.keyboard.press("Control+z")
    until(page, f"{mass} === 10")
    page.keyboard.press("Control+Shift+z")
    until(page, f"{mass} === 11")
    page.locator("#redo").click()
    until(page, f"{mass} === 12")
    assert page.locator("#redo").is_disabled()
    for _ in range(presets):  # the second time it is the one that is shown
        page.locator("#preset").select_option(label="absorbers")
        until(page, f"{mass} === 10 && window.coaxshell.state.system.control === null")
        assert page.locator("#preset option:checked").inner_text() == "absorbers"
        change(page, "absorbers.mass", "13 kg/m")
        until(page, f"{mass} === 13")


PATH = """() => {
  const box = document.getElementById('curves'), {xaxis, yaxis} = box._fullLayout, found = [];
  const lines = box.querySelectorAll('.xy .scatterlayer .trace path.js-line');
  const traces = box.data.filter(trace => (trace.xaxis ?? 'x') === 'x');
  lines.forEach((line, i) => {
    const drawn = line.getAttribute('d').slice(1).split(/[LHV]/).length, data = traces[i], length = line.getTotalLength();
    let off = 0;
    for (let k = 0; k < data.x.length; k += 1) {
      let [low, high] = [0, length];
      const x = xaxis.l2p(data.x[k]);
      for (let n = 0; n < 40; n += 1) { const mid = (low + high) / 2; if (line.getPointAtLength(mid).x < x) low = mid; else high = mid; }
      off = Math.max(off, Math.abs(line.getPointAtLength(low).y - yaxis.l2p(data.y[k])));
    }
    found.push({name: data.name, points: data.x.length, drawn, off});
  });
  return found;
}"""


@pytest.mark.parametrize("unit", ["transits", pytest.param("ms", marks=pytest.mark.slow)])
def test_the_curves_drawn_are_the_data(linked_page, unit):
    page = linked_page({"duration": 2.0, "time_step": 0.004, "modes": 30}, preset="hybrid")
    page.locator("#unit").select_option(unit)
    until(page, f"document.getElementById('curves').layout.xaxis2.title.text === 'time ({'ms' if unit == 'ms' else 'a/c'})'")
    found = page.evaluate(PATH)
    assert {one["name"] for one in found} == {"current", "bare"}
    for one in found:
        assert one["off"] < 0.6, one  # pixels
    last = page.evaluate("document.getElementById('curves').data[0].x.at(-1)")
    transit = page.evaluate("window.coaxshell.state.runs.current.transit_time_seconds")
    assert last == pytest.approx(2.0 * (1e3 * transit if unit == "ms" else 1.0), rel=1e-6)
