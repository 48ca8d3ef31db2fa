"""Type checkers that know nothing of pydantic accept the idioms of the examples and of the README: texts with units, lists, names."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from coaxshell.model.base import Described

PROJECT = Path(__file__).parents[2]
CHECKERS = ["mypy", *[name for name in ("basedpyright", "pyright") if shutil.which(name)]]
"""pyright comes with its own node (200 MB): it is asked where somebody has it, mypy always."""


def sources(folder: Path) -> list[Path]:
    """Return copies of all examples and of the README's Python in a folder of somebody else."""
    found = [Path(shutil.copy(path, folder / f"example_{path.name}")) for path in sorted((PROJECT / "examples").glob("*.py"))]
    blocks = re.findall(r"```python\n(.*?)```", (PROJECT / "README.md").read_text(encoding="utf-8"), flags=re.DOTALL)
    for number, block in enumerate(blocks):
        found.append(folder / f"readme_{number}.py")
        found[-1].write_text(block, encoding="utf-8")
    return found


def test_descriptions_promise_type_checkers_no_narrower_types_than_they_take() -> None:
    # pydantic's metaclass would make them dataclasses whose radius is a float and nothing else.
    assert "__dataclass_transform__" not in vars(type(Described))
    assert "__dataclass_transform__" in vars(type(Described).__mro__[1])


SHARED = """
import coaxshell as cx
cx.simulate("bare", duration="3 ms", modes="auto", settings=cx.Settings(time_step=2e-3))
cx.sweep("bare", {"source.peak_pressure": [1e4]}, modes=60, workers=1, store="kept", execution=cx.Execution(resume=True))
cx.simulate("bare", mods=60)
cx.sweep("bare", {"source.peak_pressure": [1e4]}, workers="two")
"""


@pytest.mark.slow
@pytest.mark.parametrize("checker", CHECKERS)
def test_shared_keywords_are_known_with_their_types(checker: str, tmp_path: Path) -> None:
    path = tmp_path / "shared.py"
    path.write_text(SHARED, encoding="utf-8")
    found = checked(checker, tmp_path, [str(path)])
    assert [int(line) for line in re.findall(r"shared\.py:(\d+):.*error", found.stdout)] == [5, 6], found.stdout[-3000:]


@pytest.mark.slow
@pytest.mark.parametrize("checker", CHECKERS)
def test_examples_and_readme(checker: str, tmp_path: Path) -> None:
    found = checked(checker, tmp_path, [str(path) for path in sources(tmp_path)])
    assert found.returncode == 0, found.stdout[-3000:] + found.stderr[-1000:]


def checked(checker: str, tmp_path: Path, files: list[str]) -> subprocess.CompletedProcess[str]:
    """Return what a type checker says of some files of somebody else."""
    if checker == "mypy":
        (tmp_path / "mypy.ini").write_text("[mypy]\n", encoding="utf-8")
        options = [
            "--config-file",
            "mypy.ini",
            "--follow-imports=silent",
            "--ignore-missing-imports",
            "--cache-dir",
            str(tmp_path / "cache"),
        ]
        command = [sys.executable, "-m", "mypy", *options, *files]
    else:
        settings = {"typeCheckingMode": "standard", "extraPaths": [str(PROJECT / "src")], "reportMissingModuleSource": False}
        (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings), encoding="utf-8")
        command = [checker, "--pythonpath", sys.executable, "--level", "error", *files]
    environment = {"MYPYPATH": str(PROJECT / "src"), "PATH": str(Path(shutil.which(checker) or sys.executable).parent) + ":/usr/bin:/bin"}
    return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, env=environment)
