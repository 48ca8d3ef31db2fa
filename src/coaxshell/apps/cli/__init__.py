"""The command line. Importing it, and asking it for help, imports nothing that takes long."""

from __future__ import annotations

from coaxshell.apps.cli.entry import main

__all__ = ["main"]
