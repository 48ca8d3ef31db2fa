"""Run commands in this process, in an empty folder of their own."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from coaxshell.apps.cli import main


@dataclass
class Outcome:
    """What a command left: exit code, stdout, stderr, and the names of the files in the folder."""

    code: int
    out: str
    err: str
    files: list[str]


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Return a function that runs a command in an empty folder and returns its outcome."""
    monkeypatch.chdir(tmp_path)

    def call(*arguments):
        code = main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return Outcome(code, captured.out, captured.err, sorted(path.name for path in tmp_path.rglob("*")))

    return call


@pytest.fixture
def refused(run):
    """Return a function that runs a command and checks that it is refused on one clear line with nothing left behind."""

    def call(*arguments, left=()):
        outcome = run(*arguments)
        assert outcome.code == 2, outcome
        assert outcome.out == ""
        assert outcome.err.startswith("error: ")
        assert outcome.err.count("\n") == 1
        assert "Traceback" not in outcome.err
        assert outcome.files == sorted(left)
        return outcome.err

    return call


@pytest.fixture
def study(request, tmp_path):
    """Return a function that writes a study file, the STUDY of the module or a variant, and returns its name."""

    def write(text=request.module.STUDY):
        (tmp_path / "study.toml").write_text(text)
        return "study.toml"

    return write


SMALL = ("--modes", "6", "--time-step", "0.02", "--duration", "1")


@pytest.fixture
def small():
    """Options of a run that takes next to no time."""
    return SMALL


@pytest.fixture(scope="session")
def saved(tmp_path_factory):
    """Return the path of a small saved run of the bare system."""
    path = tmp_path_factory.mktemp("saved") / "bare.nc"
    assert main(["run", "bare", *SMALL, "--quiet", "--output", str(path)]) == 0
    return path
