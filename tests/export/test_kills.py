"""Killed at any step, a writer leaves its old result or its new one, whole; the next one clears up."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).with_name("kills.py")


def kills(folder: Path, *writers: str) -> int:
    outcome = subprocess.run([sys.executable, str(SCRIPT), str(folder), *writers], capture_output=True, text=True, timeout=900)
    assert outcome.returncode == 0, outcome.stderr[-2000:]
    return int(outcome.stdout.splitlines()[-1])


def test_a_killed_writer_leaves_whole_results(tmp_path: Path) -> None:
    assert kills(tmp_path, "toml") >= 10


@pytest.mark.slow
def test_killed_writers_leave_whole_results(tmp_path: Path) -> None:
    assert kills(tmp_path, "save", "toml", "optimum") >= 40


@pytest.mark.slow
def test_every_writer_killed_at_every_step(tmp_path: Path) -> None:
    assert kills(tmp_path) >= 200
