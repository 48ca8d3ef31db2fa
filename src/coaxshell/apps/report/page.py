"""A report as one HTML file that asks for nothing outside itself, made for A4 paper."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Sequence
from html import escape
from importlib.resources import files
from urllib.parse import quote

from coaxshell.apps.report.parts import Beside, Code, Drawing, Item, Listed, Picture, Section, Table
from coaxshell.numerics.texts import typeset

_SHORT = 16
"""Rows of a table that stays on one page of paper."""


def page(title: str, subtitle: str, sections: Sequence[Section]) -> str:
    """Return the report as HTML text."""
    style = files("coaxshell.apps.report").joinpath("style.css").read_text(encoding="utf-8")
    told = escape(title).replace("'", "’").replace("\\", "")
    contents = "".join(f'<li><a href="#section-{n}">{escape(one.title)}</a></li>' for n, one in enumerate(sections, 1))
    return "\n".join(
        [
            "<!doctype html>",
            '<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">',
            f'<link rel="icon" href="data:,"><title>{escape(title)}</title>',
            f"<style>{style}@page {{ @top-left {{ content: '{told}'; }} }}</style></head><body>",
            f'<header><p class="kind">Shock response of concentric shells</p><h1>{escape(title)}</h1><p>{escape(subtitle)}</p></header>',
            f'<nav aria-label="Contents"><ol>{contents}</ol></nav><main>',
            *_sections(sections),
            "</main></body></html>\n",
        ]
    )


def _sections(sections: Sequence[Section]) -> Iterator[str]:
    writer = _Writer()
    for number, section in enumerate(sections, 1):
        yield f'<section id="section-{number}"><h2>{number} {escape(section.title)}</h2>'
        yield from map(writer.item, section.items)
        yield "</section>"


class _Writer:
    """Write items as HTML, figures and tables counted as they come."""

    def __init__(self) -> None:
        self.figures = self.tables = 0

    def item(self, item: Item) -> str:
        """Return one item."""
        match item:
            case Picture():
                data = base64.b64encode(item.content).decode()
                return self._figure(f'<img alt="{escape(item.alt)}" src="data:image/{item.form};base64,{data}">', item)
            case Drawing():
                return self._figure(item.svg, item)
            case Beside():
                return f'<div class="beside">{self.item(item.drawing)}<div>{"".join(map(self.item, item.items))}</div></div>'
            case Table():
                self.tables += 1
                return _table(item, self.tables)
            case Listed():
                return f"<ul>{''.join(f'<li>{_told(text)}</li>' for text in item.items)}</ul>"
            case Code():
                saved = _saved(item.text, item.name, "application/toml", f"save {item.name}") if item.name else ""
                kept = ' class="scenario"' if item.name else ""
                kept = kept if item.printed else ' class="screen"'
                return f'<pre tabindex="0"{kept}><code>{escape(item.text.rstrip())}</code></pre>{f"<p>{saved}</p>" if saved else ""}'
        return f"<p>{escape(item)}</p>"

    def _figure(self, shown: str, item: Picture | Drawing) -> str:
        self.figures += 1
        saved = ""
        if isinstance(item, Picture) and item.data:
            saved = " " + _saved(item.table, f"{item.name}.csv", "text/csv", f"data of figure {self.figures} (CSV)")
        return f"<figure>{shown}<figcaption><b>Figure {self.figures}.</b> {escape(item.caption)}{saved}</figcaption></figure>"


def _told(text: str) -> str:
    """Return a text with its numbers as they are printed; a dash for what there is nothing of."""
    return escape("–" if text == "-" else typeset(text))


def _saved(text: str, name: str, kind: str, words: str) -> str:
    """Return a link that saves a text as a file."""
    content = quote(text, safe=" ,()/.:;=-_*+@!?~^[]{}|")
    return f'<a class="data" download="{escape(name)}" href="data:{kind};charset=utf-8,{content}">{escape(words)}</a>'


def _table(table: Table, number: int) -> str:
    def cells(row: Sequence[str], tag: str) -> str:
        kind = ' scope="col"' if tag == "th" else ""
        return "".join(
            f"<{tag}{kind}{'' if i < table.words else ' class=n'}>{_told(cell)}</{tag}>" if cell or tag == "td" else "<td></td>"
            for i, cell in enumerate(row)
        )

    body = "".join(f"<tr>{cells(row, 'td')}</tr>" for row in table.rows)
    caption = f"<caption><b>Table {number}.</b> {escape(table.caption)}</caption>"
    head = f"<thead><tr>{cells(table.headings, 'th')}</tr></thead>"
    opening = f'<div class="wide{" short" if len(table.rows) <= _SHORT else ""}" tabindex="0" role="region" aria-label="Table {number}">'
    return f"{opening}<table>{caption}{head}<tbody>{body}</tbody></table></div>"
