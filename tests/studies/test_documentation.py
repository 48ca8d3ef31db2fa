"""The study files in the documentation are studies."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import coaxshell as cx
from coaxshell.studies import FitStudy, OptimisationStudy, SensitivityStudy, SweepStudy, read_study

DOCS = Path(__file__).parents[2] / "docs"


@pytest.fixture
def studies(tmp_path):
    """Return a function that reads all study files of a page."""

    def read(page, kind):
        blocks = re.findall(r"```toml\n(.*?)```", (DOCS / page).read_text(encoding="utf-8"), re.DOTALL)
        for number, block in enumerate(blocks):
            (tmp_path / f"{number}.toml").write_text(block)
        return [read_study(tmp_path / f"{number}.toml", kind) for number in range(len(blocks))]

    return read


def test_sweep(studies, tmp_path):
    (study,) = studies("studies.md", SweepStudy)
    _, design, metrics, _ = study.parts(tmp_path)
    assert len(design.cases) == 11 * 7
    assert [metric.name for metric in metrics] == ["inner.peak_stress", "outer.peak_stress"]


def test_the_users_function_of_the_page(tmp_path):
    (code,) = re.findall(r"```python\n(def ratio.*?)```", (DOCS / "studies.md").read_text(encoding="utf-8"), re.DOTALL)
    (tmp_path / "mine.py").write_text(code)
    resolution = {"duration": 1, "time_step": 1e-2, "modes": 8}
    metrics = {"stress": "inner.peak_stress", "ratio": f"{tmp_path / 'mine.py'}:ratio"}
    found = cx.sweep(cx.presets.load("bare"), over={"source.distance": ["5 m"]}, metrics=metrics, workers=1, **resolution)
    inner, outer = (shell.stress.value for shell in cx.simulate(cx.presets.load("bare"), **resolution).summary().shells)
    assert found["ratio"].item() == pytest.approx(inner / outer, rel=1e-12)
    assert found["stress"].item() == pytest.approx(inner, rel=1e-12)


def test_sensitivity(studies, tmp_path):
    (study,) = studies("sensitivity.md", SensitivityStudy)
    systems = study.plan(tmp_path).systems
    assert len(systems) == 256 * 7
    assert all(isinstance(system, cx.System) for system in systems)


def test_fit(studies, tmp_path):
    (study,) = studies("howto/identify.md", FitStudy)
    rows = "\n".join(f"{k},{k % 3}" for k in range(100))
    (tmp_path / "shot7.csv").write_text(f"time (us),SG3\n{rows}\n")
    plan = study.plan(tmp_path)
    assert [one.quantity for one in plan.records] == ["strain"]
    assert [one.name for one in plan.unknowns.all] == ["source.distance", "source.decay_time", "clock of shot7"]


def test_optimisations(studies, tmp_path):
    nominal, robust = (study.problem(tmp_path) for study in studies("optimisation.md", OptimisationStudy))
    assert not nominal.targets.statistics
    assert robust.targets.statistics
    assert len(robust.uncertain.scenarios(robust.space.base)) == 33
