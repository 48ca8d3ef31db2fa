"""Finished work in a folder: one file a piece, named by what it is of; whole or absent, safe to interrupt at any moment."""

from __future__ import annotations

import hashlib
import json
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.files import replacing
from coaxshell.numerics.identity import libraries, package_digest

Array = npt.NDArray[Any]

_FURTHER = ("paper/observed.py", "paper/fields.py", "paper/slips")
"""What the numbers in the store come from beside the solver and all that it builds on."""


def numerics_version() -> str:
    """Return a digest of the source files that the numbers come from, and the key libraries: what other code stored is not taken up."""
    return f"{package_digest(*_FURTHER)}, {libraries()}"


def key_of(*parts: object) -> str:
    """Return the name of a piece: a digest of what it is of and of the numerics version."""
    text = json.dumps([numerics_version(), *parts], sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:32]


class Store:
    """Pieces of finished work: arrays by name, and a dict of plain values.

    Parameters
    ----------
    folder : Path
        Made if need be.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)

    def get(self, key: str) -> tuple[dict[str, Array], dict[str, Any]] | None:
        """Return the arrays and the values of a piece, or None if it is not there or cannot be read."""
        try:
            with self._path(key).open("rb") as file, np.load(file) as stored:
                arrays = {name: stored[name] for name in stored.files if name != "values"}
                return arrays, json.loads(str(stored["values"]))
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
            return None

    def put(self, key: str, arrays: Mapping[str, Array], values: Mapping[str, Any]) -> None:
        """Keep a piece; the file appears under its name only when it is whole."""
        with replacing(self._path(key)) as partial:
            np.savez(partial, allow_pickle=False, values=np.array(json.dumps(values)), **arrays)

    def __contains__(self, key: str) -> bool:
        return self._path(key).is_file()

    def _path(self, key: str) -> Path:
        return self.folder / f"{key}.npz"
