"""The report "slice, cylinder or sphere?": the paper's bare shells under the sphere and what stands for it in two dimensions."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.paper.sphere.compared import KINDS, compare
from coaxshell.apps.paper.sphere.report import report
from coaxshell.errors import InputError
from coaxshell.solver.settings import Settings

KNOWN = {
    "inner head": (0.129, 0.0848, 60),
    "inner tail": (0.182, 0.1373, 49),
    "outer head": (0.151, 0.0690, 82),
    "outer tail": (0.163, 0.1024, 64),
}
"""Largest hoop stress (MPa) to t = 4 of slice and sphere, and the difference of the histories (%), by an independent program."""


@pytest.fixture(scope="module")
def small():
    return report(Settings(duration=4.0, time_step=8e-3, modes=30))


def test_the_slice_and_the_sphere_are_what_an_independent_program_found(small):
    found = small.found
    assert found.points == tuple(KNOWN)
    for i, (in_slice, in_sphere, differs) in enumerate(KNOWN.values()):
        assert found.peaks("slice")[0][i] / 1e6 == pytest.approx(in_slice, rel=0.01)
        assert found.peaks("sphere")[0][i] / 1e6 == pytest.approx(in_sphere, rel=0.01)
        assert 100 * found.difference("slice")[i] == pytest.approx(differs, abs=1.0)


def test_the_report_holds_every_number_and_picture(small):
    text = small.markdown()
    for point in KNOWN:
        assert f"| {point} |" in text
    for name, figure in small.figures().items():
        assert f"({name}.png)" in text
        assert figure.axes
    assert small.difference_rows[-1][1] == f"{100 * small.found.overall('slice'):.0f} %"


def test_differences_are_relative_and_points_not_reached_have_none(small):
    early = small.found.up_to(0.4)
    assert early.time[-1] <= 0.4
    assert np.isnan(early.difference("slice")[1])
    assert np.isfinite(early.difference("slice")[2])


def test_what_is_no_spherical_shock_is_refused():
    with pytest.raises(InputError, match="is not one spherical shock"):
        compare(cx.presets.load("iakovlev-evacuated"), Settings(duration=1.0, time_step=0.1, modes=3), tuple(KINDS))
