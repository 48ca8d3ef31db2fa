"""Every picture of the pages, and every page kept with its numbers, can be made anew by one command."""

from __future__ import annotations

import ast

from house import PROJECT


def made(table: str) -> set[str]:
    """Return the names in a table of recipes."""
    tree = ast.parse((PROJECT / "docs" / "pictures" / "__main__.py").read_text(encoding="utf-8"))
    (recipes,) = (node.value for node in tree.body if isinstance(node, ast.AnnAssign) and node.target.id == table)
    return {key.value for key in recipes.keys}


def test_every_picture_has_its_recipe():
    assert made("RECIPES") == {path.name for path in (PROJECT / "docs" / "figures").iterdir()}


def test_every_page_with_a_recipe_is_kept_and_says_how_it_is_made():
    for name in made("PAGES"):
        assert f"`python docs/pictures {name}` makes this page anew" in (PROJECT / "docs" / name).read_text(encoding="utf-8")
