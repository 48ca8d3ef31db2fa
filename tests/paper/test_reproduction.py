"""The reproduction at a coarse resolution: one report with every figure and claim, resumed where it was cut off."""

from __future__ import annotations

import html
import math
import re
from dataclasses import replace

import numpy as np
import pytest

from coaxshell.apps.cli import main
from coaxshell.apps.paper import FIGURES, StudyRecipe
from coaxshell.apps.paper.claims import claims, judge
from coaxshell.apps.paper.claims.systems import preset
from coaxshell.apps.paper.known_runs import CORRECTED
from coaxshell.apps.paper.reproduction import VARIANTS, reproduce, write
from coaxshell.apps.paper.reproduction import results as reading
from coaxshell.apps.paper.reproduction import run as running
from coaxshell.apps.paper.reproduction import work as working
from coaxshell.apps.paper.reproduction.plan import Part, groups, part_cost, parts
from coaxshell.apps.paper.slips import SLIPS
from coaxshell.errors import InputError
from coaxshell.numerics import memory
from coaxshell.solver.settings import Settings

TINY = Settings(duration=0.6, time_step=2e-2, modes=6)
ONLY = frozenset({"figures"})


@pytest.fixture(scope="module", autouse=True)
def small_fields():
    """Draw the figures of many pressure fields as Figure 3, which takes a moment; they have tests of their own."""
    figure = working._WORK["figure"]
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(working._WORK, "figure", lambda job, store: figure(replace(job, part=Part("figure", "3")), store))
        yield


FEW = {
    "figures": ("3", "6"),
    "parts": {Part("figure", "3"), Part("runs", "of the presets"), Part("runs", "of masses")},
}
"""A figure of fields, one of many runs, and the runs of these."""

SOME = {
    "figures": ("3", "4", "6", "10"),
    "parts": {Part("figure", "3"), Part("figure", "4"), *(Part("runs", f"of {name}") for name in ("the presets", "masses", "dampings"))},
}


def leave_out(patch, chosen):
    """Let a reproduction have no more than the figures and parts chosen."""
    patch.setattr(reading, "FIGURES", {number: FIGURES[number] for number in chosen["figures"]})
    patch.setattr(running, "parts", lambda *given, **options: (part for part in parts(*given, **options) if part in chosen["parts"]))


@pytest.fixture(scope="module", params=["few", pytest.param("all", marks=pytest.mark.slow)])
def extent(request):
    """Return how many figures are drawn and claims judged: few, or all."""
    return request.param


@pytest.fixture(scope="module")
def results(extent, tmp_path_factory, small_fields):
    with pytest.MonkeyPatch.context() as patch:
        if extent == "few":
            leave_out(patch, FEW)
        return reproduce(tmp_path_factory.mktemp(extent), TINY, only=ONLY, film_suffix=None, workers=1)


@pytest.fixture(scope="module")
def judged(extent, runs, changed, scaled):
    """Return claims judged, all or the first twenty, which take few runs, the corrected model's runs standing for every variant but one."""
    other = changed(lambda name, run: scaled(run, 2.0, "outer"))
    chosen = claims()[: None if extent == "all" else 20]
    return tuple(judge(claim, {name: other if name == "both slips" else runs for name in VARIANTS}) for claim in chosen)


