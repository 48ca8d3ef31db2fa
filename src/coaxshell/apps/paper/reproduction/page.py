"""The report as one HTML file and as Markdown with pictures beside it."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

from coaxshell.apps.paper.claims import Judged
from coaxshell.apps.paper.reproduction import texts
from coaxshell.apps.paper.reproduction.plan import VARIANTS
from coaxshell.apps.paper.reproduction.results import Results
from coaxshell.apps.paper.sphere import texts as sphere
from coaxshell.apps.paper.sphere.judged import Judgement
from coaxshell.apps.paper.sphere.report import claims_markdown
from coaxshell.apps.paper.thickness import texts as walls
from coaxshell.apps.verification.markdown import table
from coaxshell.apps.verification.page import document, inlined
from coaxshell.apps.verification.suite import circumstances
from coaxshell.numerics.files import replacing

MARKS = {"holds": "good", "holds in part": "part", "does not hold": "bad", "not judged": "dim"}
_STYLE = """
:root { --part: #8a5a00; } @media (prefers-color-scheme: dark) { :root { --part: #e5b567; } }
.part { color: var(--part); } code { font-size: .86em; background: var(--wash); padding: .1em .35em; border-radius: .25em; }
td:nth-child(7) { white-space: normal; } td .dim { font-size: .95em; }
.claims th, .slips th { white-space: normal; vertical-align: bottom; }
@media (min-width: 60.01rem) { .claims td:nth-child(n + 4):nth-child(-n + 7) { width: 4.6rem; }
  .claims td:nth-child(3) { width: 28%; } .claims td:nth-child(8) { width: 30%; }
  .claims.both td:nth-child(n + 3):nth-child(-n + 4) { width: 5.2rem; }
  .claims.both td:nth-child(n + 5):nth-child(-n + 6) { width: 33%; white-space: normal; } }
video { width: 100%; max-width: 66rem; border: 1px solid var(--line); border-radius: .4rem; }
details { margin-top: .3rem; } summary { cursor: pointer; color: var(--dim); } h2 { scroll-margin-top: 1rem; }
@media (max-width: 60rem) { /* one statement or slip below the other, each cell with the heading of its column */
  .claims thead, .slips thead { display: none; }
  .claims tr, .slips tr { display: block; padding: .7rem 0; border-bottom: 1px solid var(--line); }
  .claims td, .slips td { display: block; border: 0; padding: .12rem 0; }
  .claims td::before, .slips td::before { content: attr(data-heading) ": "; color: var(--dim); } }
"""


def html(results: Results) -> str:
    """Return the report as HTML text that asks for nothing outside itself."""
    sections = {
        "claims": ("The statements", _claims(results) if results.judged else ""),
        "figures": ("The figures", "".join(_figures(results))),
        "film": ("Film", _film(results)),
        "slips": ("The slips", _slips(results) if results.effects else ""),
        "sphere": (sphere.TITLE, _sphere(results)),
        "walls": (walls.TITLE, _walls(results)),
        "times": ("Run times, and how to repeat", _times(results)),
    }
    shown = {name: entry for name, entry in sections.items() if entry[1]}
    contents = "".join(f'<li><a href="#{name}">{title}</a></li>' for name, (title, _) in shown.items())
    links = "".join(
        f'<li><a href="#figure-{f.recipe.number}">Figure {f.recipe.number}: {escape(f.recipe.title)}</a></li>' for f in results.figures
    )
    body = [
        f'<header><h1>{texts.TITLE}</h1><p class="dim">{escape(circumstances())}</p>',
        f'<p class="dim">{escape(texts.circumstances_of(results))}</p>',
        f"<p>{escape(texts.ABOUT)}</p></header>",
        f'<nav aria-label="Contents"><ul>{contents}{links}</ul></nav>',
        *(f'<section id="{name}"><h2>{title}</h2>{content}</section>' for name, (title, content) in shown.items()),
    ]
    return document(texts.TITLE, body, _STYLE)


def _table(headings: Sequence[str], rows: Iterable[Sequence[str]], kind: str = "") -> str:
    """Return a table of cells that are HTML already."""
    head = "".join(f'<th scope="col">{escape(name)}</th>' for name in headings)
    names = [escape(name) for name in headings]
    body = "".join(
        "<tr>" + "".join(f'<td data-heading="{name}">{cell}</td>' for name, cell in zip(names, row, strict=True)) + "</tr>" for row in rows
    )
    return f'<div class="wide"><table class="{kind}"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>'


def _escaped(rows: Iterable[Sequence[str]]) -> list[list[str]]:
    return [[escape(cell) for cell in row] for row in rows]


def _claims(results: Results) -> str:
    tally = _table(texts.TALLY_HEADINGS, _escaped(texts.tally_rows(results)))
    return tally + _table(texts.CLAIM_HEADINGS, [_claim(judged) for judged in results.judged], "claims")


def _claim(judged: Judged) -> list[str]:
    claim, found = judged.claim, judged.corrected
    numbers = "".join(f"<li>{escape(name)}: {value:.5g}</li>" for name, value in found.measured.items())
    turned = "".join(f"<li>{escape(text)}</li>" for text in texts.turned_text(judged))
    others = f"<details><summary>where a slip turns it</summary><ul>{turned}</ul></details>" if turned else ""
    return [
        f'<span id="claim-{claim.number}">{claim.number}</span>',
        escape(claim.place),
        f'{escape(claim.statement)}<br><span class="dim">{escape(claim.criterion)}</span>',
        *(f'<b class="{MARKS[judged.findings[name].verdict]}">{judged.findings[name].verdict}</b>' for name in VARIANTS),
        f"{escape(found.why)}<details><summary>numbers</summary><ul>{numbers}</ul></details>{others}",
    ]


def _figures(results: Results) -> list[str]:
    found = []
    for figure in results.figures:
        recipe, command = figure.recipe, texts.figure_command(figure, results.resolution)
        title = f"Figure {recipe.number}: {recipe.title}"
        told = f"<details><summary>{len(figure.warnings)} warning(s) of its runs</summary><ul>" if figure.warnings else ""
        told += "".join(f"<li>{escape(text)}</li>" for text in figure.warnings) + ("</ul></details>" if figure.warnings else "")
        caption = f"{escape(recipe.caption)} <code>{escape(command)}</code>{told}"
        found.append(f'<div id="figure-{recipe.number}">{inlined(figure.png, "png", title, caption)}</div>')
    return found


def _film(results: Results) -> str:
    if results.film is None:
        return ""
    film, suffix = results.film
    data = base64.b64encode(film).decode()
    text = "<p>Pressure and stress, bare (left) and hybrid (right).</p>"
    if suffix == ".webp":
        return f'{text}<img alt="film" src="data:image/webp;base64,{data}">'
    return f'{text}<video controls muted loop src="data:video/mp4;base64,{data}"></video>'


def _slips(results: Results) -> str:
    return (
        _table(texts.SLIP_HEADINGS, _escaped(texts.slip_rows()), "slips")
        + "<p>What they do to the stress, each turned on alone or together in the ordinary solver:</p>"
        + _table(texts.EFFECT_HEADINGS, _escaped(texts.effect_rows(results)))
    )


def _sphere(results: Results) -> str:
    found = results.sphere
    if found is None:
        return ""
    shown = [inlined(found.pictures[name], "png", sphere.TITLE, escape(caption)) for name, caption in sphere.CAPTIONS.items()]
    tables = [f"<p>{escape(caption)}</p>{_table(headings, _escaped(rows))}" for caption, headings, rows in found.tables]
    use = "".join(f"<li>{escape(line)}</li>" for line in sphere.USE)
    judged = "" if found.judged is None else _in_both(found.judged)
    said = "".join(f"<p>{escape(text)}</p>" for text in (sphere.ABOUT, found.told))
    return (
        f"{said}{tables[0]}{tables[1]}<p>{escape(sphere.WHY)}</p>{shown[0]}<p>{escape(sphere.MAP)}</p>{shown[1]}{tables[2]}"
        f"{judged}<ul>{use}</ul>"
    )


def _walls(results: Results) -> str:
    found = results.walls
    if found is None:
        return ""
    shown = [inlined(found.pictures[name], "png", walls.TITLE, escape(caption)) for name, caption in walls.CAPTIONS.items()]
    tables = [f"<p>{escape(caption)}</p>{_table(headings, _escaped(rows))}" for caption, headings, rows in found.tables]
    use = "".join(f"<li>{escape(line)}</li>" for line in walls.USE)
    return (
        f"<p>{escape(walls.ABOUT)}</p>{''.join(tables[:3])}<p>{escape(found.told)}</p><p>{escape(walls.WHY)}</p>{shown[0]}"
        f"<p>{escape(found.map_told)}</p>{shown[1]}{tables[3]}<ul>{use}</ul>"
    )


def _in_both(judged: Judgement) -> str:
    """Return the claims under slice and sphere, their verdicts marked."""
    rows = [
        [*_escaped([row[:2]])[0], *(f'<b class="{MARKS[verdict]}">{verdict}</b>' for verdict in row[2:4]), *_escaped([row[4:]])[0]]
        for row in judged.rows
    ]
    said = f"<p>{escape(sphere.CLAIMS)}</p><p>{escape(judged.told)}</p>"
    return f"<h3>{sphere.CLAIMS_TITLE}</h3>{said}{_table(sphere.CLAIM_HEADINGS, rows, 'claims both')}"


def _times(results: Results) -> str:
    estimate = f"<p>{escape(texts.estimate_text(results.estimate))}</p>" if results.estimate else ""
    return f"{estimate}<p>All of it again: <code>{escape(_command(results))}</code>; finished parts are taken up.</p>" + _table(
        texts.TIME_HEADINGS, _escaped(texts.time_rows(results))
    )


def _command(results: Results) -> str:
    return f"coaxshell reproduce{texts.options_of(results.resolution)}"


def markdown(results: Results) -> str:
    """Return the report as Markdown text; pictures are the files beside it."""
    parts = [f"# {texts.TITLE}", circumstances(), texts.circumstances_of(results), texts.ABOUT]
    if results.judged:
        rows = [texts.claim_cells(judged) for judged in results.judged]
        parts += ["## The statements", table(texts.TALLY_HEADINGS, texts.tally_rows(results)), table(texts.CLAIM_HEADINGS, rows)]
        turned = [f"- {judged.claim.number}, {text}" for judged in results.judged for text in texts.turned_text(judged)]
        parts += ["### Where a slip turns the verdict", "\n".join(turned)] if turned else []
    for figure in results.figures:
        recipe = figure.recipe
        parts += [f"## Figure {recipe.number}: {recipe.title}", f"![Figure {recipe.number}](figures/figure-{recipe.number}.png)"]
        parts.append(f"{recipe.caption} `{texts.figure_command(figure, results.resolution)}`")
    if results.film:
        parts += ["## Film", f"[film{results.film[1]}](film{results.film[1]})"]
    if results.effects:
        parts += ["## The slips", table(texts.SLIP_HEADINGS, texts.slip_rows()), table(texts.EFFECT_HEADINGS, texts.effect_rows(results))]
    if results.sphere:
        parts += [f"## {sphere.TITLE}", results.sphere.markdown.replace("\n## ", "\n### ").strip()]
        if results.sphere.judged is not None:
            parts += [f"### {sphere.CLAIMS_TITLE}", *claims_markdown(results.sphere.judged)]
    if results.walls:
        parts += [f"## {walls.TITLE}", results.walls.markdown.replace("\n## ", "\n### ").strip()]
    parts.append("## Run times, and how to repeat")
    if results.estimate:
        parts.append(texts.estimate_text(results.estimate))
    parts += [f"All of it again: `{_command(results)}`; finished parts are taken up.", table(texts.TIME_HEADINGS, texts.time_rows(results))]
    return "\n\n".join(parts) + "\n"


def write(results: Results, folder: Path) -> tuple[Path, ...]:
    """Write report.html, report.md, the figures and the film into a folder, each whole or not at all, and return the reports' paths."""
    pictures = folder / "figures"
    pictures.mkdir(parents=True, exist_ok=True)
    files = {pictures / f"figure-{figure.recipe.number}.png": figure.png for figure in results.figures}
    if results.walls:
        files |= {pictures / f"{name}.png": picture for name, picture in results.walls.pictures.items()}
    if results.sphere:
        files |= {pictures / f"{name}.png": picture for name, picture in results.sphere.pictures.items()}
    if results.film:
        files[folder / f"film{results.film[1]}"] = results.film[0]
    reports = {folder / "report.md": markdown(results).encode(), folder / "report.html": html(results).encode()}
    for path, content in (files | reports).items():
        with replacing(path) as partial:
            partial.write_bytes(content)
    return tuple(reports)
