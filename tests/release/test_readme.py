"""What the README tells a stranger to type is true: its Python runs, its commands run, its links lead somewhere."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from coaxshell.apps.cli import main
from house import PROJECT

TEXT = (PROJECT / "README.md").read_text(encoding="utf-8")
FULL, SMALL = "duration=5.0, time_step=1e-3, modes=150", "duration=2.0, time_step=1e-2, modes=10"
COARSE = ["--duration", "1", "--time-step", "1e-2", "--modes", "8", "--quiet"]
# What makes each command small; a later option of the same name counts.
SMALLER = {
    "presets": [],
    "init": [],
    "run": COARSE,
    "info": [],
    "plot": COARSE,
    "spectrum": COARSE,
    "modes": ["--order", "2"],
    "response": ["--frequency", "100,200", "--modes", "8"],
    "participation": ["--up-to", "600 Hz", "--quiet"],
    "control": ["--modes", "4"],
    "figure": ["--quiet"],
    "snapshots": ["--times", "0.5", "--pixels", "40", "--quiet"],
    "report": [*COARSE, "--without", "energy", "--without", "fields"],
    "animate": ["--frames", "2", "--size", "80", "--quiet"],
    "record": ["--force"],
    "export": ["--points", "11", "--quiet"],
    "response-function": ["--duration", "1", "--time-step", "1e-2", "--modes", "0,1"],
    "verify": ["--quick", "--only", "disc-limit", "--quiet"],
    "verify --template": ["--modes", "8"],
    "verify --against": ["--modes", "8", "--time-step", "1e-2", "--quiet"],
}
# These wait for a browser or take minutes: that they take the options shown is all that is asked here.
SHORT = {"presets", "init", "run", "info", "record", "modes", "export"}
"""What takes a moment, and what others read: carried out always, the others where slow tests are."""

ONLY_PARSED = {"studio", "reproduce", "sweep", "optimise", "sensitivity", "fit"}


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", TEXT, re.DOTALL | re.MULTILINE)


def commands() -> list[list[str]]:
    lines = [line for block in blocks("sh") for line in block.splitlines()] + re.findall(r"`(coaxshell [^`]+)`", TEXT)
    typed = [shlex.split(line, comments=True) for line in lines]
    found = [words[1:] for words in typed if words[:1] == ["coaxshell"] and len(words) > 1]
    # What a command reads must have been written before.
    return sorted(found, key=lambda words: "--against" in words)


def kind(words: list[str]) -> str:
    special = [option for option in ("--template", "--against") if option in words]
    return " ".join([words[0], *special])


@pytest.mark.parametrize("code", blocks("python"))
def test_the_python_runs(code, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert FULL in code
    names: dict[str, object] = {}
    exec(compile(code.replace(FULL, SMALL), "README.md", "exec"), names)
    assert "stress at head" in capsys.readouterr().out
    assert Path("run.nc").exists()


def test_the_python_is_ten_lines():
    code = blocks("python")[0]
    assert len([line for line in code.splitlines() if line.strip()]) <= 10


@pytest.mark.parametrize("whole", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["short ones", "all"])
def test_the_commands_run(tmp_path, monkeypatch, capsys, whole):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "gauge.csv").write_text("time (ms),pressure (kPa)\n0,250\n0.1,120\n1,2\n")
    seen = set()
    for words in commands():
        if words[0] in ONLY_PARSED or not (whole or words[0] in SHORT):
            assert whole or words[0] in ONLY_PARSED or kind(words) in SMALLER
            assert main([words[0], "--help"]) == 0
            told = capsys.readouterr().out
            assert [word for word in words if word.startswith("--") and word not in told] == []
        else:
            seen.add(words[0])
            smaller = SMALLER[kind(words)]
            if words[0] == "export" and "paraview" not in words:
                smaller = ["--quiet"]
            assert main([*words, *smaller]) == 0, (words, capsys.readouterr().err)
    assert seen >= ({"run", "figure", "animate", "export", "verify"} if whole else SHORT & {words[0] for words in commands()})


def test_what_make_is_asked_for_exists():
    targets = set(re.findall(r"^make ([a-z-]+)", TEXT, re.MULTILINE))
    makefile = (PROJECT / "Makefile").read_text(encoding="utf-8")
    assert {"demo", "test", "docs"} <= targets
    assert [target for target in targets if not re.search(rf"^{target}:", makefile, re.MULTILINE)] == []


@pytest.mark.parametrize("page", ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"])
def test_links_lead_somewhere(page):
    text = (PROJECT / page).read_text(encoding="utf-8")
    targets = [target.partition("#")[0] for target in re.findall(r"\]\(([^)]+)\)", text) if not target.startswith("http")]
    assert [target for target in targets if not (PROJECT / target).exists()] == []


def test_the_picture_is_small():
    pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", TEXT)
    assert pictures
    assert all((PROJECT / picture).stat().st_size < 200_000 for picture in pictures)
