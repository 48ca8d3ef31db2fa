"""Turn slips on in a dimensionless problem: each switch changes one formula or one constant, and switches add up."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from types import MappingProxyType

from coaxshell.apps.paper.slips import fluids, point_forces, shells, waves
from coaxshell.apps.paper.slips.catalogue import SLIPS
from coaxshell.errors import InputError
from coaxshell.model import Piezoelectric, Shell, System
from coaxshell.solver.scaling import Problem, dimensionless


def with_permittivity(system: System, reduction: str) -> System:
    """Return a system all of whose piezoelectric materials use a reduction of mu33, "printed" or "standard" (Eq. A.11)."""
    names = {
        layer.material.name
        for shell in system.shells
        if isinstance(shell, Shell)
        for layer in shell.layers
        if isinstance(layer.material, Piezoelectric)
    }
    return system.with_overrides({f"materials.{name}.permittivity_reduction": reduction for name in names}) if names else system


def _printed_permittivity(problem: Problem) -> Problem:
    return dimensionless(with_permittivity(problem.system, "printed"))


_SWITCHES: Mapping[str, Callable[[Problem], Problem]] = MappingProxyType(
    {
        "permittivity": _printed_permittivity,
        "control-sign": shells.control_sign,
        "doubled-curvature": shells.doubled_curvature,
        "printed-strain": shells.printed_strain,
        "radius-factor": fluids.radius_factor,
        "interior-derivative": fluids.interior_derivative,
        "interior-function": fluids.interior_function,
        "radiation-sign": fluids.radiation_sign,
        "incident-potential": partial(waves.printed_potential, impulse=False),
        "incident-potential-impulse": partial(waves.printed_potential, impulse=True),
        "diffraction-sign": waves.reversed_diffraction,
        "outside-sum": partial(point_forces.outside_sum, which=-1),
        "outside-sum-first": partial(point_forces.outside_sum, which=0),
        "missing-projection": point_forces.missing_projection,
        "cosine-only": point_forces.cosine_only,
    }
)

SWITCHED = frozenset(_SWITCHES)
"""Keys of the slips that a run can be made with."""


def slipped(system: System, slips: Iterable[str]) -> Problem:
    """Return the dimensionless problem of a system with some slips turned on.

    Parameters
    ----------
    system : System
        Two elastic shells and three fluids: the printed equations know no others.
    slips : iterable of str
        Keys of :data:`SWITCHED`.

    Raises
    ------
    InputError
        If a slip is not known or has no switch, or if the system is not the paper's kind.
    """
    wanted = frozenset(slips)
    for key in sorted(wanted - SWITCHED):
        what = "has no switch" if key in SLIPS else "is not known"
        raise InputError("slips", f"{key!r} {what}", f"use {', '.join(sorted(SWITCHED))}")
    problem = dimensionless(system)
    if wanted and (len(problem.shells) != 2 or None in problem.fluids or not all(wall.moves for wall in problem.shells)):
        raise InputError("slips", "the system is not two elastic shells in three fluids", "use one that is, such as the preset 'bare'")
    for key, switch in _SWITCHES.items():
        if key in wanted:
            problem = switch(problem)
    return problem
