"""The site that `make docs` built: nothing is asked of the network, every public name and every page is there."""

from __future__ import annotations

import html
import inspect
import re
import sys
import zlib
from pathlib import Path

import pytest

import coaxshell as cx
from coaxshell import export, plotting
from coaxshell.apps import verification

sys.path.insert(0, str(Path(__file__).parents[1] / "extensions"))
from mathml import convert

BUILT = Path(__file__).parents[1] / "built"
OUTSIDE = re.compile(r"^(?:[a-z]+:)?//", re.IGNORECASE)
# Characters of code that fit the column of a page on a screen 1280 pixels wide.
WIDEST_CODE = 104
# What a browser fetches by itself when it shows the page; <a href> only leads somewhere when clicked.
FETCHED = {"link": ("href",), "script": ("src",), "img": ("src", "srcset"), "source": ("src", "srcset"), "iframe": ("src",)}
FETCHED |= {"video": ("src", "poster"), "audio": ("src",), "object": ("data",), "embed": ("src",), "image": ("href", "xlink:href")}


SCRIPTS = re.compile(r"<!--.*?-->|(<(script|style)\b[^>]*>).*?</\2>", re.DOTALL | re.IGNORECASE)
ATTRIBUTE = re.compile(r"""([^\s=<>"'/]+)(?:\s*=\s*(?:"([^"]*)"|'([^']*)'|([^\s"'>]+)))?""")
TAG = re.compile(r"""<([a-z][\w:-]*)\s((?:[^>"']|"[^"]*"|'[^']*')*)>""", re.IGNORECASE)


class Page:
    """What a page fetches, where it leads, and the ids it has: in a third of the time that a parser of all of HTML takes."""

    def __init__(self, text: str) -> None:
        self.fetched: list[str] = []
        self.links: list[str] = []
        self.ids: set[str] = set()
        for tag, written in TAG.findall(SCRIPTS.sub(r"\1", text)):
            given = {name.lower(): html.unescape("".join(values)) for name, *values in ATTRIBUTE.findall(written)}
            tag = tag.lower()
            self.fetched += [given[name] for name in FETCHED.get(tag, ()) if given.get(name)]
            self.ids |= {value for name in ("id", "name") if (value := given.get(name))}
            if tag == "a" and given.get("href"):
                self.links.append(given["href"])


@pytest.fixture(scope="module")
def pages() -> dict[Path, Page]:
    found = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(BUILT.rglob("*.html")) if "_downloads" not in path.parts}
    assert len(found) > 20, "build the pages first: make docs"
    return found


def test_the_reading_of_a_page_sees_what_it_fetches_and_where_it_leads():
    page = Page("""<LINK rel=x href='a&amp;b.css'><script src="//out.org/x.js">"<img src='no.png'>"</script><!-- <img src="no.svg"> -->
      <img alt="a > b" srcset=c.png /><p id=one><a class="x" href="d.html#e" name="two">f</a><a>g</a>""")
    assert page.fetched == ["a&b.css", "//out.org/x.js", "c.png"]
    assert page.links == ["d.html#e"]
    assert page.ids == {"one", "two"}
    assert OUTSIDE.match(page.fetched[1])


def test_no_page_fetches_anything_from_outside(pages):
    assert {path.name: wrong for path, page in pages.items() if (wrong := [url for url in page.fetched if OUTSIDE.match(url)])} == {}


def test_no_style_sheet_fetches_anything_from_outside():
    sheets = list(BUILT.rglob("*.css"))
    assert sheets
    for sheet in sheets:
        urls = re.findall(r"(?:url\(|@import\s+)[\"']?([^\"')]+)", sheet.read_text(encoding="utf-8"))
        assert [url for url in urls if OUTSIDE.match(url)] == [], sheet


def test_no_script_of_a_page_names_an_outside_address(pages):
    for path in pages:
        scripts = re.findall(r"<script[^>]*>(.*?)</script>", path.read_text(encoding="utf-8"), re.DOTALL)
        assert [text for text in scripts if re.search(r"https?://", text)] == [], path


