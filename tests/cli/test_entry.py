"""Exit codes, help, version, warnings and what happens to errors that nobody expected."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import warnings
from pathlib import Path

import pytest
import typer

import coaxshell
from coaxshell.apps.cli import main
from coaxshell.apps.cli.app import application
from coaxshell.apps.cli.progress import progress

COMMANDS = (
    *(
        "run",
        "presets",
        "init",
        "info",
        "record",
        "spectrum",
        "modes",
        "response",
        "control",
        "figure",
        "snapshots",
        "animate",
        "export",
        "verify",
        "response-function",
    ),
    *("sweep", "optimise", "sensitivity", "reproduce", "studio"),
)


def test_help_lists_every_command(run):
    for arguments in (["--help"], ["-h"], []):
        outcome = run(*arguments)
        assert outcome.code == 0
        assert outcome.err == ""
        assert all(f"\n  {command} " in outcome.out for command in COMMANDS)
        assert "..." not in outcome.out.partition("Commands:")[2]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_help(run, command):
    outcome = run(command, "--help")
    assert outcome.code == 0
    assert "Usage: coaxshell " + command in outcome.out


@pytest.mark.parametrize("command", COMMANDS)
def test_no_help_has_what_a_terminal_takes_for_markup(command):
    known = typer.main.get_command(application()).commands[command]
    for text in (known.help, *(getattr(parameter, "help", None) or "" for parameter in known.params)):
        assert "[" not in text


METAVARS = {
    *("FILE", "FOLDER", "SCENARIO", "SOURCE", "NAME", "UNIT", "ADDRESS", "PATH=VALUE"),
    *("N", "TIME", "ANGLE", "LENGTH", "PRESSURE", "FACTOR", "RATIO", "ERROR", "FREQUENCY", "WAVENUMBER", "VOLTAGE"),
}


@pytest.mark.parametrize("command", [*COMMANDS, "plot"])
def test_values_of_options_are_named_in_one_style(command):
    known = typer.main.get_command(application()).commands[command]
    for option in known.params:
        if option.param_type_name == "option" and not option.is_flag and "--help" not in option.opts:
            parts = (option.metavar or "").removesuffix(",...").split("|")  # a list, or a choice of kinds and words
            assert all(part in METAVARS or (part and len(parts) > 1) for part in parts), (option.opts, option.metavar)


def test_version(run):
    assert run("--version").out == f"coaxshell {coaxshell.__version__}\n"


def test_unknown_command(refused):
    message = refused("solve")
    assert "'solve'" in message
    assert "allowed: run, presets, init, info, record, plot, spectrum, modes, participation, response, control, figure" in message


def test_unknown_option(refused):
    assert "--verbose" in refused("--verbose")


@pytest.mark.parametrize(
    "line",
    [
        *("animate bare --frames many", "animate bare --fps many", "animate bare --size many", "export bare --to paraview --points many"),
        *("snapshots bare --columns many", "snapshots bare --pixels many", "studio --port many"),
    ],
)
def test_what_is_no_number_is_named_with_its_option(refused, line):
    assert f"{line.split()[-2]}: 'many' is not a" in refused(*line.split())


def test_a_shell_that_is_not_there_is_named_with_its_option(refused):
    assert "--shell: 'middle'" in refused("plot", "bare", "--shell", "middle", "--modes", "2", "--time-step", "0.1", "--quiet")


def test_unexpected_errors_are_one_line(run, monkeypatch):
    def broken(*_):
        raise ZeroDivisionError("nothing\nto divide by")

    monkeypatch.setattr("coaxshell.apps.cli.running.load_system", broken)
    outcome = run("run", "bare")
    assert outcome.code == 1
    assert outcome.err == "error: unexpected ZeroDivisionError: nothing to divide by (run again with --debug to see where)\n"
    outcome = run("run", "bare", "--debug")
    assert outcome.code == 1
    assert "Traceback" in outcome.err
    assert outcome.err.endswith("error: unexpected ZeroDivisionError: nothing to divide by\n")


def test_interrupt(run, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("coaxshell.apps.cli.running.load_system", interrupted)
    outcome = run("run", "bare")
    assert outcome.code == 130
    assert outcome.err.startswith("error: interrupted")
    assert outcome.err.count("\n") == 1


def test_physics_warnings_are_one_line_each_and_said_once(capsys, monkeypatch):
    def warn(*_):
        for text in ("too\nfast", "too fast", "too slow"):
            warnings.warn(coaxshell.PhysicsWarning(text), stacklevel=1)
        return coaxshell.presets.load("bare")

    monkeypatch.setattr("coaxshell.apps.cli.running.load_system", warn)
    main(["run", "bare", "--modes", "0"])
    assert capsys.readouterr().err.splitlines()[:-1] == ["warning: too fast", "warning: too slow"]


def test_plain_progress_says_each_tenth_once(capsys):
    with progress() as report:
        for i in range(1001):
            report(i / 1000, "solving")
        report(1.0, "adding up")
    lines = capsys.readouterr().err.splitlines()
    assert lines == [f"solving: {percent} %" for percent in range(10, 101, 10)] + ["adding up: 100 %"]


def test_bar_on_a_terminal(capsys, monkeypatch):
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    with progress() as report:
        report(0.5, "solving")
    captured = capsys.readouterr()
    assert captured.out == ""


def test_module_and_exit_code():
    done = subprocess.run([sys.executable, "-m", "coaxshell", "run", "bear"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: SCENARIO: there is no preset 'bear'")


@pytest.mark.slow_for("2-130")
@pytest.mark.skipif(os.name == "nt", reason="signals")
@pytest.mark.parametrize(("sent", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_ctrl_c_and_termination_leave_nothing_behind(tmp_path, sent, code):
    arguments = [sys.executable, "-m", "coaxshell", "run", "bare", "--modes", "1000", "--output", "out.nc"]
    package = str(Path(coaxshell.__file__).parents[1])
    with subprocess.Popen(
        arguments,
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": package},
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),  # a shell's background job ignores it, and so would its children
    ) as process:
        first = process.stderr.readline()
        process.send_signal(sent)
        rest = process.stderr.read().splitlines()
    assert first.endswith(" %\n")
    assert process.returncode == code
    assert rest[-1].startswith("error: interrupted")
    assert not any("Traceback" in line for line in rest)
    assert list(tmp_path.iterdir()) == []
