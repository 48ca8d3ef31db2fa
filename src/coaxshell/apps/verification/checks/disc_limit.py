"""An annulus whose hole closes is a disc."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.acoustics.operators import all_orders, annulus
from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, at_least, orders, within
from coaxshell.numerics.radial_functions import RadialFunctions

HOLES = np.array([1e-1, 1e-2, 1e-3, 1e-4])
NODES = np.asarray(0.5 + 1j * np.linspace(0.0, 20.0, 81), dtype=np.complex128)


@check("disc-limit", "An annulus with a vanishing hole is a disc")
def disc_limit(bench: Bench) -> Iterator[Finding]:
    """Compare the wall operator of an annulus with that of the disc as the inner radius goes to zero, orders 0 to 40, Re s = 0.5.

    The paper uses this limit for its filled single shell (its model verification).
    """
    errors = []
    outer = RadialFunctions(NODES, 1.0, all_orders(40))
    for hole in HOLES:
        found = annulus(RadialFunctions(NODES, float(hole), all_orders(40)), outer).bb
        errors.append(float((abs(found - outer.disc) / abs(outer.disc).max(axis=0)).max()))
    source = "theory 10; closed form I_m/(s I_m')"
    limit = float(np.abs(NODES).max() * HOLES[-1]) ** 2  # what a hole changes is of the order of |s r_a|^2
    yield within("wall operator, hole of 1e-4 of the radius", source, "the disc's", errors[-1], limit, measure="relative, largest")
    yield at_least("order in the size of the hole (its area)", "theory 3", 1.9, float(orders(errors, 10.0)[-1]))
    yield Sheet(
        "Annulus to disc",
        "Largest error of the wall operator over orders 0 to 40 and 81 Laplace nodes.",
        [Panel("", "hole / radius", "relative error", [Curve("annulus against disc", HOLES, np.array(errors))], logarithmic=True)],
    )
