"""``coaxshell presets``: what there is to start from."""

from __future__ import annotations

from coaxshell.apps.cli.options import JsonOption
from coaxshell.apps.cli.output import echo, print_document


def presets(as_json: JsonOption = False) -> None:
    """List the ready-made systems."""
    from coaxshell.model import presets as library

    if as_json:
        print_document({"presets": [{"name": name, "description": library.description(name)} for name in library.names()]})
        return
    width = max(len(name) for name in library.names())
    for name in library.names():
        echo(f"{name:<{width}}  {library.description(name)}")
