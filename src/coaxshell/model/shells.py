"""The kinds of shell: a layered wall, or the rigid limit."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator

from coaxshell.errors import InputError
from coaxshell.model.base import Described, shown
from coaxshell.model.layers import Shell
from coaxshell.model.units import Length

__all__ = ["AnyShell", "RigidShell", "Shell", "as_shell"]


class RigidShell(Described):
    """Describe an immovable cylinder (W = 0): the limit of an infinitely stiff and heavy shell of no thickness."""

    radius: Length
    """Radius of the surface (m)."""
    rigid: Literal[True] = True
    """Marks the shell as rigid in a file."""

    @property
    def thickness(self) -> float:
        """No thickness (m)."""
        return 0.0

    @property
    def inner_radius(self) -> float:
        """The radius itself (m)."""
        return self.radius

    @property
    def outer_radius(self) -> float:
        """The radius itself (m)."""
        return self.radius

    @property
    def wetted_radii(self) -> tuple[float, float]:
        """The radius itself, on both sides (m)."""
        return self.radius, self.radius


def as_shell(value: Any) -> Shell | RigidShell:
    """Return a shell from an instance or a mapping; ``rigid = true`` makes it a rigid one."""
    if isinstance(value, Shell | RigidShell):
        return value
    if isinstance(value, Mapping):
        data = dict(value)
        if data.get("rigid") is True:
            return RigidShell.model_validate(data)
        if data.get("rigid") is False:
            del data["rigid"]
        return Shell.model_validate(data)
    raise InputError("", f"{shown(value)} is not a shell", "give a Shell or a RigidShell")


AnyShell = Annotated[Shell | RigidShell, BeforeValidator(as_shell)]
