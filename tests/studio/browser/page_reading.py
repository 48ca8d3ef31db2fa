"""What a page shows, as numbers, and the same numbers from the library."""

from __future__ import annotations

import base64
import time

import numpy as np
from axe_playwright_python.sync_playwright import Axe

import coaxshell as cx
from coaxshell.apps.studio.links import fragment

PATIENCE = 90
"""Seconds: a machine that does other things beside is slow, not wrong."""

PREVIEW = {"duration": 5.0, "time_step": 4e-3, "modes": 60}

PACKED = """const packed = values => {
  const bytes = new Uint8Array(values.buffer, values.byteOffset, values.byteLength);
  let text = '';
  for (let k = 0; k < bytes.length; k += 32768) text += String.fromCharCode(...bytes.subarray(k, k + 32768));
  return btoa(text);
};"""
"""What makes a text of a typed array: a million numbers one by one would take seconds."""

RUN = f"""slot => {{
  {PACKED}
  const run = window.coaxshell.state.runs[slot];
  const plain = ([name, array]) => [name, {{kind: array.values.constructor.name, values: packed(array.values), shape: array.shape}}];
  const arrays = Object.fromEntries(Object.entries(run.arrays).map(plain));
  return {{arrays, bars: run.bars, resolution: run.resolution, run: run.run}};
}}"""
KINDS = {"Float32Array": "<f4", "Float64Array": "<f8", "Uint8Array": "u1", "Uint8ClampedArray": "u1"}


def unpacked(text, kind):
    """Return the numbers of a packed array of a kind."""
    return np.frombuffer(base64.b64decode(text), KINDS[kind])


def open_preset(open_page, server, resolution, preset="absorbers", **options):
    """Return a page with a preset at a resolution of its own, as a link holds it; its last answers are shown."""
    held = {"v": 1, "system": cx.presets.load(preset).model_dump(mode="json"), "resolution": resolution}
    page = open_page(f"{server.address}#{fragment(held)}", **options)
    rest(page)
    until(page, "!!window.coaxshell.state.runs.current?.full && !!window.coaxshell.state.runs.bare?.full")
    return page


def without_drawing(pages) -> None:
    """Leave plotly out of a page or of a window's pages whose curves nobody looks at: compiling it takes seconds in a new window."""
    pages.route("**/vendor/plotly.min.js", lambda route: route.fulfill(content_type="text/javascript", body=""))


def until(page, expression, argument=None):
    """Wait until an expression of the page is true; asked from outside, because the page's own rules forbid it to evaluate text."""
    end = time.monotonic() + PATIENCE
    asked = expression if "=>" in expression else f"() => Boolean({expression})"  # a bare answer would be sent whole, arrays and all
    while not page.evaluate(asked, argument):
        if time.monotonic() > end:
            raise AssertionError(f"not within {PATIENCE} s: {expression}; the page says {page.locator('#state').inner_text()!r}")
        page.wait_for_timeout(50)


def run_of(page, slot="current"):
    """Return arrays, bars, resolution and system of a run on the page; its bars come after its curves."""
    until(page, f"window.coaxshell.state.runs.{slot}?.withBars")
    found = page.evaluate(RUN, slot)
    arrays = found["arrays"].items()
    found["arrays"] = {name: unpacked(one["values"], one["kind"]).astype(float).reshape(one["shape"]) for name, one in arrays}
    return found


def solved(system: cx.System, resolution=None) -> cx.Response:
    """Return the library's own answer."""
    settings = {name: value for name, value in (resolution or PREVIEW).items() if name in ("duration", "time_step", "modes", "refinement")}
    return cx.simulate(system, **settings)


def system_of(page) -> cx.System:
    """Return the system that the page holds."""
    return cx.System.model_validate(page.evaluate("window.coaxshell.state.system"))


def rest(page):
    """Wait until the page shows the answer to the newest wish."""
    until(
        page,
        "() => { const {state} = window.coaxshell; const run = state.runs.current;"
        " return run?.withBars && JSON.stringify(run.system) === JSON.stringify(state.system); }",
    )


def shown_curves(page):
    """Return {(name of the run, axis): y} of the curves drawn, as plotly holds them."""
    found = page.evaluate(
        "document.getElementById('curves').data.map(trace => [trace.name, trace.xaxis ?? 'x', Array.from(trace.y), Array.from(trace.x)])"
    )
    return [(name, axis, np.array(y, dtype=float), np.array(x, dtype=float)) for name, axis, y, x in found]


AXE = Axe().axe_script
FOUND = """([place, rules]) => axe.run(
  place ?? document, {resultTypes: ['violations'], preload: false, ...(rules && {runOnly: rules})},
).then(({violations}) => violations)"""
"""Without loading style sheets and films once more, which only rules about films and about turned screens look at."""


def violations(page, place=None, rules=None):
    """Return what axe-core finds wrong with the page or with a place on it (a selector), in words: half a second for a whole page.

    All rules of axe-core's defaults, or those named in a list.
    """
    if not page.evaluate("() => Boolean(window.axe)"):
        page.evaluate(AXE)
    found = page.evaluate(FOUND, [place, rules])
    return [f"{one['id']}: {one['help']} ({', '.join(node['html'][:120] for node in one['nodes'][:3])})" for one in found]
