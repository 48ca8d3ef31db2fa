"""``coaxshell studio``: the page in the browser."""

from __future__ import annotations

import os
import sys
from importlib.util import find_spec
from threading import Thread
from typing import Annotated

import typer

from coaxshell.apps.cli import options
from coaxshell.apps.cli.output import echo
from coaxshell.errors import InputError

PORT = "8765"


def studio(
    port: Annotated[str, typer.Option("--port", metavar="N", help="Where to listen on this machine; 0 takes any free port.")] = PORT,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Only print the address.")] = False,
    allow_host: Annotated[
        list[str] | None,
        typer.Option(
            "--allow-host", metavar="NAME", help="Answer under this name too, behind a proxy of your own; may be given repeatedly."
        ),
    ] = None,
) -> None:
    """Design by hand in the browser, on this machine.

    Prints an address with a key, which only you should have, and opens it. Ctrl-C ends it. Needs the extra 'studio'.
    """
    missing = [name for name in ("starlette", "uvicorn") if find_spec(name) is None]
    if missing:
        raise InputError("studio", f"needs {', '.join(missing)}", 'install what is missing: pip install "coaxshell[studio]"')
    for name in allow_host or ():
        if not name or not name.isascii() or not name.replace("-", "a").replace(".", "a").isalnum():
            raise InputError(
                "--allow-host", f"{name!r} is not the name of a host", "give one without http:// and port, such as lab.example.org"
            )
    number = options.whole("--port", port)
    from coaxshell.apps.studio.server import serve

    def ready(address: str) -> None:
        echo(f"coaxshell studio: {address}  (Ctrl-C ends it)")
        if not no_browser and _has_display():
            import webbrowser

            # A browser may take its time, and one for the terminal would not come back before it is closed.
            Thread(target=webbrowser.open, args=(address,), daemon=True).start()

    serve(number, ready, allow_host or ())


def _has_display() -> bool:
    """Tell whether a browser would have a window; without one, far away through SSH say, the address is only printed."""
    return sys.platform in ("win32", "darwin") or any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER"))
