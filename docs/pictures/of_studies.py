"""What the kept optima of the design study look like; how its searches went is drawn as they are carried out, by docs/studies."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

STUDIES = Path(__file__).resolve().parents[1] / "studies"


def optima(target: Path) -> None:
    """What the kept optima look like, and the front."""
    subprocess.run([sys.executable, STUDIES / "draw_optima.py", target], check=True)
