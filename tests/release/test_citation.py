"""What archives and citations read says the same as the package."""

from __future__ import annotations

import json
import re
import tomllib

from coaxshell import __version__
from house import PROJECT


def test_every_place_that_names_the_version_names_this_one():
    citation = (PROJECT / "CITATION.cff").read_text(encoding="utf-8")
    archive = json.loads((PROJECT / ".zenodo.json").read_text(encoding="utf-8"))
    project = tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert re.search(r'^version: "(.*)"$', citation, re.MULTILINE).group(1) == archive["version"] == __version__
    assert re.search(r'^title: "(.*)"$', citation, re.MULTILINE).group(1) == archive["title"]
    assert archive["license"] == project["license"]
    assert archive["keywords"] == project["keywords"] == re.findall(r"^  - ([\w -]+)$", citation, re.MULTILINE)
    changes = (PROJECT / "CHANGELOG.md").read_text(encoding="utf-8")
    released = re.search(r'^date-released: "(.*)"$', citation, re.MULTILINE).group(1)
    assert f"## [{__version__}] - {released}" in changes
