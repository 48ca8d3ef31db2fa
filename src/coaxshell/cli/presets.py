"""``coaxshell presets``: what there is to start from."""

from __future__ import annotations

import re

from coaxshell.cli.documents import JsonOption, print_document
from coaxshell.cli.streams import echo


def presets(as_json: JsonOption = False) -> None:
    """List the ready-made systems."""
    from coaxshell.model import presets as library

    if as_json:
        print_document({"presets": [{"name": name, "description": description(library.text(name))} for name in library.names()]})
        return
    width = max(len(name) for name in library.names())
    for name in library.names():
        echo(f"{name:<{width}}  {description(library.text(name))}")


def description(text: str) -> str:
    """Return the first sentence of the comment that a TOML text starts with."""
    lines = []
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# ").strip())
    return re.split(r"(?<!Fig\.)(?<!Figs\.)(?<=\.) ", " ".join(lines), maxsplit=1)[0]
