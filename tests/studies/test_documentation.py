"""The study files in the documentation are studies."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import coaxshell as cx
from coaxshell.studies import OptimisationStudy, SensitivityStudy, SweepStudy, read_study

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture
def studies(tmp_path):
    """Return a function that reads all study files of a page, in a folder that has the user's function they name."""
    (tmp_path / "mine.py").write_text("def ratio(response):\n    return 1.0\n")

    def read(page, kind):
        blocks = re.findall(r"```toml\n(.*?)```", (DOCS / page).read_text(encoding="utf-8"), re.DOTALL)
        for number, block in enumerate(blocks):
            (tmp_path / f"{number}.toml").write_text(block)
        return [read_study(tmp_path / f"{number}.toml", kind) for number in range(len(blocks))]

    return read


def test_sweep(studies, tmp_path):
    (study,) = studies("studies.md", SweepStudy)
    _, design, metrics, _ = study.parts(tmp_path)
    assert len(design.cases) == 11 * 7 * 3
    assert [metric.name for metric in metrics] == ["inner.peak_stress", "interior.rms_pressure", "ratio"]


def test_sensitivity(studies, tmp_path):
    (study,) = studies("sensitivity.md", SensitivityStudy)
    systems = study.plan(tmp_path).systems
    assert len(systems) == 256 * 7
    assert all(isinstance(system, cx.System) for system in systems)


def test_optimisations(studies, tmp_path):
    nominal, robust = (study.problem(tmp_path) for study in studies("optimisation.md", OptimisationStudy))
    assert not nominal.targets.statistics
    assert robust.targets.statistics
    assert len(robust.uncertain.scenarios(robust.space.base)) == 33
