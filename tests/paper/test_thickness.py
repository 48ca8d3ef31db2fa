"""The report "thin or exact walls?": the paper's bare shells of three thicknesses, thin and as elastic solids."""

from __future__ import annotations

import json

import numpy as np
import pytest

from coaxshell.apps.paper.reproduction.results import VERDICTS
from coaxshell.apps.paper.sphere.judged import topic
from coaxshell.apps.paper.thickness.judged import OF_ABSORBERS, absorbers_judged_with_both, judged_with_both, rows
from coaxshell.apps.paper.thickness.kept import as_table, from_table, known_of_absorbers
from coaxshell.apps.paper.thickness.report import power_law, report
from coaxshell.solver.settings import Settings
from coaxshell.solver.thin_error import thin_map

KNOWN = {
    "12 mm": ((11, 16), (6, 7), (11, 12)),
    "24 mm": ((14, 24), (6, 8), (11, 14)),
    "48 mm": ((18, 48), (8, 14), (12, 17)),
}
"""Differences of the hoop stress from exact walls' (%), by an independent program: of all points wetted at mid-surfaces; at faces, of the
inner and of the outer shell."""


@pytest.fixture(scope="module")
def small():
    return report(Settings(duration=3.0, time_step=5e-3, modes=40))


def test_thin_walls_differ_as_an_independent_program_found(small):
    assert tuple(small.found) == tuple(KNOWN)
    for one, (middle, inner, outer) in zip(small.found.values(), KNOWN.values(), strict=True):
        assert one.points == ("inner head", "inner tail", "outer head", "outer tail")
        faces = 100 * one.difference("faces")
        for found, (low, high) in ((100 * one.difference("mid-surface"), middle), (faces[:2], inner), (faces[2:], outer)):
            assert low - 1.0 < found.min() < found.max() < high + 1.0
    peaks = small.found["12 mm"].peak_ratio("mid-surface")
    np.testing.assert_allclose(peaks, 1.0, atol=0.025)


def test_the_report_holds_every_number_and_picture(small):
    text = small.markdown()
    for thickness, one in small.found.items():
        shown = " | ".join(f"{100 * value:.1f} %" for value in one.difference("faces"))
        assert f"| {thickness} | faces | {shown} |" in text
    for name, figure in small.figures().items():
        assert f"({name}.png)" in text
        assert figure.axes


@pytest.mark.slow
def test_statements_about_histories_and_waves_are_judged_with_both():
    found = rows(judged_with_both(Settings(duration=4.0, time_step=2e-2, modes=12)))
    assert [row[0] for row in found] == [str(number) for number in range(6, 21)]
    assert all(row[2] in VERDICTS and row[3] in VERDICTS for row in found)
    assert all(thin != exact for *_, thin, exact in found)  # other numbers, whatever they come to


def test_kept_statements_on_absorbers_are_what_is_found():
    """All of them, in the order of the topics; and made again coarsely, one of a single absorber and one of a ring."""
    kept = known_of_absorbers()
    assert [one.claim.name for one in kept] == [name for module in OF_ABSORBERS for name in topic(module).names]
    assert all(verdict in VERDICTS for row in rows(kept) for verdict in row[2:4])
    assert json.loads(json.dumps(as_table(from_table(as_table(kept))))) == as_table(kept)
    (coarse,) = absorbers_judged_with_both(Settings(duration=4.0, time_step=4e-2, modes=8), modules=("count",))
    thin, exact = coarse.findings["corrected"], coarse.findings["exact"]
    assert (
        thin.measured.keys()
        == exact.measured.keys()
        == kept[[one.claim.name for one in kept].index(coarse.claim.name)].corrected.measured.keys()
    )
    for name, value in thin.measured.items():
        assert exact.measured[name] == pytest.approx(value, abs=5.0)  # per cent
        assert exact.measured[name] != value


@pytest.mark.slow
def test_statements_on_absorbers_made_again_are_those_kept():
    for now, known in zip(absorbers_judged_with_both(), known_of_absorbers(), strict=True):
        for which, found in now.findings.items():
            assert found.verdict == known.findings[which].verdict
            assert found.measured == pytest.approx(known.findings[which].measured, rel=1e-3)


def test_power_laws_hold_their_part_of_the_map():
    law = power_law(thin_map(), "dry", "mid-surface")
    at = law.scale * 0.096**law.thickness * 0.2**law.decay * 4.0**law.duration
    assert thin_map().estimate("dry", "mid-surface", 0.096, 0.2, 4.0) == pytest.approx(at, rel=law.within - 1.0)
    assert 1.0 < law.within < 2.5
    assert 0.8 < law.thickness < 1.0


def test_points_that_nothing_has_reached_have_no_difference(small):
    early = small.found["12 mm"].up_to(0.3)
    assert np.isnan(early.difference("faces")[1])
    assert np.isfinite(early.difference("faces")[2])
