"""One server on 127.0.0.1, from the free port to the clean end."""

from __future__ import annotations

import asyncio
import errno
import signal
import socket
import threading
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager, suppress
from typing import Any

import uvicorn
from uvicorn.protocols.http.h11_impl import H11Protocol

from coaxshell.apps.studio import limits
from coaxshell.apps.studio.guard import Guard
from coaxshell.errors import InputError

ADDRESS = "127.0.0.1"


def serve(port: int, ready: Callable[[str], None], names: Collection[str] = ()) -> None:
    """Serve the page until interrupted.

    Parameters
    ----------
    port : int
        0 takes any free one.
    ready : callable
        Called with the page's address, its key at the end, once the server answers.
    names : collection of str
        Names of hosts, beside those of this machine, under which the page may be reached.

    Raises
    ------
    InputError
        The port is taken, or not allowed.
    """
    with listening(port) as listener:
        from coaxshell.apps.studio.app import create_app  # takes seconds to import: after the port has been had
        from coaxshell.apps.studio.guard import kept_key

        port, key = listener.getsockname()[1], kept_key()
        app = create_app(port, key, names)
        # A page that rests keeps its connections: a request sent into one that is just being closed would be lost.
        config = uvicorn.Config(
            app, http=Patient, log_level="error", server_header=False, timeout_keep_alive=75, timeout_graceful_shutdown=2
        )
        server = _Server(config, app, lambda: ready(f"http://{ADDRESS}:{port}/?key={key}"))
        with suppress(KeyboardInterrupt), closed_terminal(server):  # Ctrl-C is how it ends
            server.run(sockets=[listener])


def listening(port: int) -> socket.socket:
    """Return a socket that listens on a port of this machine only; InputError if that cannot be had."""
    if not 0 <= port <= 65535:
        raise InputError("--port", f"{port} is not allowed", "give a number from 1024 to 65535, or 0 for any free one")
    listener = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((ADDRESS, port))
        listener.listen(128)
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            raise InputError("--port", f"{port} is in use", "stop what uses it, or give another one (0 takes any free one)") from None
        if error.errno in (errno.EACCES, errno.EPERM):
            raise InputError(
                "--port", f"{port} is kept for the system", "give a number from 1024 to 65535, or 0 for any free one"
            ) from None
        raise InputError("--port", f"{port} cannot be used ({error.strerror})", "give a number from 1024 to 65535, or 0") from None
    return listener


@contextmanager
def closed_terminal(server: uvicorn.Server) -> Iterator[None]:
    """End the server as Ctrl-C does when its terminal is closed; under nohup it goes on."""
    number = getattr(signal, "SIGHUP", None)
    if number is None or threading.current_thread() is not threading.main_thread() or signal.getsignal(number) is signal.SIG_IGN:
        yield
        return

    def end(*_: Any) -> None:
        server.should_exit = True

    before = signal.signal(number, end)
    try:
        yield
    finally:
        signal.signal(number, before)


class Patient(H11Protocol):
    """HTTP that closes a connection whose request's head has not come after a while; bodies have a time of their own."""

    _late: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin to wait for the first request."""
        super().connection_made(transport)
        self._wait()

    def data_received(self, data: bytes) -> None:
        """Go on waiting, or stop once a request is here."""
        super().data_received(data)
        self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        self._stop()
        super().connection_lost(exc)

    def _wait(self) -> None:
        if self.cycle is not None and not self.cycle.response_complete:
            self._stop()
        elif self._late is None and self.timeout_keep_alive_task is None:
            self._late = self.loop.call_later(limits.HEAD_SECONDS, self._give_up)

    def _give_up(self) -> None:
        self._late = None
        if self.cycle is None or self.cycle.response_complete:
            self.transport.close()

    def _stop(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None


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
