"""``coaxshell studio``: the page in the browser."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Annotated

import typer

from coaxshell.errors import InputError

PORT = 8765


def studio(
    port: Annotated[int, typer.Option("--port", metavar="PORT", help="Where to listen on this machine; 0 takes any free port.")] = PORT,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Only print the address.")] = False,
) -> None:
    """Design by hand in the browser, on this machine.

    Ctrl-C ends it. Needs the extra 'studio'.
    """
    missing = [name for name in ("starlette", "uvicorn", "plotly") if find_spec(name) is None]
    if missing:
        raise InputError("studio", f"needs {', '.join(missing)}", 'install what is missing: pip install "coaxshell[studio]"')
    from coaxshell.studio.server import serve

    def ready(address: str) -> None:
        typer.echo(f"coaxshell studio: {address}  (Ctrl-C ends it)")
        if not no_browser:
            import webbrowser

            webbrowser.open(address)

    serve(port, ready)
