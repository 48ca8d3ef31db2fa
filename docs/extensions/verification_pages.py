"""The conformance report, by ``coaxshell verify --quick`` (or the whole suite, COAXSHELL_DOCS_VERIFY=full)."""

from __future__ import annotations

import os
import re
from pathlib import Path

from coaxshell.apps.verification import chosen, run, write_report

HEAD = """# Verification report

This page is what `coaxshell verify{quick}` printed when these pages were built; `coaxshell verify` carries out the whole suite, and
writes the same with plots as one HTML file ({download}).
Every row compares a number with theory, a published or high-precision value, or a method that shares nothing with ours. No row is
taken out when it fails: it would be listed at the top, and the command would leave with exit code 1.
"""


def verification_report(folder: Path) -> None:
    """Write verification.md and the report with plots into a folder, unless sources are older than they are."""
    page = folder / "verification.md"
    full = os.environ.get("COAXSHELL_DOCS_VERIFY") == "full"
    if page.exists() and page.stat().st_mtime > newest_source() and not full:
        return
    report = run(chosen(None, not full), quick=not full)
    text, html = write_report(report, folder / "report")
    body = re.sub(r"\A# .*\n", "", text.read_text(encoding="utf-8"))
    text.unlink()
    head = HEAD.format(quick="" if full else " --quick", download=f"{{download}}`the one of this build <report/{html.name}>`")
    page.write_text(head + body, encoding="utf-8")


def newest_source() -> float:
    """Return when the package's newest file was changed, seconds."""
    package = Path(__file__).parents[2] / "src" / "coaxshell"
    return max(path.stat().st_mtime for path in package.rglob("*.py"))
