"""Which code and which environment numbers come from: what was computed under another is not taken for ours."""

from __future__ import annotations

import hashlib
import platform
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from coaxshell._version import __version__

NUMERICS_VERSION = 16
"""Raised whenever a change alters the numbers that a run gives, so that kept results of another version are told from ours."""

NUMERICAL = ("errors.py", "limits.py", "numerics", "model", "structure", "acoustics", "solver", "response", "studies")
"""Parts of the package from which numbers come, but for the paper's."""

LIBRARIES = ("numpy", "scipy")
"""What the last digits of numbers depend on beside our own code."""


def numerics() -> str:
    """Return the version of the numerics, for a person."""
    return f"{__version__}, numerics {NUMERICS_VERSION}"


def origin(*further: str) -> str:
    """Return all that kept numbers depend on beside what they are of, in words: version, code (*further* parts too), key libraries."""
    return f"{numerics()}, code {package_digest(*further)}, {libraries()}"


@cache
def package_digest(*further: str) -> str:
    """Return a digest of the source files that numbers come from, and of *further* parts of the package, as they are at the first call."""
    root = Path(__file__).parents[1]
    digest = hashlib.sha256()
    for name in (*NUMERICAL, *further):
        place = root / name
        if not place.exists():
            raise FileNotFoundError(place)
        for path in sorted(place.rglob("*")) if place.is_dir() else [place]:
            if path.suffix in (".py", ".toml"):
                digest.update(path.relative_to(root).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


@cache
def environment() -> str:
    """Return in words what the numbers of this process depend on: version and code of coaxshell, Python, and the key libraries."""
    return f"coaxshell {__version__} (code {package_digest()}), Python {platform.python_version()}, {libraries()}"


@cache
def libraries() -> str:
    """Return names and versions of the key libraries, as installed."""
    found = []
    for name in LIBRARIES:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            found.append(f"{name} of unknown version")
    return ", ".join(found)


def difference(theirs: str, ours: str) -> str:
    """Return in words what differs between two environments: ``numpy 1.26.4 there, numpy 2.0.1 here``."""
    pairs = [(one, two) for one, two in zip(theirs.split(", "), ours.split(", "), strict=False) if one != two]
    return "; ".join(f"{one} there, {two} here" for one, two in pairs) or f"{theirs} there, {ours} here"
