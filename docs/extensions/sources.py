"""Turn links to the package's files into pages of highlighted source that say which pages of the manual speak of them.

In Markdown they are ordinary relative links, ``[coupling](../src/coaxshell/solver/coupling.py#modal_determinant)``, which a code
forge follows too; a definition's name after # leads to its line.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from docutils import nodes
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import PythonLexer
from sphinx import addnodes
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment
from sphinx.errors import ExtensionError
from sphinx.transforms import SphinxTransform

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "src" / "coaxshell"
FOLDER = "source"


def definitions(path: Path) -> dict[str, int]:
    """Return the lines of functions, classes, methods and constants of a file, methods as Class.method."""
    found: dict[str, int] = {}

    def walk(body: list[ast.stmt], prefix: str) -> None:
        for node in body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.AsyncFunctionDef):
                found[prefix + node.name] = node.lineno
                if isinstance(node, ast.ClassDef):
                    walk(node.body, f"{prefix}{node.name}.")
            elif isinstance(node, ast.Assign | ast.AnnAssign):
                targets = node.targets if isinstance(node, ast.Assign) else [node.target]
                found.update({prefix + target.id: node.lineno for target in targets if isinstance(target, ast.Name)})

    walk(ast.parse(path.read_text(encoding="utf-8")).body, "")
    return found


class LinkSources(SphinxTransform):
    """Point links to files under src/coaxshell at their pages."""

    default_priority = 400

    def apply(self, **_: Any) -> None:
        """Replace the download links of the page being read."""
        for node in list(self.document.findall(addnodes.download_reference)):
            target, _, name = node["reftarget"].partition("#")
            path = (Path(self.env.doc2path(self.env.docname)).parent / target).resolve()
            if PACKAGE not in path.parents or path.suffix != ".py":
                continue
            if name and name not in definitions(path):
                raise ExtensionError(f"{self.env.docname}: {path.relative_to(ROOT)} defines no {name!r}")
            page = path.relative_to(PACKAGE.parent).with_suffix("").as_posix()
            line = f"#line-{definitions(path)[name]}" if name else ""
            up = "../" * self.env.docname.count("/")
            link = nodes.reference("", "", *node.children, refuri=f"{up}{FOLDER}/{page}.html{line}", internal=True)
            node.replace_self(link)
            _mentions(self.env).setdefault(page, set()).add(self.env.docname)


def _mentions(env: BuildEnvironment) -> dict[str, set[str]]:
    if not hasattr(env, "source_mentions"):
        env.source_mentions = {}  # type: ignore[attr-defined]
    return env.source_mentions  # type: ignore[attr-defined,no-any-return]


def pages(app: Sphinx) -> Iterator[tuple[str, dict[str, Any], str]]:
    """Yield a page for each module."""
    formatter = HtmlFormatter(linenos="inline", linespans="line", cssclass="highlight source-lines")
    for path in sorted(PACKAGE.rglob("*.py")):
        page = path.relative_to(PACKAGE.parent).with_suffix("").as_posix()
        name = f"{FOLDER}/{page}"
        spoken_of = [
            f'<a href="{app.builder.get_relative_uri(name, docname)}">{app.env.titles[docname].astext()}</a>'
            for docname in sorted(_mentions(app.env).get(page, ()))
        ]
        told = f"<p>Explained in: {', '.join(spoken_of)}.</p>" if spoken_of else ""
        title = path.relative_to(PACKAGE.parent).as_posix()
        text = highlight(path.read_text(encoding="utf-8"), PythonLexer(), formatter)
        yield name, {"title": title, "body": f"<h1>{title}</h1>{told}{text}"}, "page.html"


def _one_navigation(app: Sphinx, page: str, _template: str, context: dict[str, Any], _doctree: Any) -> None:
    """Make the navigation once for all pages of source that lie equally deep, where its links are the same."""
    if not page.startswith(f"{FOLDER}/"):
        return
    make = context["toctree"]
    known = app.env.__dict__.setdefault("source_navigation", {})

    def toctree(**options: Any) -> str:
        key = (page.count("/"), *sorted(options.items()))
        if key not in known:
            known[key] = make(**options)
        return str(known[key])

    context["toctree"] = toctree


def _merge(_: Sphinx, env: BuildEnvironment, __: list[str], other: BuildEnvironment) -> None:
    for page, documents in _mentions(other).items():
        _mentions(env).setdefault(page, set()).update(documents)


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect the transform and the pages."""
    app.add_transform(LinkSources)
    app.connect("html-collect-pages", pages)
    app.connect("html-page-context", _one_navigation, priority=100)  # before the theme asks for it
    app.connect("env-merge-info", _merge)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
