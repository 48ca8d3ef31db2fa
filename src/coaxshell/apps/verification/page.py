"""The report as one HTML file that asks for nothing outside itself: plots are inlined, no script, light and dark."""

from __future__ import annotations

import base64
from collections.abc import Iterable
from html import escape

from coaxshell.apps.verification.drawing import svg
from coaxshell.apps.verification.rows import HEADINGS, Row, Sheet
from coaxshell.apps.verification.suite import Report, Result

STYLE = """
:root { color-scheme: light dark; --ink: #1c2330; --dim: #5a6472; --line: #d9dee6; --paper: #ffffff; --wash: #f4f6f9;
  --good: #00694e; --bad: #b3261e; --bad-wash: #fdecea; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e8ee; --dim: #a0a9b6; --line: #39414d; --paper: #14181e; --wash: #1c222a;
  --good: #4fc79f; --bad: #ff9c94; --bad-wash: #40201e; } }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 76rem; padding: 1.5rem 1.25rem 4rem; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
h1 { font-size: 1.6rem; margin: 0 0 .25rem; } h2 { font-size: 1.15rem; margin: 2.4rem 0 .3rem; }
p { margin: .3rem 0; max-width: 60rem; } .dim { color: var(--dim); font-size: .87rem; }
.verdict { display: inline-block; margin: .8rem 0; padding: .45rem .9rem; border-radius: .4rem; font-weight: 600; background: var(--wash); }
.good { color: var(--good); } .bad { color: var(--bad); }
.wide { overflow-x: auto; margin: .6rem 0; }
table { border-collapse: collapse; width: 100%; font-size: .84rem; font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: top; padding: .32rem .6rem; border-bottom: 1px solid var(--line); }
th { color: var(--dim); font-weight: 600; white-space: nowrap; border-bottom-width: 2px; }
td:nth-child(7) { white-space: nowrap; }
td.n { text-align: right; white-space: nowrap; } th.n { text-align: right; }
tr.fail td { background: var(--bad-wash); }
nav ul { columns: 3 18rem; list-style: none; padding: 0; margin: .6rem 0; font-size: .9rem; }
nav li { break-inside: avoid; padding: .1rem 0; }
a { color: inherit; text-decoration-color: var(--dim); text-underline-offset: .15em; }
figure { margin: 1rem 0; max-width: 66rem; } figure.one { max-width: 42rem; }
figure img { display: block; width: 100%; height: auto; background: #fff; border: 1px solid var(--line);
  border-radius: .4rem; padding: .5rem; }
figcaption { color: var(--dim); font-size: .87rem; margin-top: .35rem; } figcaption b { color: var(--ink); }
"""

_NUMBERS = {"expected", "found", "error", "tolerance"}


def page(report: Report) -> str:
    """Return the report as HTML text."""
    good = not report.failed
    body = [
        f'<header><h1>{escape(report.title)}</h1><p class="dim">{escape(report.circumstances)}</p><p class="dim">{escape(report.note)}</p>',
        f'<p class="verdict {"good" if good else "bad"}">{escape(report.verdict)}</p></header>',
        _contents(report) if len(report.results) > 1 else "",
        "<main>",
        *(_section(result) for result in report.results),
        "</main>",
    ]
    return document(report.title, body)


def document(title: str, body: Iterable[str], style: str = "") -> str:
    """Return HTML text with this room's look, and more style if given; empty pieces of the body are left out."""
    parts = [
        "<!doctype html>",
        f'<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
        f'<link rel="icon" href="data:,"><title>{escape(title)}</title><style>{STYLE}{style}</style></head><body>',
        *body,
        "</body></html>",
    ]
    return "\n".join(part for part in parts if part) + "\n"


def _contents(report: Report) -> str:
    items = []
    for result in report.results:
        bad = sum(row.verdict == "FAIL" for row in result.rows)
        mark = (
            f'<span class="bad">{bad} of {len(result.rows)} fail</span>'
            if bad
            else f'<span class="good">{len(result.rows)} rows pass</span>'
        )
        items.append(f'<li><a href="#{escape(result.name)}">{escape(result.title)}</a> · {mark}</li>')
    return f'<nav aria-label="Checks"><ul>{"".join(items)}</ul></nav>'


def _section(result: Result) -> str:
    parts = [
        f'<section id="{escape(result.name)}"><h2>{escape(result.title)}</h2>',
        f"<p>{escape(result.about)}</p>",
        f'<p class="dim">{escape(result.name)}, {result.seconds:.1f} s</p>' if result.seconds else "",
        _table(result.rows),
        *(_figure(sheet) for sheet in result.sheets),
        "</section>",
    ]
    return "\n".join(part for part in parts if part)


def _table(rows: tuple[Row, ...]) -> str:
    head = "".join(f'<th scope="col"{_number(name)}>{name}</th>' for name in HEADINGS)
    body = []
    for row in rows:
        cells = [f"<td{_number(name)}>{escape(cell)}</td>" for name, cell in zip(HEADINGS[:-1], row.cells, strict=False)]
        colour = {"pass": "good", "FAIL": "bad"}.get(row.verdict, "dim")
        cells.append(f'<td class="{colour}"><b>{row.verdict}</b></td>')
        body.append(f"<tr{' class=fail' if row.verdict == 'FAIL' else ''}>{''.join(cells)}</tr>")
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{"".join(body)}</tbody></table></div>'


def _number(name: str) -> str:
    return ' class="n"' if name in _NUMBERS else ""


def _figure(sheet: Sheet) -> str:
    kind = "" if len(sheet.panels) > 1 else "one"
    return inlined(svg(sheet).encode(), "svg+xml", sheet.title, escape(sheet.caption), kind)


def inlined(picture: bytes, form: str, title: str, caption: str, kind: str = "") -> str:
    """Return a picture ("png", "svg+xml") within the page, its title and its caption (HTML) below it."""
    data = base64.b64encode(picture).decode()
    return (
        f"<figure{f' class={kind}' if kind else ''}>"
        f'<img alt="{escape(title)}" src="data:image/{form};base64,{data}">'
        f"<figcaption><b>{escape(title)}.</b> {caption}</figcaption></figure>"
    )
