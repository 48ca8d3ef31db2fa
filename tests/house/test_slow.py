"""What is slow has something beside it that always runs: `make test` leaves out no whole file, and no test without a case of it."""

from __future__ import annotations

import re

from house import PROJECT, named

TEST = re.compile(r"^\s*(?:async )?def (test_\w+)\(")


def marked_in(text: str) -> dict[str, bool]:
    """Return the tests of a file and whether each is slow as a whole, by the marks that stand straight above it."""
    found, marks = {}, []
    for line in text.splitlines():
        if match := TEST.match(line):
            found[match[1]] = "@pytest.mark.slow" in marks
        marks = [*marks, line.strip()] if line.strip() and not match else []
    return found


def test_marks_are_seen():
    text = "@pytest.mark.slow\n@pytest.mark.parametrize('a', [1])\ndef test_b(a): ...\n\n\ndef test_c(): ...\n"
    assert marked_in(text) == {"test_b": True, "test_c": False}


def test_every_file_has_a_test_that_always_runs():
    files = {named(path): marked_in(path.read_text(encoding="utf-8")) for path in sorted((PROJECT / "tests").rglob("test_*.py"))}
    assert len(files) > 250
    assert [name for name, of in files.items() if of and all(of.values())] == []
