"""Make the map of the slice's error again: ``python -m coaxshell.apps.paper.sphere [FILE]``; two minutes of one processor."""

from __future__ import annotations

import json
import re
import sys
from importlib.resources import files
from pathlib import Path

from coaxshell.apps.paper.sphere.error_map import as_table, error_map
from coaxshell.numerics.files import write_text
from coaxshell.solver.slice_error import DATA


def report(fraction: float, stage: str) -> None:
    """Write one line of progress to standard error."""
    sys.stderr.write(f"{100 * fraction:3.0f} % {stage}\n")


def main(arguments: list[str]) -> None:
    """Compute the map and write it into a file, the package's own unless one is given."""
    path = Path(arguments[0]) if arguments else Path(str(files("coaxshell.solver").joinpath(DATA)))
    text = json.dumps(as_table(error_map(progress=report)), indent=1)
    write_text(path, re.sub(r"\n\s+(?=[-\d\]n])", " ", text) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
