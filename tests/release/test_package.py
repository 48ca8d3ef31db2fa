"""The wheel holds what a user needs, and works in an environment that has never seen the checkout."""

from __future__ import annotations

import os
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

from house import PACKAGE, PROJECT

WORK = """
import sys
from importlib.resources import files
import coaxshell as cx

assert "site-packages" in cx.__file__, cx.__file__
assert (files("coaxshell") / "py.typed").is_file()
for name in cx.presets.names():
    cx.presets.load(name)
response = cx.simulate(cx.presets.load("hybrid"), duration=1.0, time_step=1e-2, modes=8)
response.save("run.nc")
assert cx.load_response("run.nc").system == response.system
from coaxshell.apps.verification import bench
assert bench.tables()
"""


def data_files() -> set[str]:
    """Return everything in the package that is not Python, as paths from its parent."""
    found = (path for path in PACKAGE.rglob("*") if path.is_file() and path.suffix not in (".py", ".pyc"))
    return {path.relative_to(PACKAGE.parent).as_posix() for path in found}


def test_the_package_is_typed_and_its_data_lies_inside():
    names = data_files()
    assert "coaxshell/py.typed" in names
    assert any(name.startswith("coaxshell/model/presets/") for name in names)
    assert any(name.startswith("coaxshell/apps/verification/data/") for name in names)


def test_every_extra_is_documented():
    project = tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    page = (PROJECT / "docs" / "installation.md").read_text(encoding="utf-8")
    assert [extra for extra in project["optional-dependencies"] if f"| `{extra}` |" not in page] == []


@pytest.mark.slow
def test_wheel_and_sdist_install_and_work_elsewhere(tmp_path):
    plain = {key: value for key, value in os.environ.items() if key not in ("PYTHONPATH", "VIRTUAL_ENV")}

    def run(*words: str | Path) -> str:
        done = subprocess.run([str(word) for word in words], cwd=tmp_path, env=plain, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    run(sys.executable, "-m", "build", "--outdir", tmp_path, PROJECT)  # the wheel is made from the sdist
    (sdist,) = tmp_path.glob("*.tar.gz")
    (wheel,) = tmp_path.glob("*.whl")
    inside = set(zipfile.ZipFile(wheel).namelist())
    assert sorted(data_files() - inside) == []
    assert wheel.stat().st_size < 5_000_000
    with tarfile.open(sdist) as archive:
        members = {name.partition("/")[2] for name in archive.getnames()}
    wanted = {
        "README.md",
        "LICENSE",
        "CHANGELOG.md",
        "CONTRIBUTING.md",
        "CITATION.cff",
        "docs/theory.md",
        "examples/01_own_double_shell.py",
    }
    assert sorted(wanted - members) == []

    run(sys.executable, "-m", "venv", "clean")
    python = tmp_path / "clean" / "bin" / "python"
    run(python, "-m", "pip", "install", "-q", "--disable-pip-version-check", wheel)
    (tmp_path / "work.py").write_text(WORK, encoding="utf-8")
    run(python, "-I", "work.py")
    command = tmp_path / "clean" / "bin" / "coaxshell"
    assert "hybrid" in run(command, "presets")
    told = run(command, "run", "bare", "--duration", "1", "--time-step", "1e-2", "--modes", "8", "--quiet", "--figure", "stress.png")
    assert "stress at head" in told
    assert "0 fail" in run(command, "verify", "--quick", "--only", "disc-limit", "--quiet")
