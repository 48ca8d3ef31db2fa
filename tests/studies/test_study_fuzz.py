"""Mutated study files: read or refused on one line, never a traceback."""

from __future__ import annotations

import random
import warnings
from pathlib import Path

import pytest

from coaxshell.errors import InputError
from coaxshell.studies import OptimisationStudy, SensitivityStudy, SweepStudy, read_study

COMMON = 'scenario = "hybrid"\nresolution = { duration = 1.0, time_step = 0.02, modes = 6 }\nset = { "absorbers.count" = 4 }\n'
STUDIES = {
    SweepStudy: (
        "parts",
        'over = { "absorbers.mass" = [1, "2 kg"], "source.peak_pressure" = { from = "1 kPa", to = "9 kPa", count = 3, scale = "log" } }\n'
        'metrics = ["inner.peak_stress", "shells[1].mass", "interior.rms_pressure"]\npoints = "grid"\nseed = 1\n',
    ),
    SensitivityStudy: (
        "plan",
        'uncertain = { "absorbers.mass" = { from = 1, to = 2 }, "source.peak_pressure" = { from = "1 kPa", to = "2 kPa" } }\n'
        'metrics = { one = "inner.peak_stress" }\nsamples = 8\nconfidence = 0.9\nindices = true\n',
    ),
    OptimisationStudy: (
        "problem",
        'variables = { "absorbers.mass" = { from = 1, to = 2 }, "absorbers.count" = { values = [2, 4] } }\n'
        'objectives = ["inner.peak_stress", { metric = "absorbers.mass", maximise = true }]\n'
        'constraints = ["absorbers.mass <= 250 kg/m", "outer.peak_stress >= 1 Pa"]\nmethod = "auto"\nevaluations = 20\n',
    ),
}
ATOMS = (
    '"1e9999999999 kg"',
    "1e999",
    "-1e999",
    "nan",
    "inf",
    "-0.0",
    "0",
    "-1",
    "1" + "0" * 400,
    '""',
    '"\\u0000"',
    "true",
    "[]",
    "{}",
    "[[[]]]",
    "1979-05-27",
    "07:32:00",
    '"' + "9" * 300 + '"',
    '"1x' + " " * 300 + 'y"',
    '"../../etc/passwd"',
    '"/dev/zero:f"',
    '"x.py:f"',
    '"mean("',
    '"a <= b <= c"',
    '"absorbers.mass <= 1e9999999999 kg/m"',
    '"absorbers[*].mass"',
    '"shells[99999999999999999999].mass"',
    '"inner.\\u202e"',
    "{ from = 1, to = 1e400 }",
    '{ from = "1 kg", to = "1e9999999999 kg", count = 3 }',
    "{ from = 0, to = 1, count = 1000000000000 }",
    "{ from = 0, to = 1, step = 1e-300 }",
    "{ values = [] }",
    "[1, [2, 3]]",
    "0x7fffffffffffffffffff",
    '"١٢"',
    "1_000",
)


def mutated(text: str, draw: random.Random) -> str:
    """Return a study file with one to three changes: values exchanged, lines doubled or lost, letters exchanged."""
    for _ in range(draw.randint(1, 3)):
        kind = draw.choice((0, 0, 0, 0, 1, 1, 1, 1, 1, 2, 3, 4, 5))
        lines = text.splitlines()
        at = draw.randrange(len(lines))
        if kind == 0:
            name = lines[at].partition("=")[0]
            lines[at] = f"{name}= {draw.choice(ATOMS)}"
        elif kind == 1:
            pieces = [piece for piece in (*(f'"{p}"' for p in lines[at].split('"')[1::2]), "1", "2", "0.02") if piece in lines[at]]
            lines[at] = lines[at].replace(draw.choice(pieces), draw.choice(ATOMS), 1) if pieces else lines[at]
        elif kind == 2:
            lines.insert(at, lines[draw.randrange(len(lines))])
        elif kind == 3:
            del lines[at]
        elif kind == 4 and lines[at]:
            place = draw.randrange(len(lines[at]))
            lines[at] = lines[at][:place] + draw.choice('[]{}"=,.\x00é\u2028 9') + lines[at][place + 1 :]
        else:
            lines.append(f"{draw.choice(['over', 'metrics', 'seed', 'samples', 'method', 'x.y.z', 'confirm'])} = {draw.choice(ATOMS)}")
        text = "\n".join(lines or ["seed = 1"])
    return text


def tried(kind, text: str, folder: Path) -> None:
    path = folder / "study.toml"
    path.write_text(text, encoding="utf-8", errors="surrogatepass")
    method, _ = STUDIES[kind]
    told = ""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            getattr(read_study(path, kind), method)(folder)
    except InputError as error:
        told = str(error)
    assert "\n" not in told
    assert len(told) < 5000


def _many(kind, count: int, seed: int, folder: Path) -> None:
    draw = random.Random(seed)
    for number in range(count):
        text = mutated(COMMON + STUDIES[kind][1], draw)
        try:
            tried(kind, text, folder)
        except Exception as error:
            raise AssertionError(f"number {number}: {type(error).__name__}: {error}\n{text}") from error


HUGE = (
    "{ from = 0.1, to = 1, count = 1000000000000 }", "{ from = 0.1, to = 1, step = 1e-300 }", "{ from = 0.1, to = 1, step = 1e-9 }",
    '{ from = "1e9999999999 kg", to = 2, count = 3 }', '["1e9999999999 kg"]', "[1" + "0" * 400 + "]",
)  # fmt: skip


@pytest.mark.parametrize("values", HUGE)
def test_spans_without_end(values: str, tmp_path: Path) -> None:
    text = COMMON + f'metrics = ["inner.mass"]\nover = {{ "absorbers.mass" = {values} }}\n'
    (tmp_path / "study.toml").write_text(text)
    with pytest.raises(InputError, match=r"over\.absorbers\.mass"):
        read_study(tmp_path / "study.toml", SweepStudy).parts(tmp_path)


@pytest.mark.parametrize("entry", ["samples = 1" + "0" * 30, "samples = 8\nseed = 1" + "0" * 400])
def test_samples_and_seeds_without_end(entry: str, tmp_path: Path) -> None:
    text = COMMON + f'metrics = ["inner.mass"]\npoints = "sobol"\nover = {{ "absorbers.mass" = [1, 2] }}\n{entry}\n'
    (tmp_path / "study.toml").write_text(text)
    with pytest.raises(InputError, match=r"^(samples|seed): "):
        read_study(tmp_path / "study.toml", SweepStudy).parts(tmp_path)


@pytest.mark.parametrize("kind", STUDIES)
def test_the_study_itself_is_right(kind, tmp_path: Path) -> None:
    path = tmp_path / "study.toml"
    path.write_text(COMMON + STUDIES[kind][1])
    assert getattr(read_study(path, kind), STUDIES[kind][0])(tmp_path)


@pytest.mark.parametrize("kind", STUDIES)
def test_some_mutations(kind, tmp_path: Path) -> None:
    _many(kind, 25, 1, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("kind", STUDIES)
def test_many_mutations(kind, tmp_path: Path) -> None:
    _many(kind, 250, 2, tmp_path)
