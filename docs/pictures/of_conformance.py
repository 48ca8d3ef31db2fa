"""The conformance report of this version: every number that someone else published first, then the whole suite."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from coaxshell.numerics.files import write_text

OF_PUBLICATIONS = ("`published`", "`published-frequencies`")
"""Checks all of whose values were printed by others."""
CITED = re.compile(r"^paper,|\b(?:18|19|20)\d\d\b")
"""The source of a single row that names the paper, or a publication by its year."""
SOURCE = 1
"""Its column."""
HEAD = """# Conformance of version {version}

What `coaxshell verify` found with this version, the whole suite, kept: {circumstances}.
The [verification report](generated/verification.md) is the quick suite as it went when these pages were built.
`python docs/pictures conformance.md` makes this page anew, some three minutes of a processor; it is written only if no row fails.

## Published numbers

All numbers that others printed and that the suite compares: theirs is "expected", ours "found"; then how far they are apart, what is
allowed, and how the difference is measured. What is allowed is the last printed digit, or what parts the theories: a published ring
that only bends is stiffer than ours, which stretches too, by (h/R)²; Love's cylinder lacks terms of that order; a fit to measured
bubbles scatters by some per cent. The paper prints figures, not numbers; its own rows are what its text says of them.

{published}

## The whole suite

{rest}"""


def page(report: str) -> str:
    """Return the page of a report in Markdown, as ``coaxshell verify`` writes it."""
    _title, circumstances, rest = report.split("\n\n", 2)
    version, _, where = circumstances.removeprefix("coaxshell ").partition(", ")
    headings = next(line for line in report.splitlines() if line.startswith("| what |"))
    ruled = "|".join(["", *["---"] * (headings.count("|") - 1), ""])
    table = "\n".join([headings, ruled, *published(report)])
    rest = re.sub(r"^## ", "### ", rest, flags=re.MULTILINE)
    rest = re.sub(r"(?<=checks) in \d+ s\b|(?<=`), [\d.]+ s(?=\.)", "", rest)  # how busy the machine was belongs nowhere
    return HEAD.format(version=version, circumstances=where.replace("; ", ", "), published=table, rest=rest)


def published(report: str) -> Iterator[str]:
    """Yield the rows of a report whose expected value was published by others."""
    for section in report.split("\n## ")[1:]:
        whole = any(name in section for name in OF_PUBLICATIONS)
        for line in section.splitlines():
            if line.startswith("| ") and not line.startswith(("| what |", "| --- ")):
                cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
                if whole or CITED.search(cells[SOURCE]):
                    yield line


def write(target: Path) -> None:
    """Carry out the whole suite and write its page, unless a row fails."""
    with TemporaryDirectory() as folder:
        words = ["verify", "--output", folder, "--quiet"]
        subprocess.run([sys.executable, "-m", "coaxshell", *words], check=True, stdout=subprocess.DEVNULL)
        write_text(target, page((Path(folder) / "report.md").read_text(encoding="utf-8")))
