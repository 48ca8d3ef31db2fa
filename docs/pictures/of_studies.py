"""Pictures of the design study: the searches of its files run again, and what the kept optima look like."""

from __future__ import annotations

import subprocess
import sys
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from saving import lighten

STUDIES = Path(__file__).resolve().parents[1] / "studies"


def optima(target: Path) -> None:
    """What the kept optima look like, and the front."""
    subprocess.run([sys.executable, STUDIES / "draw_optima.py", target], check=True)


def search(name: str, target: Path) -> None:
    """Run a study again and draw how it went."""
    with TemporaryDirectory() as folder:
        words = ["optimise", STUDIES / f"{name}.toml", "--output", "found", "--figure", target.resolve(), "--quiet", "--force"]
        subprocess.run([sys.executable, "-m", "coaxshell", *words], check=True, stdout=subprocess.DEVNULL, cwd=folder)  # its journal too
    lighten(target, shades=5)  # a front's many thin lines make a file that pages would load slowly


equal = partial(search, "a-equal-absorbers")
mirror = partial(search, "b-mirror-pairs")
hybrid = partial(search, "c-hybrid")
front = partial(search, "d-mass-front")
