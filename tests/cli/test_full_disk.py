"""A full disk: every writer ends with one line that names its option; the old result is kept and nothing else is left."""

from __future__ import annotations

import resource
import sys
from contextlib import contextmanager

import pytest

from coaxshell.numerics import files

COARSE = ("--modes", "4", "--time-step", "0.05", "--duration", "1", "--quiet")
WRITERS = {
    "saved run": ("x.nc", "--output", ("run", "bare", *COARSE, "--output")),
    "png": ("x.png", "--figure", ("run", "bare", *COARSE, "--figure")),
    "pdf": ("x.pdf", "--figure", ("run", "bare", *COARSE, "--figure")),
    "svg": ("x.svg", "--energy", ("run", "bare", *COARSE, "--energy")),
    "csv": ("x.csv", "--output", ("export", "bare", *COARSE, "--to", "csv", "--output")),
    "mat": ("x.mat", "--output", ("export", "bare", *COARSE, "--to", "mat", "--output")),
    "plot": ("x.png", "--output", ("plot", "bare", *COARSE, "--output")),
    "scenario": ("x.toml", "FILE", ("init",)),
    "film": ("x.webp", "--output", ("animate", "bare", *COARSE, "--frames", "2", "--size", "64", "--output")),
    "mp4": ("x.mp4", "--output", ("animate", "bare", *COARSE, "--frames", "2", "--size", "64", "--output")),
}


@pytest.fixture
def full(monkeypatch):
    """Let no file grow beyond 64 bytes from when a writer begins until it ends, so that no other file is cut short."""
    scratch, before = files.scratch, resource.getrlimit(resource.RLIMIT_FSIZE)

    @contextmanager
    def limited(*arguments, **options):
        with scratch(*arguments, **options) as place:
            resource.setrlimit(resource.RLIMIT_FSIZE, (64, before[1]))  # Python ignores the signal, so that writing fails
            try:
                yield place
            finally:
                resource.setrlimit(resource.RLIMIT_FSIZE, before)

    monkeypatch.setattr(files, "scratch", limited)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)


@pytest.mark.slow_for("pdf", "svg", "film")
@pytest.mark.parametrize("writer", WRITERS)
def test_the_old_result_is_kept_and_nothing_is_left(writer, run, full, tmp_path, monkeypatch):
    name, option, arguments = WRITERS[writer]
    folder = tmp_path / "here"
    folder.mkdir()
    monkeypatch.chdir(folder)
    (folder / name).write_text("old")
    outcome = run(*arguments, name, "--force")
    assert outcome.code == 2
    assert outcome.err.startswith(f"error: {option}: cannot write '{name}': ")
    assert outcome.err.count("\n") == 1
    assert (folder / name).read_text() == "old"
    assert [path.name for path in folder.iterdir()] == [name]
