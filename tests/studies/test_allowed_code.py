"""Study files run Python files beside them only, last of all, and say so."""

from __future__ import annotations

from pathlib import Path

import pytest

from coaxshell.errors import InputError
from coaxshell.studies import OptimisationStudy, SensitivityStudy, SweepStudy, read_study

COMMON = 'scenario = "hybrid"\nresolution = { duration = 1.0, time_step = 0.02, modes = 6 }\n'
RIGHT = {
    SweepStudy: 'over = { "absorbers.mass" = [1, 2] }\nmetrics = ["METRIC"]\n',
    SensitivityStudy: 'metrics = ["METRIC"]\nsamples = 8\nuncertain = { "absorbers.mass" = { from = 1, to = 2 }, '
    '"source.peak_pressure" = { from = 1, to = 2 } }\n',
    OptimisationStudy: 'objectives = ["METRIC"]\nconstraints = ["METRIC <= 3 kPa"]\n'
    'variables = { "absorbers.mass" = { from = 1, to = 2 } }\n',
}
WRONG = {
    SweepStudy: ['over = { "absorbers.mass" = [-1] }', "seed = 1.5", "resolution = { modes = -1 }", 'metrics = ["METRIC", "no.such"]'],
    SensitivityStudy: ["confidence = 3.0", "samples = 7", 'metrics = ["METRIC", "no.such"]'],
    OptimisationStudy: [
        'method = "no"',
        "confirm = { modes = -3 }",
        'constraints = ["METRIC <= 3 kPa", "absorbers.mass <= 1 V"]',
        'start = "system"',
    ],
}


def _parts(study, folder: Path, **options):
    return {SweepStudy: "parts", SensitivityStudy: "plan", OptimisationStudy: "problem"}[type(study)], getattr(
        study, {SweepStudy: "parts", SensitivityStudy: "plan", OptimisationStudy: "problem"}[type(study)]
    )(folder, **options)


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A folder of a study, in which and beside which running a file leaves a mark."""
    folder = tmp_path / "study"
    (folder / "inside").mkdir(parents=True)
    for path in (folder / "mine.py", folder / "inside" / "mine.py", tmp_path / "mine.py"):
        path.write_text(f"import pathlib\npathlib.Path({str(tmp_path / 'mark')!r}).touch()\n\ndef f(r):\n    return 1.0\nf.units = 'Pa'\n")
    return folder


def _written(folder: Path, kind, metric: str, *wrong: str):
    text = COMMON + RIGHT[kind]
    for entry in wrong:
        name = entry.partition(" =")[0]
        text = "\n".join(line for line in text.splitlines() if not line.startswith(f"{name} =")) + "\n" + entry + "\n"
    path = folder / "study.toml"
    path.write_text(text.replace("METRIC", metric))
    return read_study(path, kind)


@pytest.mark.parametrize("kind", RIGHT)
@pytest.mark.parametrize("metric", ["mine.py:f", "inside/mine.py:f", "../study/mine.py:f"])
def test_beside_the_study_it_runs_and_says_so(place: Path, kind, metric: str) -> None:
    told: list[str] = []
    study = _written(place, kind, metric)

    def tell(functions: list[str]) -> None:
        assert not (place.parent / "mark").exists()
        told.extend(functions)

    _parts(study, place, tell=tell)
    assert len(told) == 1
    assert told[0].endswith("mine.py:f")
    assert (place.parent / "mark").exists()


@pytest.mark.parametrize("kind", RIGHT)
@pytest.mark.parametrize("metric", ["../mine.py:f", "ABSOLUTE:f", "link.py:f", "inside/../../mine.py:f"])
def test_elsewhere_it_runs_only_if_allowed(place: Path, kind, metric: str) -> None:
    outside = place.parent / "mine.py"
    (place / "link.py").symlink_to(outside)
    study = _written(place, kind, metric.replace("ABSOLUTE", str(outside)))
    with pytest.raises(InputError, match="lies outside the folder of the study; its code would be run"):
        _parts(study, place)
    assert not (place.parent / "mark").exists()
    _parts(study, place, allow_code=True)
    assert (place.parent / "mark").exists()


@pytest.mark.parametrize(("kind", "entry"), [(kind, entry) for kind, entries in WRONG.items() for entry in entries])
def test_a_refused_study_runs_nothing(place: Path, kind, entry: str) -> None:
    with pytest.raises(InputError):
        _parts(_written(place, kind, "mine.py:f", entry), place)
    assert not (place.parent / "mark").exists()
