"""The checks, one subject a file; importing a file registers its checks."""

from __future__ import annotations

from importlib import import_module

from coaxshell.apps.verification.registry import REGISTERED, Check
from coaxshell.errors import InputError

ORDER = (
    "reference",
    "single_values",
    "paper_limits",
    "independent",
    "axial_wavenumbers",
    "axial_limits",
    "spherical_reference",
    "independent_stations",
    "stations",
    "exact_walls",
    "inclined_waves",
    "engines",
    "energy",
    "time_step",
    "orders",
    "transparency",
    "rigid",
    "sea",
    "form_function",
    "translation",
    "statics",
    "rings",
    "causality",
    "disc_limit",
    "published",
    "published_frequencies",
)
"""Files in the order of the report."""


def checks() -> tuple[Check, ...]:
    """Return all checks in the order of the report."""
    for name in ORDER:
        import_module(f"coaxshell.apps.verification.checks.{name}")
    ours = [one for one in REGISTERED.values() if one.work.__module__.startswith("coaxshell.apps.verification.checks.")]
    return tuple(sorted(ours, key=lambda one: ORDER.index(one.work.__module__.rpartition(".")[2])))


def chosen(names: list[str] | None, quick: bool) -> tuple[Check, ...]:
    """Return the checks of those names, or the whole suite, or its quick part; InputError for a name that is not there."""
    known = {one.name: one for one in checks()}
    if names:
        for name in names:
            if name not in known:
                raise InputError("--only", f"there is no check {name!r}", f"allowed: {', '.join(known)}")
        return tuple(known[name] for name in known if name in names)
    return tuple(one for one in known.values() if one.quick or not quick)
