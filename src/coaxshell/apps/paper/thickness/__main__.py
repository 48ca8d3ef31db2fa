"""Make what the package holds about thin and exact walls again.

``python -m coaxshell.apps.paper.thickness map [FILE]``: the map of the thin walls' error, a quarter of a minute;
``python -m coaxshell.apps.paper.thickness claims [FILE]``: the paper's statements on absorbers with both, three minutes.
"""

from __future__ import annotations

import json
import re
import sys
import warnings
from importlib.resources import files
from pathlib import Path

from coaxshell.apps.paper.thickness import error_map, kept
from coaxshell.apps.paper.thickness.judged import absorbers_judged_with_both
from coaxshell.errors import PhysicsWarning
from coaxshell.numerics.files import write_text
from coaxshell.solver import thin_error


def report(fraction: float, stage: str) -> None:
    """Write one line of progress to standard error."""
    sys.stderr.write(f"{100 * fraction:3.0f} % {stage}\n")


def map_text() -> tuple[str, Path]:
    """Return the map as JSON text, and where the package has it."""
    text = json.dumps(error_map.as_table(error_map.error_map(progress=report)), indent=1)
    return re.sub(r"\n\s+(?=[-\d\]n])", " ", text) + "\n", Path(str(files("coaxshell.solver").joinpath(thin_error.DATA)))


def claims_text() -> tuple[str, Path]:
    """Return the judged statements as JSON text, and where the package has them."""
    text = json.dumps(kept.as_table(absorbers_judged_with_both()), indent=1) + "\n"
    return text, Path(str(files("coaxshell.apps.paper.thickness").joinpath(kept.DATA)))


def main(arguments: list[str]) -> None:
    """Compute the map or the statements and write them into a file, the package's own unless one is given."""
    made = {"map": map_text, "claims": claims_text}
    if not arguments or arguments[0] not in made:
        sys.exit(f"say which: {' or '.join(made)}")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", PhysicsWarning)
        text, path = made[arguments[0]]()
    write_text(Path(arguments[1]) if arguments[1:] else path, text)


if __name__ == "__main__":
    main(sys.argv[1:])
