"""Every picture of the pages, and every page kept with its numbers, can be made anew by one command."""

from __future__ import annotations

import ast

from house import PROJECT


def table(name: str, folder: str = "pictures") -> ast.Dict:
    """Return a table of the program in a folder of docs, as it is written."""
    tree = ast.parse((PROJECT / "docs" / folder / "__main__.py").read_text(encoding="utf-8"))
    for node in tree.body:
        target = node.target if isinstance(node, ast.AnnAssign) else node.targets[0] if isinstance(node, ast.Assign) else None
        if target is not None and target.id == name:
            return node.value
    raise LookupError(name)


def made(name: str) -> set[str]:
    """Return the names in a table of recipes."""
    return {key.value for key in table(name).keys}


def test_every_picture_has_its_recipe():
    drawn = {value.value for value in table("PICTURES", "studies").values}
    assert made("RECIPES") | drawn == {path.name for path in (PROJECT / "docs" / "figures").iterdir()}
    assert not made("RECIPES") & drawn


def test_every_page_with_a_recipe_is_kept_and_says_how_it_is_made():
    for name in made("PAGES"):
        assert f"`python docs/pictures {name}` makes this page anew" in (PROJECT / "docs" / name).read_text(encoding="utf-8")
