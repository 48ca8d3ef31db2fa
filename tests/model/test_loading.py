"""A system by its name or file, and times of a run with units, wherever they are taken."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model.durations import transits
from coaxshell.model.loading import as_system

BARE = cx.presets.load("bare")
TRANSIT = 1.0 / 1400.0
QUICK = {"duration": 0.5, "time_step": 0.02, "modes": 6}


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    return BARE.to_toml(tmp_path / "mine.toml")


def test_what_a_system_may_be(scenario: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(scenario.parent)
    for given in (BARE, "bare", scenario, str(scenario), "mine.toml", Path("mine.toml")):
        assert as_system(given) == BARE


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("bear", ["system", "'bear'", "did you mean 'bare'"]),
        ("missing.toml", ["missing.toml", "cannot be read"]),
        (Path("missing"), ["missing", "cannot be read"]),
        ("run.nc", ["saved run"]),
        ("gauge.csv", ["gauge.csv", "coaxshell record"]),
        (3, ["3 is not a system", "preset"]),
        (None, ["None is not a system"]),
    ],
)
@pytest.mark.parametrize("call", [cx.simulate, cx.prepare, lambda s: cx.sweep(s, over={"source.distance": [3.0]})])
def test_what_it_may_not_be(call, given: object, words: list[str]) -> None:
    with pytest.raises(InputError) as refused:
        call(given)
    assert all(word in str(refused.value) for word in words), refused.value


def test_every_verb_takes_a_preset_and_times_with_units() -> None:
    times = {"duration": f"{0.5 * TRANSIT * 1e6} us", "time_step": f"{0.02 * TRANSIT * 1e3} ms", "modes": 6}
    expected = cx.simulate(BARE, **QUICK)
    for found in (
        cx.simulate("bare", **times),
        cx.prepare("bare", **times).simulate(),
        cx.prepare(BARE, **times).retuned("bare").simulate(),
    ):
        assert found.time.size == expected.time.size
        np.testing.assert_allclose(found.stress("inner"), expected.stress("inner"), rtol=1e-9, atol=1e-3)
    swept = cx.sweep("bare", over={"source.distance": [4.0, 5.0]}, metrics=["inner.peak_stress"], workers=1, **times)
    assert swept["inner.peak_stress"].size == 2


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("5", 5.0),
        ("5 transits", 5.0),
        (" 1 transit", 1.0),
        ("3 ms", 4.2),
        ("714.2857142857143 us", 1.0),
        ("0.003 s", 4.2),
        ("1e-3", 1e-3),
        (2, 2),
    ],
)
def test_times(text: object, expected: float) -> None:
    assert transits(text, BARE) == pytest.approx(expected, rel=1e-12)  # type: ignore[arg-type]


@pytest.mark.parametrize("text", ["3 mm", "3 kPa", "soon", "", "1" * 200, "3 ms ms"])
def test_no_times(text: str) -> None:
    for name in ("duration", "time_step"):
        with pytest.raises(InputError, match=f"^{name}: "):
            cx.simulate(BARE, **{**QUICK, name: text})


@pytest.mark.parametrize("text", ["nan", "inf", "-3 ms", "0 s"])
def test_times_that_no_run_has(text: str) -> None:
    with pytest.raises(InputError, match=r"^duration: .*greater than 0"):
        cx.simulate(BARE, duration=text)
