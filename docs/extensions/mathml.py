"""Write mathematics as MathML at build time: browsers draw it themselves, so no script is fetched."""

from __future__ import annotations

import re
import unicodedata

from docutils import nodes
from latex2mathml.converter import convert as to_mathml
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.util.math import get_node_equation_number
from sphinx.writers.html5 import HTML5Translator

# Browsers know no mathvariant but "normal": other letters are characters of their own.
ALPHABETS = {"bold": "MATHEMATICAL BOLD", "script": "MATHEMATICAL SCRIPT", "double-struck": "MATHEMATICAL DOUBLE-STRUCK"}
LETTERLIKE = {"MATHEMATICAL SCRIPT CAPITAL R": "\N{SCRIPT CAPITAL R}", "MATHEMATICAL SCRIPT CAPITAL L": "\N{SCRIPT CAPITAL L}"}
STYLED = re.compile(r'<mi mathvariant="(bold|script|double-struck)">([A-Za-z]+)</mi>')
# What TeX knows of spaces: a function stands off from its neighbours, though not from a bracket; strokes and bars stand close, and so
# does the sign of a number, which browsers take for a difference wherever it is not the first in a row.
FUNCTION = re.compile(r"(?P<before></(?:mi|mn|ms\w+|mfrac)>|&#x00029;</mo>)?<mi>(?P<name>[a-z]{2,})</mi>(?P<open>(?=<mo[^>]*>&#x00028;))?")
TIGHT = re.compile(r'<mo(?: stretchy="false")?>(&#x0002F;|&#x0007C;)</mo>')
SIGN = re.compile(r"(<mo[^>]*>(?!&#x0(?:0029|005D|007C|007D|0021);)[^<]*</mo>|<mspace[^>]*/>|<mtd[^>]*>)<mo>&#x02212;</mo>")


def convert(text: str, display: str = "inline") -> str:
    """Return LaTeX as MathML; ExtensionError for an environment that the converter would write out as letters and ampersands."""
    found = to_mathml(text, display=display)
    if "<mi>&</mi>" in found or "<mi>&amp;</mi>" in found:
        raise ExtensionError(f"no MathML for {text!r}: use cases, array or pmatrix")
    found = SIGN.sub(r'\1<mo form="prefix" lspace="0em" rspace="0em">&#x02212;</mo>', found)
    found = TIGHT.sub(r'<mo stretchy="false" lspace="0em" rspace="0em">\1</mo>', found)
    found = FUNCTION.sub(_function, found)
    return STYLED.sub(lambda one: f"<mi>{''.join(_letter(one[1], each) for each in one[2])}</mi>", found)


def _function(found: re.Match[str]) -> str:
    before, after = "0.17em" if found["before"] else "0em", "0em" if found["open"] is not None else "0.17em"
    return f'{found["before"] or ""}<mo form="prefix" lspace="{before}" rspace="{after}">{found["name"]}</mo>'


def _letter(alphabet: str, letter: str) -> str:
    name = f"{ALPHABETS[alphabet]} {'CAPITAL' if letter.isupper() else 'SMALL'} {letter.upper()}"
    return LETTERLIKE.get(name) or unicodedata.lookup(name)


def inline(writer: HTML5Translator, node: nodes.math) -> None:
    """Write a formula within a line."""
    writer.body.append(f'<span class="math">{convert(node.astext())}</span>')
    raise nodes.SkipNode


def block(writer: HTML5Translator, node: nodes.math_block) -> None:
    """Write a formula of its own, with its number if it has one."""
    writer.body.append(writer.starttag(node, "div", CLASS="math notranslate"))
    if node["number"]:
        number = get_node_equation_number(writer, node)
        writer.body.append(f'<span class="eqno">({number})</span>')
    writer.body.append(convert(node.astext(), display="block"))
    writer.body.append("</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Offer the renderer "mathml"."""
    app.add_html_math_renderer("mathml", inline_renderers=(inline, None), block_renderers=(block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
