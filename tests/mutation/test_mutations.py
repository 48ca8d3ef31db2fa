"""Every mutation still has its place in the source, and its nearest tests exist; `make mutation` tries them."""

from __future__ import annotations

import ast
from functools import cache

from mutations import MUTATIONS

from house import PACKAGE, PROJECT


@cache
def source_of(file):
    """Return the text of a file of the package and its syntax, which no comment or blank changes."""
    text = (PACKAGE / file).read_text(encoding="utf-8")
    return text, ast.dump(ast.parse(text))


def fault(mutation):
    """Return why a mutation would break nothing or cannot be carried out, None if it can."""
    text, syntax = source_of(mutation.file)
    if text.count(mutation.original) != 1:
        return f"its text stands {text.count(mutation.original)} times in {mutation.file}"
    if ast.dump(ast.parse(text.replace(mutation.original, mutation.mutated))) == syntax:
        return "it changes nothing"
    if not mutation.nearest:
        return "it names no tests"
    lost = [name for name in mutation.nearest.split() if not (PROJECT / "tests" / name).exists()]
    return f"no tests {', '.join(lost)}" if lost else None


def test_every_mutation_has_its_place_and_its_tests():
    assert len(MUTATIONS) > 100
    assert {mutation.name: why for mutation in MUTATIONS if (why := fault(mutation))} == {}


def test_a_mutation_that_cannot_be_tried_is_seen():
    good = MUTATIONS[0]
    assert fault(good) is None
    assert fault(good._replace(original="an egg")) == f"its text stands 0 times in {good.file}"
    assert fault(good._replace(mutated=good.original)) == "it changes nothing"
    assert fault(good._replace(nearest="")) == "it names no tests"
    assert fault(good._replace(nearest="egg/test_egg.py")) == "no tests egg/test_egg.py"


def test_names_of_mutations_are_different():
    assert len({mutation.name for mutation in MUTATIONS}) == len(MUTATIONS)
