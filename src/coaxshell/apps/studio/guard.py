"""The gate before every route: only who has the key, only this page's own requests, and headers that keep the page to itself.

Three kinds of stranger must be kept out. Another user of this machine, who can connect as well, does not have the key. A page of another
site that makes the browser send requests here, with the cookie, is told by Origin and Sec-Fetch-Site; one that has pointed its own name at
127.0.0.1 (DNS rebinding) is told by Host.

The key is in the address that the command prints, and in a cookie from then on. It stays the same from one start to the next, so that pages
left open, and links kept, go on working; it lies in a file that only its owner may read.
"""

from __future__ import annotations

import logging
import os
import secrets
import stat
import sys
from collections.abc import Collection
from contextlib import suppress
from http.cookies import CookieError, SimpleCookie
from pathlib import Path
from urllib.parse import parse_qs

from starlette.applications import Starlette
from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import HTMLResponse, JSONResponse, RedirectResponse, Response
from starlette.types import Message, Receive, Scope, Send

from coaxshell.apps.studio.refusals import RefusedError, internal

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
NAMES = ("127.0.0.1", "localhost", "[::1]")
"""What this machine is called by itself, and through a tunnel of SSH, whatever port the tunnel starts from."""
YEAR = 365 * 24 * 3600
LOCKED = (
    "<!doctype html><html lang=en><meta charset=utf-8><title>coaxshell studio</title>"
    "<h1>This studio needs its key</h1><p>Open the address that <code>coaxshell studio</code> has printed in its terminal, "
    "with the key at its end; this browser then keeps it."
)


class Guard:
    """Refuse what does not come from the page itself, add the security headers, and turn failures into answers.

    Parameters
    ----------
    app : Starlette
    port : int
        Where the server listens; the cookie is named after it.
    key : str
        What every request must carry: in the cookie, as ``Authorization: Bearer KEY``, or once as ``/?key=KEY``.
    names : collection of str
        What the header Host may be, without a port.
    """

    def __init__(self, app: Starlette, port: int, key: str, names: Collection[str] = NAMES) -> None:
        self.app, self.key, self.names = app, key, frozenset(name.lower() for name in names)
        self.cookie = f"coaxshell-{port}"

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
            answer = self.check(scope) or self.app
            await answer(scope, receive, sealed)
        except RefusedError as refused:
            if not started:
                await refused.response(scope, receive, sealed)
        except Exception:
            logging.getLogger(__name__).exception("a request failed")
            if not started:
                await JSONResponse(internal(scope["path"]), 500)(scope, receive, sealed)

    def check(self, scope: Scope) -> Response | None:
        """Return None if a request may go on, or what it is answered; RefusedError unless it is this page's own."""
        headers = Headers(scope=scope)
        host = headers.get("host", "").lower()
        name, colon, port = host.rpartition(":")
        if not colon or not port.isdigit():
            name = host
        if len(headers.getlist("host")) != 1 or name not in self.names:
            raise RefusedError(403, "forbidden", "Host", "is not this server's", "open the address that coaxshell studio has printed")
        remedy = f"open http://{host}/"
        if any(origin.lower() not in (f"http://{host}", f"https://{host}") for origin in headers.getlist("origin")):
            raise RefusedError(403, "forbidden", "Origin", "is another site", remedy)
        page = scope["path"] == "/" and scope["method"] in ("GET", "HEAD")
        followed = page and headers.get("sec-fetch-mode") == "navigate" and headers.get("sec-fetch-dest") == "document"
        if headers.get("sec-fetch-site", "none") not in FRIENDS and not followed:  # a link to the page may stand anywhere
            raise RefusedError(403, "forbidden", "Sec-Fetch-Site", "is another site", remedy)
        if page and (given := parse_qs(scope["query_string"].decode("latin-1")).get("key")):
            return self._entrance() if self._opens(given[0]) else HTMLResponse(LOCKED, 401)
        if self._opens(headers.get("authorization", "").removeprefix("Bearer ")) or self._opens(self._in_cookie(headers)):
            return None
        if page:
            return HTMLResponse(LOCKED, 401)
        raise RefusedError(401, "no-key", "key", "is missing or wrong", "open the address that coaxshell studio has printed")

    def _opens(self, given: str) -> bool:
        return secrets.compare_digest(given.encode(), self.key.encode())

    def _in_cookie(self, headers: Headers) -> str:
        try:
            held = SimpleCookie(headers.get("cookie", "")).get(self.cookie)
        except CookieError:
            return ""
        return "" if held is None else held.value

    def _entrance(self) -> Response:
        """Send a browser to the page without the key in its address, which others may see; what follows # stays."""
        answer = RedirectResponse("/", 303)
        # Lax: a link that is followed from another site shows the page. Requests that other sites make carry no cookie.
        answer.set_cookie(self.cookie, self.key, max_age=YEAR, httponly=True, samesite="lax", path="/")
        return answer


BYTES = 24


def key_file() -> Path:
    """Return where the key is kept: in the folder that the system has for what programs remember of one user."""
    if sys.platform == "win32":
        state = os.environ.get("LOCALAPPDATA", "")
    else:
        state = os.environ.get("XDG_STATE_HOME", "")
    return (Path(state) if os.path.isabs(state) else Path.home() / ".local" / "state") / "coaxshell" / "studio-key"


def kept_key() -> str:
    """Return the key, made and kept at the first call; one for this time only where it cannot be kept to its owner."""
    with suppress(OSError, RuntimeError, ValueError):  # no home, a full disk, a file of somebody else: the server starts all the same
        path = key_file()
        found = _read(path)
        if found is not None:
            return found
        path.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError):
            path.unlink()  # unreadable, or open to others: what it held is known to them
        made = secrets.token_urlsafe(BYTES)
        with os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="ascii") as file:
            file.write(made)
        return made
    return secrets.token_urlsafe(BYTES)


def _read(path: Path) -> str | None:
    """Return the key in a file that nobody else can read or write; None if there is none."""
    try:
        state = path.lstat()
    except FileNotFoundError:
        return None
    ours = sys.platform == "win32" or (state.st_uid == os.getuid() and not state.st_mode & 0o077)
    if not ours or not stat.S_ISREG(state.st_mode) or state.st_size > 200:
        return None
    text = path.read_text(encoding="ascii").strip()
    return text if len(text) >= BYTES and text.replace("-", "a").replace("_", "a").isalnum() else None