def test_links_between_pages_lead_somewhere(pages):
    broken = []
    for path, page in pages.items():
        for link in page.links:
            if ":" in link.split("/")[0] or OUTSIDE.match(link):
                continue
            target, _, part = link.partition("#")
            other = (path.parent / target.split("?")[0]).resolve() if target else path
            if not other.exists() or (part and other in pages and part not in pages[other].ids):
                broken.append(f"{path.relative_to(BUILT)}: {link}")
    assert broken == []


def documented() -> set[str]:
    """Return the full names in the site's inventory of Python objects."""
    raw = (BUILT / "objects.inv").read_bytes()
    header = b"".join(raw.splitlines(keepends=True)[:4])
    lines = zlib.decompress(raw[len(header) :]).decode().splitlines()
    return {line.split(" ")[0] for line in lines if " py:" in line}


def test_every_public_name_is_in_the_reference():
    names = {f"coaxshell.{name}" for name in cx.__all__}
    names |= {f"coaxshell.Response.{name}" for name, _ in inspect.getmembers(cx.Response) if not name.startswith("_")}
    names |= {f"coaxshell.PreparedSystem.{name}" for name, _ in inspect.getmembers(cx.PreparedSystem) if not name.startswith("_")}
    for room in (plotting, export, verification):
        names |= {f"{room.__name__}.{name}" for name in room.__all__}
    assert sorted(names - documented()) == []


def test_every_figure_is_small():
    heavy = {path.name: path.stat().st_size for path in BUILT.rglob("_images/*") if path.stat().st_size > 400_000}
    assert heavy == {}


def test_no_formula_was_left_as_text(pages):
    for path in pages:
        if "source" in path.parts:
            continue
        text = re.sub(r"<(pre|code|script).*?</\1>", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
        assert re.findall(r"\\[a-zA-Z]+", text) == [], path


def test_no_backslash_was_read_as_an_escape():
    """A tab with "ilde" behind it is drawn as the product of four letters."""
    sources = [path for path in BUILT.parent.rglob("*.md") if not {"built", "generated", "tutorials"} & set(path.parts)]
    assert len(sources) > 50
    assert [path.name for path in sources if re.search(r"[\a\b\t\v\f\x1b]", path.read_text(encoding="utf-8"))] == []


def test_formulas_are_spaced_as_in_print():
    """Functions stand off from what they are of, strokes and bars stand close, and so do signs."""
    found = convert(r"W\cos m\theta + \ln(a/R) = -|z|")
    assert '<mi>W</mi><mo form="prefix" lspace="0.17em" rspace="0.17em">cos</mo><mi>m</mi>' in found
    assert '<mo form="prefix" lspace="0em" rspace="0em">ln</mo>' in found
    tight = re.findall(r'<mo(?: \w+="\w+")* lspace="0em" rspace="0em">(&#x\w+;)</mo>', found)
    assert tight == ["&#x0002F;", "&#x02212;", "&#x0007C;", "&#x0007C;"]
    assert "lspace" not in convert("a - b")


def test_what_is_typed_stands_as_it_is_typed(pages):
    """In running text two hyphens become a dash: ``--compare`` would be shown, and copied, as an option that does not exist."""
    for path in pages:
        text = re.sub(r"<(pre|code|script).*?</\1>", "", path.read_text(encoding="utf-8"), flags=re.DOTALL)
        assert re.findall(r"(?<![\w>])–[a-z][\w-]*", re.sub(r"<[^>]+>", "", text)) == [], path


def test_code_is_not_wider_than_its_page(pages):
    wide = []
    for path in pages:
        if "source" in path.parts:
            continue
        text = path.read_text(encoding="utf-8")
        blocks = re.findall(r'<div class="highlight-(?:sh|toml|python|Python|text)[^"]*">.*?<pre>(.*?)</pre>', text, re.DOTALL)
        lines = [html.unescape(re.sub(r"<[^>]+>", "", line)) for block in blocks for line in block.splitlines()]
        wide += [f"{path.name}: {line}" for line in lines if len(line) > WIDEST_CODE]
    assert wide == []
