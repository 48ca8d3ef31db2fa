"""The slips of the paper's printed equations as switches: what each would do, computed. The solver itself has none of them."""

from __future__ import annotations

from coaxshell.paper.slips.catalogue import SLIPS, Slip
from coaxshell.paper.slips.solving import CORRECTED, simulate, solve_each
from coaxshell.paper.slips.switches import SWITCHED

__all__ = ["CORRECTED", "SLIPS", "SWITCHED", "Slip", "simulate", "solve_each"]
