"""The report of a run: what stands in it is what the run says, it needs nothing from outside, and what it cannot tell it says."""

from __future__ import annotations

import csv
import io
from html.parser import HTMLParser
from urllib.parse import unquote

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.report import PARTS, report_cost
from coaxshell.apps.report.system import _fitted
from coaxshell.model.prefixes import engineering

SHORT = {"duration": 2.0, "time_step": 0.05, "modes": 4}


class Page(HTMLParser):
    """What a report holds: text, pictures, links, headings and the files that can be saved from it."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.words: list[str] = []
        self.pictures: list[dict[str, str]] = []
        self.addresses: list[str] = []
        self.files: dict[str, str] = {}
        self.feed(text)
        self.text = " ".join(" ".join(self.words).split())

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.addresses += [found[name] for name in ("src", "href") if name in found]
        if tag == "img":
            self.pictures.append(found)
        if "download" in found:
            self.files[found["download"]] = unquote(found["href"].partition(",")[2])

    def handle_data(self, data):
        self.words.append(data)


PICTURE = b'<svg xmlns="http://www.w3.org/2000/svg" width="72" height="36"/>'


@pytest.fixture(scope="module", autouse=True)
def unseen():
    """Leave pictures empty, which nobody looks at here: drawing them takes all the time of a report."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("matplotlib.figure.Figure.savefig", lambda figure, file, **options: file.write(PICTURE))
        yield


@pytest.fixture(scope="module")
def runs():
    return cx.simulate("hybrid", **SHORT), cx.simulate("bare", **SHORT)


@pytest.fixture(scope="module")
def page(runs, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "report.html"
    stages = []
    assert runs[0].report(path, runs[1], without=PARTS, progress=lambda fraction, stage: stages.append((fraction, stage))) == path
    assert [fraction for fraction, _ in stages] == sorted(fraction for fraction, _ in stages)
    assert stages[-1] == (1.0, "report")
    return Page(path.read_text(encoding="utf-8"))


def test_nothing_comes_from_outside_and_every_picture_is_described(page):
    assert all(address.startswith(("data:", "#")) for address in page.addresses)
    assert len(page.pictures) == 6
    assert all(len(picture["alt"]) > 40 for picture in page.pictures)


def test_numbers_are_those_of_the_run(page, runs):
    hybrid, bare = runs
    peak = hybrid.peak_stress("inner")
    for value, unit in ((peak.value, "Pa"), (hybrid.summary().shells[0].stress.value, "Pa"), (bare.summary().shells[1].stress.value, "Pa")):
        assert engineering(value, unit) in page.text
    limit = hybrid.summary().shells[0].actuator_limit
    assert engineering(limit, "V") in page.text
    assert engineering(float(np.abs(hybrid.absorber_stroke()).max()), "m") in page.text
    assert all(warning in page.text for warning in (*hybrid.warnings, *bare.warnings))
    assert "the descriptions differ in absorbers, control" in page.text


def test_data_of_figures_can_be_saved(page, runs):
    heading, *rows = csv.reader(io.StringIO(page.files["stress.csv"]))
    table = dict(zip(heading, np.array(rows, dtype=float).T, strict=True))
    expected = runs[0].stress("outer", [180.0]).to_numpy()[:, 0]
    found = table["hybrid outer stress 180 deg (Pa)"]
    assert np.allclose(found, expected, rtol=1e-5, atol=1e-5 * np.abs(expected).max())
    assert {"loads.csv", "stress.csv", "relative-displacement.csv", "actuator-voltage.csv", "strokes.csv"} <= set(page.files)


def test_the_map_of_the_largest_stress_can_be_saved(page, runs):
    heading, *rows = csv.reader(io.StringIO(page.files["largest-stress.csv"]))
    table = dict(zip(heading, np.array(rows, dtype=float).T, strict=True))
    of_bare = [values for name, values in table.items() if name.startswith("bare inner layer ")]
    assert len(of_bare) == 3 * 9
    peak = runs[1].peak_stress("inner")
    assert 0.99 * peak.value < max(values.max() for values in of_bare) <= 1.0001 * peak.value
    assert np.array_equal(table["angle (deg)"], np.arange(0.0, 181.0))


def test_it_can_be_repeated_from_what_it_holds(page, runs):
    assert cx.System.from_toml_string(page.files["scenario.toml"]) == runs[0].system
    assert cx.System.from_toml_string(page.files["scenario-compared.toml"]) == runs[1].system
    assert "coaxshell run scenario.toml --duration 2.0 --time-step 0.05 --modes 4 --output run1.nc" in page.text


def test_three_dimensions_and_elastic_walls(tmp_path):
    bare = cx.presets.load("bare")
    inner, outer = bare.shells
    system = bare.replace(shells=[inner.replace(theory="elastic"), outer])
    response = cx.simulate(system, duration=1.0, time_step=0.05, modes=3, dimensions=3, stations=[0.0, 0.5])
    found = Page(response.report(tmp_path / "space.html", without=PARTS).read_text(encoding="utf-8"))
    peak = response.stress("outer", [0.0])
    assert ("z (m)" in found.text, "In brief Left out" in found.text) == (True, False)
    heading = found.files["stress.csv"].partition("\n")[0].split(",")
    assert "outer stress 0 deg z = 0.5 m (Pa)" in heading
    assert engineering(float(np.abs(peak).max()), "Pa") in found.text


def test_the_sea_is_told(runs):
    system = runs[1].system.replace(sea=cx.Sea(depth=20.0, bottom=30.0))
    (told,) = (text for text in _fitted(system) if "sea" in text)
    assert told == "In the sea: the axis lies 20.00 m below the surface, which is at 90°, a rigid bottom 30.00 m below it."


def test_what_is_refused(tmp_path, runs):
    with pytest.raises(cx.InputError, match=r"path: .*known ending"):
        runs[0].report(tmp_path / "report.pdf")
    with pytest.raises(cx.InputError, match="without: 'films' is no part"):
        runs[0].report(tmp_path / "report.html", without=["films"])
    assert list(tmp_path.iterdir()) == []


def test_the_time_it_takes_grows_with_what_it_holds(runs):
    hybrid, bare = runs
    assert report_cost(hybrid, without=PARTS).seconds < report_cost(hybrid).seconds < report_cost(hybrid, bare).seconds


def test_the_command_and_what_a_run_cannot_tell(tmp_path, monkeypatch, capsys, runs):
    from coaxshell.apps.cli import main

    monkeypatch.chdir(tmp_path)
    runs[1].thin(every=2).save("thin.nc")
    short = ["report", "thin.nc", "--quiet", "--without", "spectra", "--without", "fields"]
    assert main(short) == 0
    assert capsys.readouterr().out == "wrote report.html\n"
    assert "Energy Left out: " in Page((tmp_path / "report.html").read_text(encoding="utf-8")).text
    assert main(short) == 2
    assert "exists already" in capsys.readouterr().err
    assert main(["report", "bare", "--quiet", "--without", "films", "--force"]) == 2
    assert capsys.readouterr().err.startswith("error: --without: 'films'")
