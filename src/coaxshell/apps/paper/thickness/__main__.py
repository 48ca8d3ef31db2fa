"""Make the map of the thin walls' error that the package holds again: ``python -m coaxshell.apps.paper.thickness map [FILE]``."""

from __future__ import annotations

import json
import re
import sys
import warnings
from importlib.resources import files
from pathlib import Path

from coaxshell.apps.paper.thickness import error_map
from coaxshell.errors import PhysicsWarning
from coaxshell.numerics.files import write_text
from coaxshell.solver import thin_error


def report(fraction: float, stage: str) -> None:
    """Write one line of progress to standard error."""
    sys.stderr.write(f"{100 * fraction:3.0f} % {stage}\n")


def main(arguments: list[str]) -> None:
    """Compute the map and write it into a file, the package's own unless one is given."""
    if arguments[:1] != ["map"]:
        sys.exit("say which: map")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PhysicsWarning)
        text = json.dumps(error_map.as_table(error_map.error_map(progress=report)), indent=1)
    own = Path(str(files("coaxshell.solver").joinpath(thin_error.DATA)))
    write_text(Path(arguments[1]) if arguments[1:] else own, re.sub(r"\n\s+(?=[-\d\]n])", " ", text) + "\n")


if __name__ == "__main__":
    main(sys.argv[1:])
