"""Measure what every slip does and print it as a Markdown table: ``python -m coaxshell.apps.paper.slips``."""

from __future__ import annotations

import sys

from coaxshell.apps.paper.slips.effects import effects, table


def report(fraction: float, stage: str) -> None:
    """Write one line of progress to standard error."""
    sys.stderr.write(f"{100 * fraction:3.0f} % {stage}\n")


def main() -> None:
    """Measure at the paper's resolution, with progress on standard error, and print the table."""
    sys.stdout.write(table(list(effects(progress=report))))


if __name__ == "__main__":
    main()
