"""Break the package in one central place at a time and print which test notices: `make mutation`, or this file with names of mutations.

Works on a copy in a temporary folder, with one process. The nearest tests are asked first, then all but the slow ones. Exit code 1
if a mutation survives.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from mutations import MUTATIONS, Mutation

PROJECT = Path(__file__).parents[2]
COPIED = (
    *("src", "tests", "docs", "examples", ".ci", "pyproject.toml", "Makefile"),
    *("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "CITATION.cff", "LICENSE"),
)
LONGEST = 1800.0
"""Seconds after which a run of tests counts as never ending, which is noticed too."""

_FAILED = re.compile(r"^(?:FAILED|ERROR) (\S+)", re.MULTILINE)


def copy_of(project: Path, folder: Path) -> Path:
    """Copy what the tests need and return the folder."""
    skipped = shutil.ignore_patterns("__pycache__", ".*cache", "built", "generated", "mutation")
    for name in COPIED:
        source = project / name
        if source.is_dir():
            shutil.copytree(source, folder / name, ignore=skipped)
        elif source.exists():
            shutil.copy2(source, folder / name)
    return folder


def failing(folder: Path, tests: list[str]) -> str | None:
    """Return the first test that fails in a copy, None if all pass.

    Raises
    ------
    RuntimeError
        If pytest itself could not run: nothing is learnt from that.
    """
    environment = {**os.environ, "PYTHONPATH": str(folder / "src"), "PYTHONDONTWRITEBYTECODE": "1", "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-m", "not slow", "-p", "no:cacheprovider", "--tb=no", *tests]
    try:
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return f"the tests did not end within {LONGEST:g} s"
    if done.returncode == 0:
        return None
    found = _FAILED.search(done.stdout)
    if found is None:
        raise RuntimeError(f"pytest ended with {done.returncode}:\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    return found[1]


def caught_by(mutation: Mutation, folder: Path, *, only_nearest: bool) -> str | None:
    """Return the first test that notices a mutation, None if it survives; the copy is as before afterwards."""
    path = folder / "src" / "coaxshell" / mutation.file
    whole = path.read_text(encoding="utf-8")
    assert whole.count(mutation.original) == 1, mutation.name
    path.write_text(whole.replace(mutation.original, mutation.mutated), encoding="utf-8")
    try:
        found = failing(folder, [f"tests/{name}" for name in mutation.nearest.split()])
        return found if found or only_nearest else failing(folder, ["tests"])
    finally:
        path.write_text(whole, encoding="utf-8")


def main(names: list[str], *, check_first: bool = True, only_nearest: bool = False) -> int:
    """Try the named mutations, all if none is named; return the exit code."""
    unknown = set(names) - {mutation.name for mutation in MUTATIONS}
    if unknown:
        sys.stderr.write(f"error: no mutation {', '.join(sorted(unknown))}\n")
        return 2
    chosen = [mutation for mutation in MUTATIONS if not names or mutation.name in names]
    survivors = []
    with tempfile.TemporaryDirectory(prefix="coaxshell-mutation-") as temporary:
        folder = copy_of(PROJECT, Path(temporary))
        nearest = sorted({f"tests/{name}" for mutation in chosen for name in mutation.nearest.split()})
        broken = failing(folder, nearest) if check_first else None
        if broken is not None:
            sys.stderr.write(f"error: {broken} fails without any mutation: repair it first\n")
            return 2
        for mutation in chosen:
            start = time.perf_counter()
            test = caught_by(mutation, folder, only_nearest=only_nearest)
            survivors += [] if test else [mutation.name]
            print(f"{mutation.name:22} {test or 'SURVIVES':80} {time.perf_counter() - start:5.0f} s  ({mutation.breaks})", flush=True)  # noqa: T201
    print(f"{len(chosen)} mutations, {len(survivors)} survive{': ' if survivors else ''}{', '.join(survivors)}")  # noqa: T201
    return 1 if survivors else 0


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        prog="make mutation", description="Break the package in one place at a time; print which test notices."
    )
    parser.add_argument("names", nargs="*", help="mutations to try; all if left out")
    parser.add_argument("--trust-tests", action="store_true", help="do not run the nearest tests on the unbroken package first")
    parser.add_argument("--only-nearest", action="store_true", help="do not ask all tests about what the nearest miss")
    asked = parser.parse_args()
    raise SystemExit(main(asked.names, check_first=not asked.trust_tests, only_nearest=asked.only_nearest))
