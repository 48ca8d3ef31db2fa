"""An interruption that leaves something behind, and says what."""

from __future__ import annotations


class Interrupted(Exception):  # noqa: N818 - not an error: the user pressed Ctrl-C
    """Raised in place of KeyboardInterrupt by a command whose work so far is kept; its text says where and how to go on."""
