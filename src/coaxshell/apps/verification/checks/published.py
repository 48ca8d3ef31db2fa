"""Published values of single ingredients: cavity resonances and added masses."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.optimize import brentq

from coaxshell.acoustics.operators import annulus
from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Finding, close
from coaxshell.numerics.radial_functions import RadialFunctions

ZEROS = {(0, 1): 3.83170597, (1, 1): 1.84118378, (1, 2): 5.33144277, (2, 1): 3.05423693, (2, 2): 6.70613319, (3, 1): 4.20118894}
"""(m, n): the n-th positive zero of J_m' (Abramowitz and Stegun, Table 9.5; the zero of J_0' at 0 not counted)."""

TABLE = "Abramowitz & Stegun, Table 9.5"
LAMB = "Lamb, Hydrodynamics, art. 68"
FRITZ = "Fritz 1972 (J. Eng. Industry 94), annulus"
STILL = np.array([1e-6 + 0j])


@check("published", "Published values of single ingredients")
def published(bench: Bench) -> Iterator[Finding]:
    """Compare resonances of a rigid-walled disc of fluid and added masses of still fluid with published values.

    No published time history of a shell comes with numbers that could be cited; the paper and its sources show figures only.
    """
    for (m, n), expected in ZEROS.items():
        found = brentq(lambda omega, m=m: _stiffness(omega, m), 0.99 * expected, 1.01 * expected, xtol=1e-12)
        yield close(f"resonance ({m}, {n}) of a rigid-walled disc, omega r/c", TABLE, expected, float(found), 2e-9)
    for m in (1, 2, 3):
        outside = RadialFunctions(STILL, 1.0, np.array([float(m)])).exterior[0, 0].real
        yield close(f"added mass outside a cylinder, order {m}, over the displaced fluid's", LAMB, 1 / m, -float(outside), 1e-8)
    ra, rb = 0.5, 1.0
    square = rb**2 - ra**2
    inner, outer = (RadialFunctions(STILL, r, np.array([1.0])) for r in (ra, rb))
    gap = annulus(inner, outer)
    masses = {"aa": (rb**2 + ra**2) / square, "bb": (rb**2 + ra**2) / square, "ab": 2 * rb**2 / square}
    operators = {"aa": -gap.aa / ra, "bb": gap.bb / rb, "ab": gap.ab / ra}
    for name, what in (("aa", "of the inner cylinder"), ("bb", "of the outer cylinder"), ("ab", "shared")):
        mass = float(abs(operators[name][0, 0].real))
        yield close(f"added mass in an annulus, rb = 2 ra, {what}, over the displaced fluid's", FRITZ, masses[name], mass, 1e-8)


def _stiffness(omega: float, m: int) -> float:
    """Return I'(s)/I(s) s at s = i omega: real there, zero at the resonances."""
    radial = RadialFunctions(np.array([1e-12 + 1j * omega]), 1.0, np.array([float(m)]))
    return float((1.0 / radial.disc[0, 0]).real)
