"""Two tabs at once, a server that ends and comes back, links, files."""

from __future__ import annotations

import time

import numpy as np
import pytest
from asking import SMALL
from numpy.testing import assert_allclose
from page_reading import PATIENCE, open_preset, rest, run_of, solved, system_of, until, without_drawing

import coaxshell as cx
from coaxshell.apps.studio.links import fragment, opened


@pytest.mark.slow
def test_two_tabs_do_not_disturb_each_other(server, open_page):
    first, second = (open_preset(open_page, server, SMALL, preset="hybrid", drawing=drawing) for drawing in (True, False))
    second.locator("#preset").select_option(label="absorbers")
    first.locator("#preset").select_option(label="active")
    for page, name in ((first, "active"), (second, "absorbers")):
        until(page, "name => window.coaxshell.state.system.name === name", cx.presets.load(name).name)
        rest(page)
        assert system_of(page) == cx.presets.load(name)
        shown = run_of(page)  # once: the full resolution may come at any moment
        value = next(bar["value"] for bar in shown["bars"] if bar["name"] == "stress" and bar["shell"] == 0)
        assert_allclose(value, solved(cx.presets.load(name), shown["resolution"]).summary().shells[0].stress.value, rtol=1e-9)


@pytest.mark.parametrize("count", [2, pytest.param(7, marks=pytest.mark.slow)])
def test_all_tabs_of_one_browser_are_answered_and_share_one_stream(browser, server, watched, count):
    context = browser.new_context()
    without_drawing(context)
    context.set_default_timeout(1e3 * PATIENCE)
    held = {"v": 1, "system": cx.presets.load("bare").model_dump(mode="json"), "resolution": {**SMALL, "modes": 6}}
    address = f"{server.address}#{fragment(held)}"
    pages, streams = [], []
    for _ in range(count):
        page = context.new_page()
        watched.watch(page)
        page.on("request", lambda request: "/api/events" in request.url and streams.append(request.url))
        page.goto(address)
        pages.append(page)
    for page in pages:  # full resolution comes by an event
        until(page, "!!window.coaxshell?.state.runs.current?.full")
    end = time.monotonic() + PATIENCE
    while streams[-1].count("client=") < count and time.monotonic() < end:  # an answer that the server had kept comes without an event
        pages[0].wait_for_timeout(50)
    assert streams[-1].count("client=") == count
    listening, other = pages[0], pages[count // 2]
    other.locator("#preset").select_option(label="iakovlev-evacuated")
    until(other, "window.coaxshell.state.runs.current?.shells.length === 1")
    assert listening.evaluate("window.coaxshell.state.system.shells.length") == 2
    listening.close()
    other.locator("#preset").select_option(label="iakovlev-double")
    until(other, "window.coaxshell.state.runs.current?.shells.length === 2 && window.coaxshell.state.runs.current.full")
    context.close()


@pytest.mark.parametrize("solving", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["told", "solving again"])
def test_the_page_outlives_a_restart_of_the_server(own_server, open_page, watched, free_port, solving):
    watched.forgiven += ["ERR_CONNECTION_REFUSED", "ERR_INCOMPLETE_CHUNKED_ENCODING", "ERR_CONNECTION_RESET", "ERR_EMPTY_RESPONSE"]
    watched.forgiven += ["503"]  # what was under way when the server began to end, such as a judgement on a slow machine, is answered so
    server = own_server(free_port)
    if solving:
        page = open_preset(open_page, server, SMALL, preset="hybrid", drawing=False)
    else:
        page = open_page(server.address, wait=False, drawing=False)
        until(page, "window.coaxshell?.state.system")
    server.stop()
    page.get_by_text("does not answer").first.wait_for()
    if not solving:
        return
    own_server(free_port)
    until(page, "!document.getElementById('state').textContent.includes('does not answer')")
    page.locator("#preset").select_option(label="absorbers")
    until(page, "window.coaxshell.state.system.control === null")
    rest(page)
    assert run_of(page)["arrays"]["time"].size == 101


@pytest.fixture
def small_page(linked_page):
    """A page with a system at a resolution that takes hundredths of a second."""
    return linked_page()


def address_of(page, preset):
    """Wait until the address holds a preset, which it does half a second after the form, and return its fragment."""
    end = time.monotonic() + PATIENCE
    while opened(link := page.evaluate("location.hash"))["system"]["name"] != preset:
        assert time.monotonic() < end, f"the address does not come to hold {preset}"
        page.wait_for_timeout(50)
    return link


def test_a_link_holds_the_whole_system(server, small_page):
    page = small_page
    links = {}
    for preset in ("active", "bare"):
        page.locator("#preset").select_option(label=preset)
        links[preset] = address_of(page, cx.presets.load(preset).name)
    assert system_of(page).control is None
    page.goto(f"{server.origin}/{links['active']}")
    until(page, "window.coaxshell.state.system.control !== null")
    assert system_of(page) == cx.presets.load("active")


def test_the_last_link_followed_is_opened(small_page):
    """Whatever is kept of the form in the address before the page hears of a link, and whichever answer comes first."""
    page, links = small_page, {}
    for preset in ("absorbers", "bare", "active"):
        page.locator("#preset").select_option(label=preset)
        links[preset] = address_of(page, cx.presets.load(preset).name)
    page.evaluate("link => { const old = location.hash; location.hash = link; history.replaceState(null, '', old); }", links["bare"])
    until(page, "window.coaxshell.state.system.control === null")
    held = []
    page.route("**/api/link/open", lambda route: route.continue_() if held else held.append(route))
    # the address may hold "bare" by now, and following the link that it holds would be no event: another one goes first
    page.evaluate("links => { for (const link of links) location.hash = link; }", [links["absorbers"], links["active"]])
    until(page, "window.coaxshell.state.system.control !== null")
    with page.expect_response("**/api/link/open"):
        held[0].continue_()
    page.wait_for_timeout(200)
    assert system_of(page) == cx.presets.load("active")


@pytest.mark.parametrize("ending", ["toml", "nc"])
def test_a_file_comes_in_and_goes_out_again(small_page, tmp_path, ending):
    page = small_page
    mine = cx.presets.load("bare").with_overrides({"source.peak_pressure": 1.5e5}).replace(name="mine")
    path = tmp_path / f"mine.{ending}"
    if ending == "toml":
        mine.to_toml(path)
    else:
        cx.simulate(mine, duration=1.0, time_step=0.02, modes=8).save(path)
    page.locator("#file").set_input_files(path)
    until(page, "window.coaxshell.state.system.name === 'mine'")
    rest(page)
    assert system_of(page) == mine
    page.locator("#download > button").click()
    with page.expect_download() as started:
        page.locator(f'#download-list a[href*="download.{ending}"]').click()
    saved = tmp_path / f"back.{ending}"
    started.value.save_as(saved)
    back = cx.System.from_toml(saved) if ending == "toml" else cx.load_response(saved).system
    assert back == mine


BEGINNINGS = {"csv": b"time (a/c),", "png": b"\x89PNG\r\n\x1a\n", "svg": b"<?xml"}


@pytest.mark.parametrize("endings", [["csv"], pytest.param(["csv", "png", "svg"], marks=pytest.mark.slow)], ids=["csv", "all"])
def test_figures_and_tables_are_taken_home(small_page, tmp_path, endings):
    for ending in endings:
        small_page.locator("#download > button").click()
        with small_page.expect_download() as started:
            small_page.locator(f'#download-list a[href*=".{ending}"]').click()
        saved = tmp_path / f"taken.{ending}"
        started.value.save_as(saved)
        assert saved.read_bytes().startswith(BEGINNINGS[ending])
    table = np.genfromtxt(tmp_path / "taken.csv", delimiter=",", skip_header=1)
    names = (tmp_path / "taken.csv").read_text().splitlines()[0].split(",")
    settings = {name: run_of(small_page)["resolution"][name] for name in SMALL}
    head = np.asarray(cx.simulate(system_of(small_page), **settings).stress("inner", angle=0))
    assert_allclose(table[:, names.index("inner stress head (Pa)")], head, rtol=1e-6, atol=1e-6 * np.abs(head).max())


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["cancelled", "whole"])
def test_a_film_is_made_and_can_be_cancelled(small_page, tmp_path, whole):
    def choose(entry):
        small_page.locator("#download > button").click()
        small_page.locator(f"#{entry}").click()

    choose("film")
    until(small_page, "document.getElementById('toast').textContent.startsWith('Film:')")
    choose("no-film")
    until(small_page, "document.getElementById('toast').textContent.includes('cancelled')")
    if not whole:
        return
    with small_page.expect_download(timeout=120_000) as started:
        choose("film")
    saved = tmp_path / started.value.suggested_filename
    started.value.save_as(saved)
    assert saved.suffix == ".mp4"
    assert saved.read_bytes()[4:8] == b"ftyp"


def test_a_file_that_is_no_scenario_is_refused_in_words(small_page, tmp_path):
    page = small_page
    path = tmp_path / "broken.toml"
    path.write_text("shells = 3\n")
    page.locator("#file").set_input_files(path)
    until(page, "document.getElementById('toast').textContent.includes('shells')")
    assert page.locator("#toast").is_visible()
    assert system_of(page) == cx.presets.load("absorbers")
