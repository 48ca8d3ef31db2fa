"""The page "slice, cylinder or sphere?": one run in three dimensions, three in two, the claims that the package holds, and pictures."""

from __future__ import annotations

from pathlib import Path

from coaxshell.apps.paper.sphere.kept import known_claims
from coaxshell.apps.paper.sphere.report import report
from coaxshell.apps.paper.sphere.texts import TITLE
from coaxshell.plotting import save_figure

TAIL = """
## Again

```sh
python -m coaxshell.apps.paper.sphere map map.json        # the map, about a minute of one processor
python -m coaxshell.apps.paper.sphere claims claims.json  # the statements, ten minutes
coaxshell reproduce --only sphere                         # all but the map, in one report
```

```python
from coaxshell.apps.paper.sphere.kept import known_claims
from coaxshell.apps.paper.sphere.report import report

found = report(judged=known_claims())  # of the paper's bare shells
print(found.markdown())
found.figures()  # by name
```
"""


def sphere_report(folder: Path, newest: float) -> None:
    """Write slice-or-sphere.md and its pictures into a folder, unless the sources, the newest of that time, are older than they are."""
    page = folder / "slice-or-sphere.md"
    if page.exists() and page.stat().st_mtime > newest:
        return
    made = report(judged=known_claims())
    for name, figure in made.figures().items():
        save_figure(figure, folder / f"{name}.png")
    page.write_text(f"# {TITLE}\n\n{made.markdown()}{TAIL}", encoding="utf-8")
