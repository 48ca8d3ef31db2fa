"""Every picture of the pages can be made anew by one command."""

from __future__ import annotations

import ast

from house import PROJECT


def test_every_picture_has_its_recipe():
    tree = ast.parse((PROJECT / "docs" / "pictures" / "__main__.py").read_text(encoding="utf-8"))
    (recipes,) = (node.value for node in tree.body if isinstance(node, ast.AnnAssign) and node.target.id == "RECIPES")
    named = {key.value for key in recipes.keys}
    assert named == {path.name for path in (PROJECT / "docs" / "figures").iterdir()}
