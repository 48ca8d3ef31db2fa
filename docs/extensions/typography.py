"""Keep on one line what is read as one: a number and its per cent or unit, and two numbers with an arrow between them."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.transforms import SphinxTransform

NO_BREAK = "\N{NO-BREAK SPACE}"
UNIT = re.compile(r"(?<=\d) (?=%|[kMGmn\u00b5\u03bc]?(?:Pa|Hz|m|s|V|W|N|J|g|B)\b)")
"""The space between a number and its unit."""
ARROW = re.compile(r"(?<=\d) \u2192 (?=[\d\u221e])")
VERBATIM = (nodes.literal, nodes.FixedTextElement, nodes.math, nodes.math_block, nodes.raw, nodes.comment)


def kept_together(text: str) -> str:
    """Return a text with spaces that no line is broken at where they stand within a quantity."""
    return ARROW.sub(f"{NO_BREAK}\u2192{NO_BREAK}", UNIT.sub(NO_BREAK, text))


class KeepTogether(SphinxTransform):
    """Go through the texts of a page, code and formulas left out."""

    default_priority = 700

    def apply(self, **kwargs: Any) -> None:
        """Replace the spaces."""
        for text in list(self.document.findall(nodes.Text)):
            parent = text.parent
            if isinstance(parent, VERBATIM) or (found := kept_together(str(text))) == str(text):
                continue
            parent.replace(text, nodes.Text(found))


def setup(app: Sphinx) -> dict[str, Any]:
    """Connect it."""
    app.add_transform(KeepTogether)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
