"""The slips of the paper's printed equations as switches: what each would do, computed. The solver itself has none of them."""

from __future__ import annotations

from coaxshell.apps.paper.slips.catalogue import SLIPS, Slip
from coaxshell.apps.paper.slips.effects import CASES, STUDIES, Effect, Stresses, effects, table
from coaxshell.apps.paper.slips.growth import Growth, growth
from coaxshell.apps.paper.slips.scattering import scattering_delay
from coaxshell.apps.paper.slips.solving import CORRECTED, simulate, solve_each
from coaxshell.apps.paper.slips.switches import SWITCHED

__all__ = [
    "CASES",
    "CORRECTED",
    "SLIPS",
    "STUDIES",
    "SWITCHED",
    "Effect",
    "Growth",
    "Slip",
    "Stresses",
    "effects",
    "growth",
    "scattering_delay",
    "simulate",
    "solve_each",
    "table",
]
