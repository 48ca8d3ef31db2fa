"""Carry the design study out anew: every search, trial and front of its page; all or those named.

The pictures of how a search went are drawn with it, for they show every design tried.

Run: python docs/studies [--into FOLDER] [NAME ...], or make studies
"""

from __future__ import annotations

import argparse
import csv
import json
import math
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

HERE = Path(__file__).resolve().parent
SEARCHES = ("a-equal-absorbers", "b-mirror-pairs", "b-25-free", "b-60-free", "c-hybrid", "d-mass-front", "e-robust-free")
"""Study files of the same name, in an order in which each finds what it begins from."""
SCRIPTS = {"c-electrodes": "c_electrodes.py", "d-front": "d_front.py", "optima-in-space": "optima_in_space.py"}
"""What no study file can say, and the script that does it from the results of b."""
PICTURES = {
    "a-equal-absorbers": "design-study-a.png",
    "b-mirror-pairs": "design-study-b.png",
    "c-hybrid": "design-study-c.png",
    "d-mass-front": "design-study-d.png",
}
"""Searches that the page shows, and the picture of each in docs/figures."""
OWN_FILE = {"optima-in-space": "peaks.csv"}
"""Scripts that write a file of this name instead of a folder."""


def search(name: str, target: Path, picture: Path | None) -> None:
    """Search as a study file says, and keep what the page needs of it."""
    with TemporaryDirectory() as folder:
        words = ["optimise", HERE / f"{name}.toml", "--output", "found", "--quiet", *(["--figure", "found.png"] if picture else [])]
        subprocess.run([sys.executable, "-m", "coaxshell", *words], check=True, stdout=subprocess.DEVNULL, cwd=folder)  # its journal too
        keep(Path(folder) / "found", target)
        if picture:
            with Image.open(Path(folder) / "found.png") as drawn:  # many thin lines make a file that pages would load slowly
                drawn.convert("RGB").quantize(128, dither=Image.Dither.NONE).save(picture, optimize=True)


def keep(found: Path, target: Path) -> None:
    """Keep of an optimum the best system, its numbers, and the front or how the best came down; not every design tried."""
    told = json.loads((found / "optimum.json").read_text(encoding="utf-8"))
    front = told["front"]
    if front:
        told |= {"front_file": "front.csv"}
        del told["front"]
        designs = ([*one["targets"].values(), *one["variables"].values()] for one in front)
        _write(target / "front.csv", [_headings(front[0], told["units"]), *designs])
    else:
        (objective, *_) = told["best"]["targets"]
        with (found / "history.csv").open(encoding="utf-8") as file:
            rows = list(improved(csv.DictReader(file), objective))
        _write(target / "convergence.csv", [("evaluation", f"best_so_far_{told['units'][objective]}"), *rows])
    (target / "optimum.json").write_text(json.dumps(told, indent=1), encoding="utf-8")
    shutil.copyfile(found / "best.toml", target / "best.toml")


def improved(history: Iterator[dict[str, str]], objective: str) -> Iterator[tuple[int, float]]:
    """Yield the number, from 1, and the objective of every design within the limits that was better than all before it."""
    best = math.inf
    for number, row in enumerate(history, start=1):
        value = float(row[objective] or "nan")
        if float(row["violation"]) == 0.0 and value < best:
            best = value
            yield number, value


def _headings(one: dict[str, dict[str, float]], units: dict[str, str]) -> list[str]:
    return [*(f"{name}_{units[name].replace('/', '_per_')}" for name in one["targets"]), *one["variables"]]


def _write(path: Path, rows: Sequence[Sequence[object]]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def carry_out(name: str, target: Path, pictures: Path) -> None:
    """Carry out one of them, into a folder that is there."""
    if name in SEARCHES:
        search(name, target, pictures / PICTURES[name] if name in PICTURES else None)
        return
    own = target / OWN_FILE[name] if name in OWN_FILE else target
    if own.is_file():
        own.unlink()  # it would be taken up where it ends
    subprocess.run([sys.executable, HERE / SCRIPTS[name], own], check=True, stdout=subprocess.DEVNULL)


def main(arguments: Sequence[str] | None = None) -> None:
    """Carry them out one after the other, and say how long each took."""
    parser = argparse.ArgumentParser(prog="python docs/studies", description=__doc__)
    known = (*SEARCHES, *SCRIPTS)
    parser.add_argument("names", nargs="*", metavar="NAME", help="folders in docs/studies/results; all unless given")
    parser.add_argument("--into", type=Path, metavar="FOLDER", help="instead of docs/studies/results and docs/figures")
    asked = parser.parse_args(arguments)
    unknown = set(asked.names) - set(known)
    if unknown:
        parser.error(f"there is no {', '.join(sorted(unknown))}; there are {', '.join(known)}")
    for name in asked.names or known:
        begun = time.perf_counter()
        target = (asked.into or HERE / "results") / name
        target.mkdir(parents=True, exist_ok=True)
        carry_out(name, target, asked.into or HERE.parent / "figures")
        sys.stdout.write(f"{name}  {time.perf_counter() - begun:.0f} s\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
