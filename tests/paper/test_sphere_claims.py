"""The paper's claims judged under the slice and under the true sphere, at a small resolution; at the full one behind the slow marker."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.paper.claims import claims
from coaxshell.apps.paper.claims.systems import preset
from coaxshell.apps.paper.reproduction import write
from coaxshell.apps.paper.reproduction.plan import part_cost, parts
from coaxshell.apps.paper.reproduction.results import Results, SphereSection
from coaxshell.apps.paper.sphere import judged as judging
from coaxshell.apps.paper.sphere.compared import SPHERE
from coaxshell.apps.paper.sphere.judged import OF_POSITIONS, RESOLUTION, TOPICS, judged_in_both, pair, spans, topic
from coaxshell.apps.paper.sphere.kept import as_table, from_table, known_claims
from coaxshell.apps.paper.sphere.report import claims_markdown
from coaxshell.apps.paper.sphere.texts import CAPTIONS, CLAIMS_TITLE
from coaxshell.solver.settings import Settings
from coaxshell.studies.store import Store

SMALL = Settings(duration=4.0, time_step=5e-2, modes=6)
LATER = ("mass", "cubic", "position", "count", "damping")
"""Topics of many runs, which are judged in earnest only."""
QUICK = tuple(one for one in TOPICS if one.module not in LATER)


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    return Store(tmp_path_factory.mktemp("sphere"))


@pytest.fixture(scope="module")
def small(store):
    return judged_in_both(SMALL, QUICK, store)


def found(judgement, name):
    return pair(next(one for one in judgement.claims if one.claim.name == name))


def test_claims_are_named_once_and_judged_in_the_papers_order(small):
    names = [name for one in TOPICS for name in one.names]
    assert len(set(names)) == len(names) >= 40
    number_of = {claim.name: claim.number for claim in claims()}
    numbers = [number_of[name] for name in names]
    assert numbers == sorted(numbers)
    assert [one.claim.name for one in small.claims] == [name for one in QUICK for name in one.names]


def test_each_has_numbers_and_a_verdict_under_both(small):
    for one in small.claims:
        slice_, sphere = pair(one)
        assert slice_.measured.keys() == sphere.measured.keys()
        for finding in (slice_, sphere):
            assert finding.verdict in ("holds", "holds in part", "does not hold")
            assert all(math.isfinite(value) for value in finding.measured.values())
    differing = [one for one in small.claims if pair(one)[0].measured != pair(one)[1].measured]
    assert len(differing) >= len(small.claims) - 3  # onsets may be the same to the step


def test_numbers_are_those_of_runs_in_two_and_three_dimensions(small):
    asked = {"settings": SMALL}
    slice_, sphere = found(small, "tail-bears-the-peak")
    plane = cx.simulate("bare", **asked)
    space = cx.simulate("bare", settings=replace(SMALL, dimensions=3, stations=(0.0,)))
    for finding, stress in ((slice_, plane.stress("inner", 180)), (sphere, space.stress("inner", 180, station=0.0))):
        expected = float(np.abs(stress).max()) / 1e6
        assert finding.measured["inner tail, peak stress (MPa)"] == pytest.approx(expected, rel=1e-12)
    slice_, sphere = found(small, "proportional-gain-matters-most")
    system = preset("bare").replace(control=cx.PDControl(proportional=-2e4, derivative=0.0))
    controlled = cx.simulate(system, settings=replace(SMALL, dimensions=3, stations=(0.0,)))
    fall = 100 * (1 - float(np.abs(controlled.stress("outer", 0, station=0)).max() / np.abs(space.stress("outer", 0, station=0)).max()))
    assert sphere.measured["outer head, reduction by k_p alone (%)"] == pytest.approx(fall, rel=1e-9)
    linked = preset("bare").replace(absorbers=[cx.Absorber(angle=0.0, mass=10.0, linear_stiffness=1e9)])
    absorbed = cx.simulate(linked, settings=replace(SMALL, dimensions=3, stations=(0.0,))).stress("inner", 180, station=0)
    without = space.stress("inner", 180, station=0)
    change = 100 * float(np.linalg.norm(absorbed - without) / np.linalg.norm(without))
    sphere = found(small, "single-absorber-is-marginal")[1]
    assert sphere.measured["inner tail, change (%)"] == pytest.approx(change, rel=1e-9)


def test_pressures_under_the_sphere_are_those_across_the_axis(store):
    fields = judging.under_the_sphere(SMALL, store).fields(preset("bare"))
    space = cx.simulate("bare", settings=replace(SMALL, dimensions=3, stations=(0.0,)))
    peak = preset("bare").source.peak_pressure
    inner = space.pressure(radius=[0.5 - 1e-9, 0.5 + 1e-9], angle=[fields["angle"][40]], time=fields["wall time"], filter="lanczos")
    np.testing.assert_allclose(fields["inner wall"][:, :, 40], inner[..., 0] / peak, rtol=1e-9, atol=1e-9)
    assert "stored" not in fields


def test_a_verdict_that_turns_is_told(small):
    turned = replace(small.claims[0], findings={**small.claims[0].findings, SPHERE: replace(pair(small.claims[0])[1], verdict="holds")})
    same = replace(turned, findings=dict.fromkeys(turned.findings, turned.findings[SPHERE]))
    told = replace(small, claims=(turned, same)).told
    assert f"Verdicts turn: no. {turned.claim.number}." in told
    assert "2 hold, 0 hold in part, 0 do not under the sphere" in told
    assert "No verdict turns." in replace(small, claims=(same,)).told


def test_resolutions_are_told_with_the_claims_that_they_are_of(small):
    name = small.claims[-1].claim.name
    told = replace(small, resolutions={**small.resolutions, name: replace(SMALL, modes=5)}).told
    numbers = [one.claim.number for one in small.claims]
    assert f"M = 6, time step 0.05, to t = 4 (no. {spans(numbers[:-1])}); M = 5, time step 0.05, to t = 4 (no. {numbers[-1]})." in told
    assert spans([3, 4, 5, 7, 9, 10]) == "3 to 5, 7, 9 to 10"


def test_the_reports_have_a_row_a_claim(small, tmp_path):
    section = SphereSection("text", [("caption", ["heading"], [["cell"]])] * 3, "told", dict.fromkeys(CAPTIONS, b"png"), small)
    pages = {path.suffix: path.read_text(encoding="utf-8") for path in write(Results(SMALL, sphere=section), tmp_path)}
    for page in (*pages.values(), "\n".join([CLAIMS_TITLE, *claims_markdown(small)])):
        assert CLAIMS_TITLE in page
        for one in small.claims:
            assert one.claim.statement.split("'")[0] in page
        assert "M = 6, time step 0.05, to t = 4" in page
    assert pages[".html"].count('<b class="') == 2 * len(small.claims)


def test_their_runs_are_no_finer_than_they_must_be_and_are_planned():
    assert topic("bare").resolution(Settings()) == RESOLUTION
    assert topic("position").resolution(Settings()) == OF_POSITIONS
    assert topic("position").resolution(SMALL) == SMALL.up_to(2.0)
    assert topic("damping").resolution(SMALL) == topic("bare").resolution(SMALL) == SMALL
    planned = [part for part in parts(Settings(), only=frozenset({"sphere"})) if part.kind == "claims under the sphere"]
    assert [part.about for part in planned] == [one.module for one in TOPICS]
    assert all(part_cost(part, Settings()).seconds > 5 for part in planned)
    assert topic("active").asked()["bare"] == preset("bare")


def test_the_package_holds_every_claim_at_the_reports_resolution(small):
    kept = known_claims()
    assert kept.resolutions == {name: one.resolution(RESOLUTION) for one in TOPICS for name in one.names}
    assert [one.claim.name for one in kept.claims] == list(kept.resolutions)
    coarse = {one.claim.name: one for one in small.claims}
    for one in kept.claims:
        measured = [finding.measured.keys() for finding in pair(one)]
        assert measured[0] == measured[1]
        if one.claim.name in coarse:
            assert measured == [finding.measured.keys() for finding in pair(coarse[one.claim.name])]
    again = from_table(as_table(small))
    assert [pair(one)[1].why for one in again.claims] == [pair(one)[1].why for one in small.claims]
    sphere = found(kept, "tail-bears-the-peak")[1]
    assert sphere.measured["inner tail, peak stress (MPa)"] == pytest.approx(0.1373, rel=0.01)  # an independent program's
    assert sphere.measured["outer head, peak stress (MPa)"] == pytest.approx(0.0690, rel=0.01)


@pytest.mark.slow
def test_the_package_holds_what_runs_of_today_say():
    for one, kept in zip(judged_in_both(RESOLUTION).claims, known_claims().claims, strict=True):
        for found_now, known in zip(pair(one), pair(kept), strict=True):
            assert found_now.verdict == known.verdict
            for name, value in known.measured.items():
                assert found_now.measured[name] == pytest.approx(value, rel=1e-3, abs=1e-3)
