"""Which law and which gains are those of which shell."""

from __future__ import annotations

from coaxshell.model.control import PDControl
from coaxshell.model.feedback import Feedback
from coaxshell.model.parts import SystemParts, laws_of, shells_under


def law_of(system: SystemParts, shell: int) -> PDControl | Feedback | None:
    """Return the control law of a shell, by its number; None where there is none."""
    return next((law for law in laws_of(system) if shell in shells_under(system, law)), None)


def saturates(system: SystemParts) -> bool:
    """Return whether the voltage or the current of any actuator stops at its limit."""
    return any(law.saturation or law.current_saturation for law in laws_of(system))


def limits_currents(system: SystemParts) -> bool:
    """Return whether the current of any actuator stops at its limit."""
    return any(law.current_saturation for law in laws_of(system))


def limits_voltages(system: SystemParts) -> bool:
    """Return whether a march runs beside the linear answer: currents at their limit, or voltages of electrodes, of laws but PD.

    Those of any law where walls are elastic solids.
    """
    solid = any(getattr(shell, "theory", "") == "elastic" for shell in system.shells)
    marched = (law.saturation and (solid or law.transducers == "electrodes" or isinstance(law, Feedback)) for law in laws_of(system))
    return limits_currents(system) or any(marched)


def segments_of(system: SystemParts) -> int | None:
    """Return into how many segments the electrodes around each wall under control are cut; None where they are not."""
    return next((law.segments for law in laws_of(system) if law.segments is not None), None)


def pitch_of(system: SystemParts) -> float | None:
    """Return how far electrodes that are cut along the axis are from middle to middle, m; None where they are not."""
    return next((law.segment_pitch for law in laws_of(system) if law.segment_pitch is not None), None)


def ties_shells(system: SystemParts) -> bool:
    """Return whether the sensors of one shell drive another one's actuators."""
    return any(isinstance(law, Feedback) and law.matrix is not None for law in laws_of(system))


def reads_of(system: SystemParts, shell: int) -> dict[int, float] | None:
    """Return by how much a shell's actuators count the reading of each shell, by number; None if they know their own alone."""
    law = law_of(system, shell)
    if not isinstance(law, Feedback) or law.matrix is None:
        return None
    named = _in_order(system, law)
    return dict(zip(named, law.matrix[named.index(shell)], strict=True))


def wired(system: SystemParts, shell: int, role: str) -> bool:
    """Return whether the law of a shell asks for its layers of a role, "sensor" or "actuator": unless its matrix leaves them out."""
    law = law_of(system, shell)
    if not isinstance(law, Feedback) or law.matrix is None:
        return law is not None
    place = _in_order(system, law).index(shell)
    return any(law.matrix[place] if role == "actuator" else (row[place] for row in law.matrix))


def _in_order(system: SystemParts, law: PDControl | Feedback) -> list[int]:
    """Return the shells of a law by number, in the order in which they were named."""
    return list(range(len(system.shells))) if law.shells == "all" else [system.shell_index(one) for one in law.shells]


def gains_of(system: SystemParts, shell: int) -> tuple[float, float]:
    """Return k_p and k_d of a shell under control, by its number; lists of gains are in the order in which shells were named."""
    control = law_of(system, shell)
    assert isinstance(control, PDControl)
    place = _in_order(system, control).index(shell)
    proportional, derivative = (x[place] if isinstance(x, tuple) else x for x in (control.proportional, control.derivative))
    return proportional, derivative
