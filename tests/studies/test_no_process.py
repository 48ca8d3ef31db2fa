"""Processes that cannot be started: the true cause in one line, not failed cases."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.studies.executors import completed

SWEEP = """
import coaxshell as cx
found = cx.sweep(
    cx.presets.load("bare"), {"source.peak_pressure": [1e5, 2e5, 3e5]}, workers=2, duration=1.0, time_step=0.02, modes=6
)
print("failed:", int((found["failure"] != "").sum()))
"""
GUARDED = "import coaxshell as cx\nif __name__ == '__main__':\n    " + SWEEP.strip().replace("\n", "\n    ") + "\n"


def test_a_program_without_a_file(monkeypatch: pytest.MonkeyPatch) -> None:
    main = sys.modules["__main__"]
    monkeypatch.setattr(main, "__file__", "<stdin>", raising=False)
    monkeypatch.setattr(main, "__spec__", None, raising=False)
    with pytest.raises(
        InputError, match=r"workers: processes cannot be started from a program without a file \(<stdin>\); save it as a file"
    ):
        list(completed([1, 2], abs, workers=2))
    assert list(completed([-1], abs, workers=1)) == [(-1, 1)]


def mine(response: cx.Response) -> float:
    return float(abs(response.stress("inner")).max())


def test_functions_of_a_notebook(monkeypatch: pytest.MonkeyPatch) -> None:
    main = sys.modules["__main__"]
    monkeypatch.delattr(main, "__file__", raising=False)
    monkeypatch.setattr(main, "__spec__", None, raising=False)
    monkeypatch.setattr(main, "mine", mine, raising=False)
    monkeypatch.setattr(mine, "__module__", "__main__")

    def study(workers: int | None) -> float:
        over = {"source.peak_pressure": [1e3, 2e3, 3e3]}
        found = cx.sweep("bare", over, metrics={"m": mine}, workers=workers, duration=1.0, time_step=0.02, modes=6)
        return float(found["m"].sum())

    with pytest.raises(InputError, match=r"metrics.m: this function stands in a notebook .* write it to a \.py file .* or use workers=1"):
        study(2)
    assert study(1) == study(None) > 0.0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "how", "told"),
    [
        (GUARDED, "stdin", "error: workers: processes cannot be started from a program without a file"),
        (
            SWEEP,
            "file",
            "workers: no process could be started: each runs the main program first, and that failed or began this study again",
        ),
        (GUARDED, "file", ""),
        (SWEEP, "-c", ""),
    ],
)
def test_programs(text: str, how: str, told: str, tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text(text)
    command = {"stdin": [sys.executable, "-"], "file": [sys.executable, str(script)], "-c": [sys.executable, "-c", text]}[how]
    done = subprocess.run(command, input=text if how == "stdin" else "", capture_output=True, text=True, timeout=120, cwd=tmp_path)
    if told:
        assert done.returncode != 0
        assert told.removeprefix("error: ") in done.stderr
        assert "out of memory" not in done.stderr
    else:
        assert "failed: 0" in done.stdout, done.stderr
