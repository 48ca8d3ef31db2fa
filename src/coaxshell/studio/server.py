"""One server on 127.0.0.1, from the free port to the clean end."""

from __future__ import annotations

import errno
import socket
from collections.abc import Callable
from contextlib import suppress

import uvicorn

from coaxshell.errors import InputError
from coaxshell.studio.guard import Guard

ADDRESS = "127.0.0.1"


def serve(port: int, ready: Callable[[str], None]) -> None:
    """Serve the page until interrupted.

    Parameters
    ----------
    port : int
        0 takes any free one.
    ready : callable
        Called with the page's address once the server answers.

    Raises
    ------
    InputError
        The port is taken, or not allowed.
    """
    with listening(port) as listener:
        from coaxshell.studio.app import create_app  # takes seconds to import: after the port has been had

        port = listener.getsockname()[1]
        app = create_app(port)
        # A page that rests keeps its connections: a request sent into one that is just being closed would be lost.
        config = uvicorn.Config(app, log_level="error", server_header=False, timeout_keep_alive=75, timeout_graceful_shutdown=2)
        with suppress(KeyboardInterrupt):  # Ctrl-C is how it ends
            _Server(config, app, lambda: ready(f"http://{ADDRESS}:{port}/")).run(sockets=[listener])


def listening(port: int) -> socket.socket:
    """Return a socket that listens on a port of this machine only; InputError if that cannot be had."""
    if not 0 <= port <= 65535:
        raise InputError("--port", f"{port} is not allowed", "give a number from 1024 to 65535, or 0 for any free one")
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((ADDRESS, port))
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            raise InputError("--port", f"{port} is in use", "stop what uses it, or give another one (0 takes any free one)") from None
        raise InputError("--port", f"{port} cannot be used ({error.strerror})", "give a number from 1024 to 65535, or 0") from None
    listener.listen(128)
    return listener


class _Server(uvicorn.Server):
    """Tells when it is ready, and ends all work and streams first of all, since requests wait for them."""

    def __init__(self, config: uvicorn.Config, guard: Guard, ready: Callable[[], None]) -> None:
        super().__init__(config)
        self._guard, self._ready = guard, ready

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        await super().startup(sockets)
        if self.started:
            self._ready()

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        self._guard.app.state.studio.close()
        await super().shutdown(sockets)
