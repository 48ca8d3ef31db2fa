"""Pages that the package writes itself at every build: reports, commands, licences, limits, quantities, and a picture of the house."""

from __future__ import annotations

from concurrent.futures import Future, ProcessPoolExecutor
from multiprocessing import get_context
from pathlib import Path

from cli_pages import command_reference
from house_picture import write_picture
from licence_pages import licence_table
from limit_pages import limit_table
from quantity_pages import quantity_table
from sphere_pages import sphere_report
from sphinx.application import Sphinx
from sphinx.config import Config
from thickness_pages import thickness_report
from verification_pages import newest_source, verification_report

import coaxshell

_BEGUN: list[Future[None]] = []


def begin_reports(app: Sphinx, _config: Config) -> None:
    """Begin the three reports that take a minute, in a process of their own: the examples are run beside."""
    folder = _folder(app)
    pool = ProcessPoolExecutor(1, mp_context=get_context("spawn"))
    _BEGUN[:] = [
        pool.submit(verification_report, folder),
        *(pool.submit(one, folder, newest_source()) for one in (sphere_report, thickness_report)),
    ]
    pool.shutdown(wait=False)


def write_pages(app: Sphinx) -> None:
    """Write the pages into docs/generated, where Sphinx finds them."""
    folder = _folder(app)
    pages = {"commands": command_reference, "licences": licence_table, "limits": limit_table, "quantities": quantity_table}
    for name, page in pages.items():
        _replace_if_changed(folder / f"{name}.md", page())
    write_picture(Path(coaxshell.__file__).parent, folder / "house.svg")
    for report in _BEGUN:
        report.result()


def _folder(app: Sphinx) -> Path:
    folder = Path(app.srcdir) / "generated"
    folder.mkdir(exist_ok=True)
    return folder


def _replace_if_changed(path: Path, text: str) -> None:
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def setup(app: Sphinx) -> dict[str, bool]:
    """Write before anything is read."""
    app.connect("config-inited", begin_reports)
    app.connect("builder-inited", write_pages)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
