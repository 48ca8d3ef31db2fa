"""The summary on a terminal."""

from __future__ import annotations

import io
from dataclasses import replace

import pytest
from rich.console import Console

from coaxshell import load_response
from coaxshell.apps.cli.output import summary_table


@pytest.fixture
def summary(saved):
    return load_response(saved).summary()


def printed(table, width):
    out = io.StringIO()
    Console(file=out, width=width, force_terminal=True, color_system=None).print(table)
    return out.getvalue()


def test_says_the_same_as_the_plain_table(summary):
    drawn = printed(summary_table(summary), 100).split()
    plain = str(summary).partition("estimated relative errors")[0].splitlines()  # what follows is the same text on both
    rows = [line.split()[1:] for line in plain if line.startswith(("inner ", "outer "))]
    assert len(rows) >= 12
    for row in rows:
        assert any(drawn[i : i + len(row)] == row for i in range(len(drawn))), row


def test_fits_a_narrow_terminal_without_wrapping_rows(summary):
    rows = [line for line in printed(summary_table(summary), 80).splitlines() if "stress" in line or "displacement" in line]
    assert len(rows) == 20


def test_a_name_in_brackets_is_no_markup(summary):
    assert "[red]bare[/red]" in printed(summary_table(replace(summary, title="[red]bare[/red]")), 80)
