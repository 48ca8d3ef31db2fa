"""A system in one line."""

from __future__ import annotations

from typing import TYPE_CHECKING

from coaxshell.model.fluids import Fluid
from coaxshell.model.prefixes import engineering

if TYPE_CHECKING:
    from coaxshell.model.system import System


def system_line(system: System) -> str:
    """Return name, shells with their radii, fluids, sources, absorbers and control in one line."""
    radii = ", ".join(engineering(shell.radius, "m") for shell in system.shells)
    count = len(system.shells)
    fluids = " | ".join((fluid.name or "a fluid") if isinstance(fluid, Fluid) else "vacuum" for fluid in system.fluids)
    sources = ", ".join(f"{source.type} of {engineering(source.pulse.peak, 'Pa')}" for source in system.sources)
    parts = [f"{count} shell{'s' * (count != 1)} ({radii})", f"fluids {fluids}", sources]
    if system.absorber_list:
        parts.append(f"{len(system.absorber_list)} absorbers")
    if system.control is not None:
        parts.append("saturating control" if system.control.saturation else "control")
    name = f"{system.name!r}, " if system.name else ""
    return f"<System: {name}{'; '.join(parts)}>"
