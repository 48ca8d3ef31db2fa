"""How long computations tell where they are: the share done, from 0 to 1, with or without what is being done."""

from __future__ import annotations

from collections.abc import Callable

Progress = Callable[[float, str], None]
ShareDone = Callable[[float], None]
