"""Physics warnings as one plain line each on stderr, each said once a run."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

from coaxshell.cli.streams import printable
from coaxshell.errors import PhysicsWarning


@contextmanager
def plain_physics_warnings() -> Iterator[None]:
    """Show physics warnings as ``warning: ...`` on stderr; leave all other warnings as they were."""
    said: set[str] = set()
    with warnings.catch_warnings():
        usual = warnings.showwarning

        def show(
            message: Warning | str, category: type[Warning], filename: str, lineno: int, file: TextIO | None = None, line: str | None = None
        ) -> None:
            if not issubclass(category, PhysicsWarning):
                usual(message, category, filename, lineno, file, line)
                return
            text = " ".join(str(message).split())
            if text not in said:
                said.add(text)
                sys.stderr.write(printable(f"warning: {text}\n"))

        warnings.simplefilter("always", PhysicsWarning)
        warnings.showwarning = show
        yield
