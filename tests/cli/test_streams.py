"""Whatever stdout can write, and whether anybody reads it: a run is never lost, and no name commands a terminal."""

from __future__ import annotations

import io
import os
import subprocess
import sys
from pathlib import Path

import pytest

import coaxshell as cx
from coaxshell.apps.cli import main

COARSE = ("--modes", "4", "--time-step", "0.05", "--duration", "1")


class Terminal(io.TextIOWrapper):
    def isatty(self) -> bool:
        return True


def written(
    monkeypatch: pytest.MonkeyPatch, encoding: str, arguments: tuple[str, ...], kind: type = io.TextIOWrapper
) -> tuple[int, str, str]:
    streams = [kind(io.BytesIO(), encoding=encoding, errors="strict") for _ in range(2)]
    monkeypatch.setattr(sys, "stdout", streams[0])
    monkeypatch.setattr(sys, "stderr", streams[1])
    code = main(arguments)
    for stream in streams:
        stream.flush()
    monkeypatch.undo()
    out, err = (stream.buffer.getvalue().decode(encoding) for stream in streams)
    return code, out, err


@pytest.mark.slow_except("ascii", "gbk", "latin-1")
@pytest.mark.parametrize("encoding", ["cp932", "gbk", "cp949", "cp950", "cp874", "cp852", "cp866", "ascii", "latin-1", "cp037"])
def test_any_encoding_of_the_output(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, encoding: str) -> None:
    system = cx.presets.load("hybrid").replace(name="中文 ñ Ω ☂")
    path = system.to_toml(tmp_path / "named.toml")
    for kind in (io.TextIOWrapper, Terminal):
        code, out, err = written(monkeypatch, encoding, ("run", str(path), *COARSE), kind)
        assert code == 0, err
        assert "stress at head" in out
        assert "warning: " in err
    assert "?" in written(monkeypatch, encoding, ("run", str(path), *COARSE, "-q"))[1]


def test_units_stay_legible(monkeypatch: pytest.MonkeyPatch) -> None:
    _, out, _ = written(monkeypatch, "ascii", ("run", "hybrid", *COARSE, "-q"))
    assert " um " in out or " us)" in out
    assert "?" not in out


@pytest.mark.slow_for("TextIOWrapper")
@pytest.mark.parametrize("kind", [io.TextIOWrapper, Terminal])
def test_names_do_not_command_the_terminal(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, kind: type) -> None:
    name = "\x1b]0;owned\x07\x1b[2J\u202ereversed\x9b31m"
    path = cx.presets.load("bare").replace(name=name).to_toml(tmp_path / "named.toml")
    for arguments in (("run", str(path), *COARSE, "-q"), ("run", str(path), "--compare", "hybrid", *COARSE, "-q")):
        code, out, err = written(monkeypatch, "utf-8", arguments, kind)
        assert code == 0, err
        assert "reversed" in out
        for command in ("\x1b]", "\x1b[2J", "\x07", "\x9b", "\u202e"):
            assert command not in out + err
    for arguments in (("run", f"{name}.toml"), ("run", "bare", "-s", f"{name}=1"), (name,), ("run", "bare", "-o", f"{name}.png")):
        code, out, err = written(monkeypatch, "utf-8", arguments, kind)
        assert code == 2
        assert "\x1b" not in out + err


def test_a_closed_stdout_and_a_reader_that_has_gone(tmp_path: Path) -> None:
    command = f"{sys.executable} -m coaxshell"
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    script = f"""
{command} run bare {" ".join(COARSE)} -q -o kept.nc >&- 2>err; echo $? >code
{command} presets | true; echo ${{PIPESTATUS[0]}} >piped
{command} presets >/dev/full 2>full; echo $? >>full
"""
    outcome = subprocess.run(
        ["bash", "-c", script], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=120, check=False
    )
    assert outcome.stderr == ""
    assert (tmp_path / "code").read_text() == "0\n"
    assert cx.load_response(tmp_path / "kept.nc").modes == 4
    assert (tmp_path / "piped").read_text() in ("141\n", "0\n")  # 0 if all was written before the reader left
    *told, code = (tmp_path / "full").read_text().splitlines()
    assert (told, code) == (["error: cannot print: no space left on device"], "1")


def test_errors_of_a_pipe_are_quiet(monkeypatch: pytest.MonkeyPatch) -> None:
    class Gone(io.StringIO):
        def write(self, text: str) -> int:
            raise BrokenPipeError(32, "Broken pipe")

    monkeypatch.setattr(sys, "stdout", Gone())
    assert main(["presets"]) == 141
