"""Which gains of a controller are those of which shell."""

from __future__ import annotations

from coaxshell.model.control import PDControl
from coaxshell.model.parts import SystemParts


def gains_of(system: SystemParts, shell: int) -> tuple[float, float]:
    """Return k_p and k_d of a shell under control, by its number; lists of gains are in the order in which shells were named."""
    control = system.control
    assert isinstance(control, PDControl)
    place = shell if control.shells == "all" else [system.shell_index(one) for one in control.shells].index(shell)
    proportional, derivative = (x[place] if isinstance(x, tuple) else x for x in (control.proportional, control.derivative))
    return proportional, derivative
