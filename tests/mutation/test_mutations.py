"""Every mutation still has its place in the source, and its nearest tests exist; `make mutation` tries them."""

from __future__ import annotations

import ast

import pytest
from mutations import MUTATIONS

from house import PACKAGE, PROJECT


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.name)
def test_the_place_of_a_mutation_stands_exactly_once(mutation):
    source = (PACKAGE / mutation.file).read_text(encoding="utf-8")
    assert source.count(mutation.original) == 1
    before, after = (ast.dump(ast.parse(text)) for text in (source, source.replace(mutation.original, mutation.mutated)))
    assert before != after


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.name)
def test_the_nearest_tests_of_a_mutation_exist(mutation):
    assert mutation.nearest
    assert all((PROJECT / "tests" / name).exists() for name in mutation.nearest.split())


def test_names_of_mutations_are_different():
    assert len({mutation.name for mutation in MUTATIONS}) == len(MUTATIONS)
