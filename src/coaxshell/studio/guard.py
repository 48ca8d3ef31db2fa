"""The gate before every route: only this page's own requests, of bounded size, and headers that keep the page to itself.

The server has no password, so that two kinds of stranger must be kept out. A page of another site that makes the browser send requests
here is told by Origin and Sec-Fetch-Site; one that has pointed its own name at 127.0.0.1 (DNS rebinding) is told by Host.
"""

from __future__ import annotations

import logging

from starlette.applications import Starlette
from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import JSONResponse
from starlette.types import Message, Receive, Scope, Send

from coaxshell.studio.refusals import RefusedError

HEADERS = {
    # plotly.js writes style elements of its own; nothing else may come from anywhere but this server.
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; media-src 'self' blob:; "
        "connect-src 'self'; font-src 'self'; worker-src 'self'; manifest-src 'self'; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}
FRIENDS = ("same-origin", "none")
"""Values of Sec-Fetch-Site that are not another site: the page itself, and an address that a person typed."""


class Guard:
    """Refuse what does not come from the page itself, add the security headers, and turn failures into answers.

    Parameters
    ----------
    app : Starlette
    hosts : tuple of str
        What the header Host may be, with the port.
    """

    def __init__(self, app: Starlette, hosts: tuple[str, ...]) -> None:
        self.app, self.hosts = app, hosts
        self.origins = tuple(f"http://{host}" for host in hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass a request on, or answer it here."""
        if scope["type"] == "lifespan":
            return await self.app(scope, receive, send)
        if scope["type"] != "http":
            return None  # no websockets here: the connection is closed
        started = False

        async def sealed(message: Message) -> None:
            nonlocal started
            if message["type"] == "http.response.start":
                started = True
                headers = MutableHeaders(scope=message)
                for name, value in HEADERS.items():
                    headers[name] = value
                headers.setdefault("Cache-Control", "no-store")
            await send(message)

        try:
            self.check(Headers(scope=scope))
            await self.app(scope, receive, sealed)
        except RefusedError as refused:
            if not started:
                await refused.response(scope, receive, sealed)
        except Exception:
            logging.getLogger(__name__).exception("a request failed")
            if started:
                raise
            body = {
                "code": "internal",
                "where": scope["path"],
                "problem": "the server failed",
                "remedy": "its log in the terminal tells more",
            }
            await JSONResponse({"error": body}, 500)(scope, receive, sealed)

    def check(self, headers: Headers) -> None:
        """Raise RefusedError unless Host, Origin and Sec-Fetch-Site are this page's own."""
        if len(headers.getlist("host")) != 1 or headers["host"].lower() not in self.hosts:
            raise RefusedError(403, "forbidden", "Host", "is not this server's", f"open http://{self.hosts[0]}/")
        origins = headers.getlist("origin")
        if any(origin.lower() not in self.origins for origin in origins):
            raise RefusedError(403, "forbidden", "Origin", "is another site", f"open http://{self.hosts[0]}/")
        if headers.get("sec-fetch-site", "none") not in FRIENDS:
            raise RefusedError(403, "forbidden", "Sec-Fetch-Site", "is another site", f"open http://{self.hosts[0]}/")
