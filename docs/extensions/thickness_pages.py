"""The page "thin or exact walls?": thirteen runs in two dimensions, the map that the package holds, and pictures."""

from __future__ import annotations

from pathlib import Path

from coaxshell.apps.paper.thickness.judged import judged_with_both
from coaxshell.apps.paper.thickness.kept import known_of_absorbers
from coaxshell.apps.paper.thickness.report import report
from coaxshell.apps.paper.thickness.texts import TITLE
from coaxshell.plotting import save_figure

TAIL = """
## Again

```sh
python -m coaxshell.apps.paper.thickness map map.json        # the map, a quarter of a minute
python -m coaxshell.apps.paper.thickness claims claims.json  # those on absorbers, three minutes
coaxshell reproduce --only walls                             # all but map and statements, in one report
```

```python
from coaxshell.apps.paper.thickness.judged import judged_with_both
from coaxshell.apps.paper.thickness.kept import known_of_absorbers
from coaxshell.apps.paper.thickness.report import report

found = report(judged=(*judged_with_both(), *known_of_absorbers()))
print(found.markdown())
found.figures()  # by name
```
"""


def thickness_report(folder: Path, newest: float) -> None:
    """Write thin-or-exact.md and its pictures into a folder, unless the sources, the newest of that time, are older than they are."""
    page = folder / "thin-or-exact.md"
    if page.exists() and page.stat().st_mtime > newest:
        return
    made = report(judged=(*judged_with_both(), *known_of_absorbers()))
    for name, figure in made.figures().items():
        save_figure(figure, folder / f"{name}.png")
    page.write_text(f"# {TITLE}\n\n{made.markdown()}{TAIL}", encoding="utf-8")
