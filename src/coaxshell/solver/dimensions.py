"""What two dimensions, and their direct engine, can solve; whatever solves so asks here first."""

from __future__ import annotations

from coaxshell.errors import InputError
from coaxshell.model.absorbers import linked_shells
from coaxshell.model.feedback import Feedback
from coaxshell.model.gains import limits_currents, pitch_of, segments_of, ties_shells
from coaxshell.model.layers import Shell
from coaxshell.model.parts import laws_of
from coaxshell.model.shells import RigidShell
from coaxshell.model.sources import OFF_THE_PLANE
from coaxshell.model.system import System
from coaxshell.solver.settings import Settings

_WORDS = {"z": "{:g} m is off the plane", "inclination": "{:g} degrees lead out of the plane"}


def require_two_dimensions(system: System, settings: Settings) -> None:
    """Raise InputError if a run asks for three dimensions where only two can be had, or its sources for more than two."""
    if settings.dimensions == 3:
        raise InputError("dimensions", "3 is solved by single runs only", "use dimensions=2, or simulate each system")
    if system.point_absorbers:
        raise InputError("absorbers", "a point absorber is held at one point of the axis", "use dimensions=3, or absorbers without z")
    for number, source in enumerate(system.sources):
        where = f"source[{number}]" if isinstance(system.source, tuple) else "source"
        for name in OFF_THE_PLANE:
            value = getattr(source, name, 0.0)
            if value != 0.0:
                problem = f"{_WORDS[name].format(value)} of a run in two dimensions"
                raise InputError(f"{where}.{name}", problem, f"use dimensions=3, or {name} = 0")


def require_sources_alone(system: System, dimensions: int) -> None:
    """Raise InputError if a system has electrodes or elastic walls under what is not known of them."""
    _require_ties(system, dimensions)
    _require_belts(system, dimensions)


def limits_left_out(system: System) -> tuple[str, str] | None:
    """Return why amplifiers cannot stop at a limit in three dimensions, and what would let them; None if they can."""
    if system.absorber_list or system.point_absorbers:
        what = "currents" if limits_currents(system) else "voltages"
        return f"beside absorbers {what} are cut at their limit in two dimensions alone", "no absorbers"
    if pitch_of(system) is not None:
        return "electrodes that are cut along the axis are not known to stop at a limit", "leave segment_pitch out"
    if any(getattr(source, "inclination", 0.0) for source in system.sources):
        return "is not solved under a wave that runs along the axis", "inclination = 0"
    return None


def require_loops_alone(system: System, what: str, remedy: str) -> None:
    """Raise InputError if feedback ties orders or shells to each other, which *what* does not know; "{}" in the remedy is left out."""
    cut = segments_of(system)
    if cut is not None:
        problem = f"{cut} segments tie orders to each other, which {what} does not know yet"
        raise InputError("control.segments", problem, remedy.format("segments"))
    if ties_shells(system):
        problem = f"the sensors of one shell drive another, which {what} does not know yet"
        raise InputError("control.matrix", problem, remedy.format("matrix"))
    pitch = pitch_of(system)
    if pitch is not None:
        problem = f"electrodes {pitch:g} m apart along the axis tie wavenumbers to each other, which {what} does not know yet"
        raise InputError("control.segment_pitch", problem, remedy.format("segment_pitch"))


def _require_ties(system: System, dimensions: int) -> None:
    """Raise InputError if feedback ties orders or shells to each other where that is not solved yet."""
    cut = segments_of(system)
    marched = any(one.cubic_stiffness != 0.0 or one.law is not None for one in system.absorber_list)
    if dimensions == 3 and cut is not None and marched:
        problem = f"{cut} segments tie orders to each other, which the march of line absorbers along the axis does not know yet"
        remedy = "use linear springs, point absorbers in rows (z=[...] of absorber_ring), dimensions=2, or leave segments out"
        raise InputError("control.segments", problem, remedy)


def _require_belts(system: System, dimensions: int) -> None:
    """Raise InputError if electrodes are cut along the axis where that is not solved: in the plane, or under waves that run along it."""
    pitch = pitch_of(system)
    if pitch is None:
        return
    where, told = "control.segment_pitch", f"{pitch:g} m: electrodes are cut along the axis, "
    if dimensions == 2:
        remedy = "use dimensions=3, or leave segment_pitch and segment_length out"
        raise InputError(where, f"{told}and a plane run is alike all along it", remedy)
    if system.absorber_list or system.point_absorbers:
        raise InputError(where, f"{told}which beside absorbers is not solved", "leave the absorbers out, or segment_pitch")
    if any(getattr(source, "inclination", 0.0) for source in system.sources):
        remedy = "use inclination = 0, a spherical source far away, or leave segment_pitch out"
        raise InputError(where, f"{told}which under a wave that runs along it is not solved", remedy)


def require_cubic_springs(system: System, what: str, remedy: str) -> None:
    """Raise InputError if absorbers have more than two links of dampers, linear and cubic springs, all that *what* knows."""
    for number, one in enumerate(system.absorber_list):
        where = f"absorbers[{number}]" if isinstance(system.absorbers, tuple) else "absorbers"
        core = any(isinstance(system.shells[i], RigidShell) for i in linked_shells(one) if i < len(system.shells))
        besides = {"law": one.law is not None, "inertance": one.inertance != 0.0, "links": one.links != "both", "inner_shell": core}
        for name, given in besides.items():
            if given:
                problem = f"is not known to {what}, which knows absorbers of two dampers, linear and cubic springs"
                raise InputError(f"{where}.{name}", problem, remedy)


def require_mid_surfaces(system: System) -> None:
    """Raise InputError if the fluids wet the true faces of a wall, whose loads the direct engine does not know, or of other feedback."""
    require_loops_alone(system, "the direct engine", 'use engine="spectral"')
    if any(isinstance(law, Feedback) for law in laws_of(system)):
        raise InputError("control", "Feedback is not known to the direct engine, which steps PDControl", 'use engine="spectral"')
    if any(law.transducers == "electrodes" for law in laws_of(system)):
        problem = "'electrodes' push along the wall too, and the direct engine knows the paper's pressure alone"
        raise InputError("control.transducers", problem, 'use engine="spectral", or transducers = "paper"')
    for number, shell in enumerate(system.shells):
        if isinstance(shell, Shell) and shell.theory == "elastic":
            problem = "'elastic' is not known to the direct engine, which steps thin walls"
            raise InputError(f"shells[{number}].theory", problem, 'use engine="spectral", or theory = "thin"')
        if len(set(shell.wetted_radii)) == 2:
            problem = "'faces' is not known to the direct engine, the paper's scheme at the mid-surfaces"
            raise InputError(f"shells[{number}].wetted", problem, 'use engine="spectral", or wetted = "mid-surface"')
