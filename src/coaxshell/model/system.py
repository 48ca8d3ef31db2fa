"""The whole system: its parts validated together, changed, shown, read and written."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self

from pydantic import model_validator

from coaxshell.model import consistency, overrides, toml
from coaxshell.model.parts import SystemParts
from coaxshell.numerics.files import write_text


class System(SystemParts):
    """Describe concentric shells in fluids, what strikes them, and what is fitted to protect them.

    Shells and fluids are listed from the inside out: fluid, shell, fluid, shell, ..., exterior fluid.
    """

    @model_validator(mode="after")
    def _whole(self) -> Self:
        consistency.check(self)
        return self

    def __repr__(self) -> str:
        from coaxshell.model.display import system_line

        return system_line(self)

    __str__ = __repr__

    def _repr_html_(self) -> str:
        from coaxshell.model.display import system_card

        return system_card(self)

    def with_overrides(self, changes: Mapping[str, Any]) -> Self:
        """Return a copy with fields changed by dotted path, all at once: ``{"source.peak_pressure": "30 kPa"}``.

        ``shells[0].radius``, ``shells.0.radius``, ``shells.inner.radius``, ``absorbers.count`` and
        ``materials.aluminium.density`` (every layer of that material) are such paths. InputError lists what is allowed.
        """
        return overrides.apply(self, changes)

    def replace_path(self, path: str, value: Any) -> Self:
        """Return a copy with the one field at *path* changed."""
        return self.with_overrides({path: value})

    def canonical(self) -> dict[str, Any]:
        """Return the physics as plain data, numbers in SI and without names or references: what a hash should cover."""
        return toml.canonical(self)

    def to_toml_string(self) -> str:
        """Return the system as TOML text; :meth:`from_toml_string` gives back an equal system."""
        return toml.dumps(self)

    def to_toml(self, path: str | Path) -> Path:
        """Write the system to a TOML file, whole or not at all, and return its path; InputError if it cannot be written.

        A record of more than a thousand samples goes to a CSV file beside it, named in the TOML with its checksum.
        """
        write_text(path, toml.dumps(self, beside=Path(path)))
        return Path(path)

    @classmethod
    def from_toml_string(cls, text: str, folder: str | Path | None = None) -> Self:
        """Read a system from TOML text; file names in it are relative to *folder*. InputError gives the full path."""
        return cls.model_validate(toml.loads(text, None if folder is None else Path(folder)))

    @classmethod
    def from_toml(cls, path: str | Path) -> Self:
        """Read a system from a TOML file; InputError gives the full path of what is wrong, or the file if it is no TOML."""
        return cls.model_validate(toml.loads(toml.read(Path(path)), Path(path).parent, str(path)))
