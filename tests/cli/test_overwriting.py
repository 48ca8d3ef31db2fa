"""One rule for every command: what exists is not overwritten without --force, and two results never share a name."""

from __future__ import annotations

import pytest
from typer.main import get_command

from coaxshell.apps.cli.app import application

COARSE = ("--modes", "4", "--time-step", "0.05", "--duration", "1", "--quiet")
WRITING = {"--output", "--figure", "--energy", "--csv", "--template"}
GOING_ON = {"reproduce"}
"""Takes up what it finds in its folder, and says so."""


def test_every_command_that_writes_can_be_forced():
    commands = get_command(application()).commands
    writing = {name for name, command in commands.items() if WRITING & {option for one in command.params for option in one.opts}}
    assert len(writing) >= 10
    forced = {name for name, command in commands.items() if "--force" in {option for one in command.params for option in one.opts}}
    assert writing - GOING_ON <= forced


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        (("run", "bare", "--output", "mine.nc"), "mine.nc"),
        (("run", "bare", "--figure", "mine.svg"), "mine.svg"),
        (("export", "bare", "--to", "csv", "--output", "mine.csv"), "mine.csv"),
        (("export", "bare", "--to", "mat"), "bare.mat"),
        (("figure", "3", "-o", "mine.png"), "mine.png"),
        (("snapshots", "bare", "-o", "mine.png"), "mine.png"),
        (("animate", "bare", "-o", "mine.webp"), "mine.webp"),
        (("init", "mine.toml"), "mine.toml"),
        (("response-function", "gap", "-o", "mine.csv"), "mine.csv"),
        (("verify", "--template", "mine.csv", "--case", "bare"), "mine.csv"),
    ],
    ids=lambda value: " ".join(value[:2]) if isinstance(value, tuple) else value,
)
def test_what_exists_is_refused(refused, tmp_path, arguments, name):
    (tmp_path / name).write_text("precious")
    assert f"'{name}' exists already; give another name, or --force to overwrite it" in refused(*arguments, left=[name])
    assert (tmp_path / name).read_text() == "precious"


@pytest.mark.parametrize("energy", ["both.png", "./both.png", "link.png"])
def test_two_results_of_one_name_are_refused(refused, tmp_path, energy):
    (tmp_path / "link.png").symlink_to("both.png")
    arguments = ("run", "bare", *COARSE, "--figure", "both.png", "--energy", energy)
    assert f"--energy: '{energy.removeprefix('./')}' is what --figure writes already" in refused(*arguments, left=["link.png"])


def test_force_overwrites(run, tmp_path):
    (tmp_path / "mine.csv").write_text("old")
    outcome = run("export", "bare", "--to", "csv", "--output", "mine.csv", "--force", *COARSE)
    assert outcome.code == 0, outcome.err
    assert (tmp_path / "mine.csv").read_text().startswith("time (a/c),time (s)")
