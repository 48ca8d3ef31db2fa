"""The licences of everything that an installation brings, read from the installed packages' own metadata."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib.metadata import Distribution, PackageNotFoundError, distribution

from packaging.requirements import Requirement

ALLOWED = {
    "0BSD", "Apache-2.0", "BSD", "BSD-2-Clause", "BSD-3-Clause", "HPND", "ISC", "MIT", "MIT-CMU", "MPL-2.0", "PSF-2.0", "Python-2.0",
    "Unlicense", "Zlib", "CC0-1.0",
}  # fmt: skip
"""Licences that a BSD-3-Clause package may depend on without passing any duty on to its users' own code."""

# Texts that packages still write where an SPDX expression belongs.
SPELLINGS = {
    "MIT License": "MIT",
    "BSD License": "BSD",
    "Apache Software License": "Apache-2.0",
    "Apache License 2.0": "Apache-2.0",
    "Apache 2.0": "Apache-2.0",
    "Apache-2.0": "Apache-2.0",
    "BSD 3-Clause License": "BSD-3-Clause",
    "BSD-3-Clause License": "BSD-3-Clause",
    "BSD-2-Clause License": "BSD-2-Clause",
    "BSD 2-Clause": "BSD-2-Clause",
    "Python Software Foundation License": "PSF-2.0",
    "PSF": "PSF-2.0",
    "Mozilla Public License 2.0 (MPL 2.0)": "MPL-2.0",
    "ISC License (ISCL)": "ISC",
}


def licence(found: Distribution) -> str:
    """Return a package's licence as an SPDX expression where its metadata lets us tell, else what it says in one line."""
    stated = _field(found, "License-Expression")
    if stated:
        return stated
    classifiers = [line.rsplit(" :: ", 1)[-1] for line in found.metadata.get_all("Classifier") or () if line.startswith("License ::")]
    named = [SPELLINGS.get(name, name) for name in classifiers if name != "OSI Approved"]
    whole = _field(found, "License")
    field = ["MIT"] if "Permission is hereby granted, free of charge" in whole else whole.strip().splitlines()  # its whole text
    text = SPELLINGS.get(field[0].strip(), field[0].strip()) if field else ""
    if text in ALLOWED or not named:
        return text or "not stated"
    return " AND ".join(sorted(set(named)))


def _field(found: Distribution, name: str) -> str:
    return str((found.metadata.get_all(name) or [""])[0])


def parts(expression: str) -> set[str]:
    """Return the licence names in an SPDX expression, of which all must be allowed; exceptions after WITH only add freedom."""
    plain = re.sub(r"\s+WITH\s+\S+", "", expression)
    return {name.strip("() ") for name in re.split(r"\s+(?:AND|OR)\s+|;", plain)}


def dependencies(name: str, extra: str = "", seen: set[str] | None = None) -> Iterator[Distribution]:
    """Yield the installed distributions that a package with an extra brings, each once and however deep."""
    seen = set() if seen is None else seen
    for text in distribution(name).requires or ():
        wanted = Requirement(text)
        if wanted.marker is not None and not wanted.marker.evaluate({"extra": extra}):
            continue
        key = re.sub(r"[-_.]+", "-", wanted.name).lower()
        for asked in wanted.extras or ("",):
            if f"{key}[{asked}]" in seen:
                continue
            new = not any(one.startswith(f"{key}[") for one in seen)
            seen.add(f"{key}[{asked}]")
            try:
                found = distribution(key)
            except PackageNotFoundError:
                continue
            if new and key != "coaxshell":
                yield found
            yield from dependencies(key, asked, seen)


def extras() -> dict[str, list[Distribution]]:
    """Return the distributions of the core (under "") and those that each extra adds to it."""
    core = list(dependencies("coaxshell"))
    names = {one.metadata["Name"] for one in core}
    stated = distribution("coaxshell").metadata.get_all("Provides-Extra") or ()
    added = {extra: [one for one in dependencies("coaxshell", extra) if one.metadata["Name"] not in names] for extra in stated}
    return {"": core, **added}


def licence_table() -> str:
    """Return the page as Markdown."""
    text = [
        "# Licences of what is installed",
        "coaxshell itself is under the BSD-3-Clause licence. This page is written at every build from the metadata of the packages "
        "installed there; an extra that is not installed is not listed. A test refuses a core dependency whose licence is not on a "
        "list of permissive and weak-copyleft ones: " + ", ".join(sorted(ALLOWED)) + ".",
        "The studio's page brings plotly.js itself, under the MIT licence, which lies beside it.",
    ]
    for extra, found in extras().items():
        if found:
            text.append(f"## {'Core' if not extra else f'Extra `{extra}`'}")
            rows = [f"| {one.metadata['Name']} | {one.version} | {licence(one)} |" for one in sorted(found, key=_name)]
            text.append("\n".join(["| package | version | licence |", "|---|---|---|", *rows]))
    return "\n\n".join(text) + "\n"


def _name(one: Distribution) -> str:
    return str(one.metadata["Name"]).lower()
