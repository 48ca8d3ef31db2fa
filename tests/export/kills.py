"""Kill writers at every step that matters, one after another, and look at what they leave. Run as a script: FOLDER [WRITER ...]."""

from __future__ import annotations

import os
import shutil
import signal
import sys
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import xarray as xr

import coaxshell as cx
from coaxshell.apps.cli import main
from coaxshell.apps.verification.files import write_report
from coaxshell.apps.verification.suite import Report
from coaxshell.errors import InputError
from coaxshell.export import export_csv, export_mat, export_paraview
from coaxshell.numerics import scratch
from coaxshell.numerics.netcdf import write_netcdf
from coaxshell.plotting import FieldView, save_figure
from coaxshell.plotting.film import save_film
from coaxshell.plotting.style import new_figure
from coaxshell.studies import Optimum
from coaxshell.studies.store import Store as Pieces

Write = Callable[[Path, int], object]


class Found(Optimum):
    """A result of an optimisation without one."""

    def __init__(self, number: int) -> None:
        object.__setattr__(self, "number", number)

    def _write(self, folder: Path) -> None:
        for name in ("best.toml", "optimum.json", "history.csv"):
            (folder / name).write_text(str(self.number) * 1000)


def runs() -> list[cx.Response]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return [cx.simulate(cx.presets.load("bare"), modes=modes, time_step=0.1, duration=1.0) for modes in (3, 4)]


def writers() -> dict[str, tuple[str, Write]]:
    responses = runs()
    datasets = [xr.Dataset({"a": ("x", np.full(100, float(number)))}) for number in range(2)]

    def figure(path: Path, number: int) -> None:
        drawn = new_figure(1.0, 1.0)
        drawn.text(0.5, 0.5, str(number))
        save_figure(drawn, path)

    def film(path: Path, number: int) -> None:
        save_film(responses[number], path=path, frames=2, view=FieldView(3.0, 64))

    def paraview(path: Path, number: int) -> None:
        export_paraview(responses[number], path, times=[0.5], points=3, force=True)

    return {
        "save": ("run.nc", lambda path, number: responses[number].save(path)),
        "paraview": ("folder", paraview),
        "toml": ("system.toml", lambda path, number: responses[number].system.replace(name=str(number)).to_toml(path)),
        "csv": ("run.csv", lambda path, number: export_csv(responses[number], path)),
        "mat": ("run.mat", lambda path, number: export_mat(responses[number], path)),
        "figure": ("figure.png", figure),
        "film": ("film.webp", film),
        "init": ("init.toml", lambda path, number: main(["init", str(path), "--force", "--preset", ("bare", "hybrid")[number]])),
        "optimum": ("optimum", lambda path, number: Found(number).save(path)),
        "dataset": ("sweep.nc", lambda path, number: write_netcdf(datasets[number], path)),
        "report": ("report", lambda path, number: write_report(Report(str(number), (), str(number)), path)),
        "pieces": ("pieces", lambda path, number: Pieces(path).put("one", {"a": np.full(10, number)}, {})),
    }


def state(path: Path) -> dict[str, bytes]:
    """Return the content of a file or of all files of a folder."""
    if not path.is_dir():
        skipped = 128 if path.suffix == ".mat" else 0  # a MATLAB file's first lines tell the time
        return {"": path.read_bytes()[skipped:]} if path.exists() else {}
    files = [file for file in sorted(path.rglob("*")) if file.is_file() and ".coaxshell." not in str(file)]
    return {str(file.relative_to(path)): file.read_bytes() for file in files}


def whole(name: str, path: Path, known: list[dict[str, bytes]]) -> bool:
    """Return whether a result is the old or the new one, whole."""
    found = state(path)
    if name == "save":  # the time of writing stands in it: its seal tells
        try:
            cx.load_response(path)
        except InputError:
            return False
        return True
    if name == "report":  # two files, each by itself
        return all(content in [one.get(file) for one in known] for file, content in found.items())
    return found in known


def killed(write: Write, path: Path, at: int, after: bool) -> bool:
    """Let a child write, and kill it at its *at*-th step; False if it had fewer."""
    child = os.fork()
    if child == 0:
        count = 0

        def step(call: Callable[..., object]) -> Callable[..., object]:
            def counted(*arguments: object, **options: object) -> object:
                nonlocal count
                count += 1
                if count == at and not after:
                    os.kill(os.getpid(), signal.SIGKILL)
                outcome = call(*arguments, **options)
                if count == at:
                    os.kill(os.getpid(), signal.SIGKILL)
                return outcome

            return counted

        for name in ("replace", "rename", "fsync", "link"):
            setattr(os, name, step(getattr(os, name)))
        scratch.exchange = step(scratch.exchange)  # type: ignore[assignment]
        shutil.rmtree = step(shutil.rmtree)  # type: ignore[assignment]
        try:
            write(path, 1)
        finally:
            os._exit(0)
    _, status = os.waitpid(child, 0)
    return os.WIFSIGNALED(status)


def check(name: str, target: str, write: Write, folder: Path) -> int:
    """Kill one writer at each of its steps, with and without an old result; return how many kills there were."""
    kills = 0
    known = []
    for number in (0, 1):
        place = folder / f"known{number}"
        place.mkdir()
        write(place / target, number)
        known.append(state(place / target))
    for old in (True, False):
        for after in (False, True):
            at = 0
            while True:
                at += 1
                place = folder / f"{name}-{old}-{after}-{at}"
                place.mkdir()
                if old:
                    write(place / target, 0)
                if not killed(write, place / target, at, after):
                    break
                kills += 1
                left = place / target
                assert (not old and not state(left)) or whole(name, left, known), f"{name}: killed at step {at}, after {after}: {left}"
                write(left, 0)
                hidden = list(place.rglob(".coaxshell*"))
                assert not hidden, f"{name}: {hidden} is left"
                shutil.rmtree(place)
    return kills


if __name__ == "__main__":
    start, chosen = Path(sys.argv[1]), sys.argv[2:]
    every = writers()
    total = 0
    for one in chosen or every:
        (start / one).mkdir()
        total += check(one, *every[one], start / one)
    sys.stdout.write(f"{total}\n")