def test_every_figure_and_every_claim_is_in_the_report(results, judged, tmp_path):
    found = replace(
        results, judged=judged, seconds={**results.seconds, "one | more": 1.0}, processor={**results.processor, "one | more": 1.0}
    )
    pages = {path.suffix: path.read_text(encoding="utf-8") for path in write(found, tmp_path)}
    drawn = [figure.recipe.number for figure in found.figures]
    assert drawn in (list(FEW["figures"]), list(FIGURES))
    for number in drawn:
        assert f'id="figure-{number}"' in pages[".html"]
        assert f"coaxshell figure {number} --duration 0.6 --time-step 0.02 --modes 6" in pages[".md"]
        assert (tmp_path / "figures" / f"figure-{number}.png").read_bytes().startswith(b"\x89PNG")
    for one in found.judged:
        assert f'id="claim-{one.claim.number}"' in pages[".html"]
        assert set(one.findings) == set(VARIANTS)
        assert one.corrected.why in html.unescape(pages[".html"])
    assert sum(found.tally(CORRECTED).values()) == len(judged) >= 20
    assert any(one.turned == ("both slips",) for one in found.judged)
    assert "one \\| more" in pages[".md"]
    assert not re.search(r'(src|href)="(?!data:|#)', pages[".html"])


def test_the_parts_hold_every_run_that_claims_and_figures_ask_for(runs, judged):
    planned = {runs._key(system, group.resolution) for group in groups(runs.resolution).values() for system in group.systems.values()}
    for recipe in FIGURES.values():
        if isinstance(recipe, StudyRecipe) and recipe.number != "9":  # its runs are those of the claims, without histories
            list(recipe.draw([preset(name) for name in recipe.presets], runs, None).warnings)
    assert set(runs._known) <= planned


def test_a_run_that_was_cut_off_ends_like_one_that_was_not(results, tmp_path_factory, monkeypatch):
    """Of the whole only as much as shows it: two figures of fields, two of many runs, and the runs of these."""
    folder = tmp_path_factory.mktemp("cut")
    chosen = FEW if len(results.figures) == len(FEW["figures"]) else SOME
    before = len(chosen["parts"]) // 2 + 1
    leave_out(monkeypatch, chosen)
    done = []
    carry_out = running.carry_out

    def until(job):
        if len(done) == before:
            raise KeyboardInterrupt
        done.append(job.part)
        return carry_out(job)

    monkeypatch.setattr(running, "carry_out", until)
    with pytest.raises(KeyboardInterrupt):
        reproduce(folder, TINY, only=ONLY, film_suffix=None, workers=1)
    assert not list(folder.glob("**/.*.part*"))
    monkeypatch.setattr(running, "carry_out", carry_out)
    whole = reproduce(folder, TINY, only=ONLY, film_suffix=None, workers=1)
    assert whole.resumed == before
    assert len(whole.seconds) == len(chosen["parts"])
    expected = [figure.png for figure in results.figures if figure.recipe.number in chosen["figures"]]
    assert [figure.png for figure in whole.figures] == expected


def test_the_film_the_slips_and_the_estimate(tmp_path, monkeypatch):
    monkeypatch.setitem(working.FILM, "frames", 4)
    monkeypatch.setitem(working.FILM, "pixels", 60)
    monkeypatch.setattr(working, "DIRECT_SAMPLE", (2,))
    small = Settings(duration=0.6, time_step=2e-2, modes=6)
    found = reproduce(tmp_path, small, only=frozenset({"film", "slips", "estimate"}), film_suffix=".webp", workers=1)
    film, suffix = found.film
    assert film[8:12] == b"WEBP"
    assert suffix == ".webp"
    assert found.estimate.runs == 76
    assert found.estimate.whole == pytest.approx(76 * np.mean(found.estimate.direct), rel=1e-12)
    assert found.estimate.ours is None
    assert {key for effect in found.effects for key in effect["slips"]} <= set(SLIPS)
    assert all(math.isfinite(effect["corrected"]["inner"]) for effect in found.effects)
    page = {path.suffix: path.read_text(encoding="utf-8") for path in write(found, tmp_path)}[".html"]
    assert "data:image/webp;base64," in page
    assert all(f">{key}</td>" in page for key in SLIPS)


