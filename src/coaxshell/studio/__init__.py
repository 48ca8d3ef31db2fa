"""The page in the browser: a server on this machine only, its routes, and the files of the page."""

from __future__ import annotations

from coaxshell.studio.app import create_app
from coaxshell.studio.server import serve

__all__ = ["create_app", "serve"]
