"""Names that have moved: the old ones work for one version more, with a warning that tells the new one."""

from __future__ import annotations

import warnings
from importlib import import_module
from typing import Any


def renamed(module: str, name: str, **now: str) -> Any:
    """Return what an old name of a module stands for; to be called by the module's ``__getattr__``.

    Parameters
    ----------
    module, name : str
        The module, and the name that was asked of it.
    **now : str
        The present dotted name of each old one.

    Raises
    ------
    AttributeError
        It is no old name either.
    """
    if name not in now:
        raise AttributeError(f"module {module!r} has no attribute {name!r}")
    warnings.warn(f"{module}.{name} is now {now[name]}", DeprecationWarning, stacklevel=3)
    home, _, found = now[name].rpartition(".")
    return getattr(import_module(home), found)