def test_thin_and_exact_walls_are_a_section_with_pictures(tmp_path):
    found = reproduce(tmp_path, TINY, only=frozenset({"walls"}), workers=1)
    assert list(found.seconds) == ["walls thin or exact"]
    pages = {path.suffix: path.read_text(encoding="utf-8") for path in write(found, tmp_path)}
    assert pages[".html"].count("data:image/png") == len(found.walls.pictures) == 2
    for page in pages.values():
        assert "Thin or exact walls?" in page
        assert "M = 6, time step 0.02, to t = 0.6" in page
        assert "48 mm" in page
    for name, picture in found.walls.pictures.items():
        assert (tmp_path / "figures" / f"{name}.png").read_bytes() == picture
        assert f"(figures/{name}.png)" in pages[".md"]


def test_slice_and_sphere_are_a_section_with_pictures(tmp_path):
    found = reproduce(tmp_path, TINY, only=frozenset({"sphere"}), workers=1)
    assert list(found.seconds) == ["sphere beside the slice"]
    pages = {path.suffix: path.read_text(encoding="utf-8") for path in write(found, tmp_path)}
    assert pages[".html"].count("data:image/png") == len(found.sphere.pictures) == 2
    for page in pages.values():
        assert "Slice, cylinder or sphere?" in page
        assert "M = 6, time step 0.02, to t = 0.6" in page
        assert "outer head" in page
    for name, picture in found.sphere.pictures.items():
        assert (tmp_path / "figures" / f"{name}.png").read_bytes() == picture
        assert f"(figures/{name}.png)" in pages[".md"]


def test_parts_are_named_once_and_chosen_by_topic():
    every = list(parts(TINY))
    assert len(every) == len(set(every)) == len({part.title for part in every})
    assert {part.kind for part in parts(TINY, only=frozenset({"slips"}))} == {"slips"}
    assert Part("film", "bare against hybrid") not in parts(TINY, film=False)
    counted = {name for group in groups(TINY).values() if group.peaks_only for name in group.systems}
    assert len(counted) == 76


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--only", "tables"], "no topic 'tables'"),
        (["--duration", "1"], "too short for the claims"),
        (["--time-step", "-1"], "--time-step"),
        (["--modes", "auto"], "'auto' is not allowed"),
        (["--workers", "none"], "not a whole number"),
    ],
)
def test_a_bad_option_is_told_in_one_line(tmp_path, monkeypatch, capsys, arguments, told):
    monkeypatch.chdir(tmp_path)
    assert main(["reproduce", *arguments]) == 2
    error = capsys.readouterr().err
    assert told in error
    assert error.count("\n") == 1
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_the_whole_paper_at_its_resolution(tmp_path):
    assert main(["reproduce", "--output", str(tmp_path), "--quiet"]) == 0
    assert (tmp_path / "report.html").stat().st_size > 1e6
    assert len(list((tmp_path / "figures").iterdir())) == len(FIGURES) + 2


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["refused", "told too"])
def test_what_does_not_fit_side_by_side_is_refused_and_the_time_is_told(tmp_path, monkeypatch, whole):
    told = []
    monkeypatch.setattr(working, "DIRECT_SAMPLE", (2,))
    monkeypatch.setenv(memory.VARIABLE, "2 GB")
    with pytest.raises(InputError, match=r"the reproduction of \d+ parts in 8 processes needs about .* use workers=[12]"):
        reproduce(tmp_path, TINY, workers=8)
    assert not any((tmp_path / "parts").glob("*.npz"))
    if not whole:
        return
    monkeypatch.delenv(memory.VARIABLE)
    reproduce(tmp_path, TINY, only=frozenset({"estimate"}), workers=1, tell=told.append)
    reproduce(tmp_path, TINY, only=frozenset({"estimate"}), workers=1, tell=told.append)
    assert told[0].seconds > 0.1
    assert told[1].seconds == 0.0  # all is there
    fine = Settings()
    costs = {part.kind: part_cost(part, fine) for part in parts(fine) if part.kind in ("direct", "fields")}
    assert costs["direct"].seconds > costs["fields"].seconds > 10.0
