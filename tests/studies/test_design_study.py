"""The studies of docs/design-study.md: their files are valid, and the stored best systems give the stored numbers."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.studies import OptimisationStudy, read_study

STUDIES = Path(__file__).parents[2] / "docs" / "studies"
NAMES = ["a-equal-absorbers", "b-25-free", "b-60-free", "b-mirror-pairs", "c-hybrid", "d-mass-front", "e-robust-free"]
SCRIPTS = ["c-electrodes", "d-front", "optima-in-space"]


def test_every_study_has_a_result():
    assert sorted(path.stem for path in STUDIES.glob("*.toml")) == NAMES
    assert sorted(path.name for path in (STUDIES / "results").iterdir()) == sorted([*NAMES, *SCRIPTS])
    assert {name.replace("-", "_") for name in SCRIPTS} < {path.stem for path in STUDIES.glob("*.py")}


@pytest.mark.slow_for("c-hybrid", "b-60-free")
@pytest.mark.parametrize("name", NAMES)
def test_the_best_system_gives_the_number_told(name):
    problem = read_study(STUDIES / f"{name}.toml", OptimisationStudy).problem(STUDIES)
    told = json.loads((STUDIES / "results" / name / "optimum.json").read_text(encoding="utf-8"))
    assert told["evaluations"] == problem.evaluations
    assert told["method"] == problem.method
    assert told["feasible"]
    system = cx.System.from_toml(STUDIES / "results" / name / "best.toml")
    masses = sum(one.mass for one in system.absorber_list)
    assert_allclose(masses, told["best"]["targets"]["absorbers.mass"], rtol=1e-9)
    if "inner.peak_stress" not in told["best"]["targets"]:
        return  # of the worst of many shocks: too many runs for a test
    found = cx.simulate(system, **problem.resolution.arguments()).summary()
    above = found.shells[0].stress.value / told["best"]["targets"]["inner.peak_stress"] - 1.0
    assert -1e-6 < above < 1e-5  # the search took the crest nearest to an angle of its own for the highest: a is 7.5e-6 higher
