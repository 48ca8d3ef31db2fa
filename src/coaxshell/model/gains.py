"""Which law and which gains are those of which shell."""

from __future__ import annotations

from coaxshell.model.control import PDControl
from coaxshell.model.feedback import Feedback
from coaxshell.model.parts import SystemParts, laws_of, shells_under


def law_of(system: SystemParts, shell: int) -> PDControl | Feedback | None:
    """Return the control law of a shell, by its number; None where there is none."""
    return next((law for law in laws_of(system) if shell in shells_under(system, law)), None)


def saturates(system: SystemParts) -> bool:
    """Return whether the voltage of any actuator stops at its limit."""
    return any(law.saturation for law in laws_of(system))


def limits_voltages(system: SystemParts) -> bool:
    """Return whether voltages stop at a limit that are marched beside the linear answer: of electrodes, and of laws other than PD."""
    return any(law.saturation and (law.transducers == "electrodes" or isinstance(law, Feedback)) for law in laws_of(system))


def segments_of(system: SystemParts) -> int | None:
    """Return into how many segments the electrodes around each wall under control are cut; None where they are not."""
    return next((law.segments for law in laws_of(system) if law.segments is not None), None)


def gains_of(system: SystemParts, shell: int) -> tuple[float, float]:
    """Return k_p and k_d of a shell under control, by its number; lists of gains are in the order in which shells were named."""
    control = law_of(system, shell)
    assert isinstance(control, PDControl)
    place = shell if control.shells == "all" else [system.shell_index(one) for one in control.shells].index(shell)
    proportional, derivative = (x[place] if isinstance(x, tuple) else x for x in (control.proportional, control.derivative))
    return proportional, derivative
