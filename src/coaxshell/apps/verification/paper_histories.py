"""What the three checks of the paper's Fig. 2 share: extrema of a history, and curves at head and tail."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from coaxshell.apps.verification.rows import Curve, Finding, close
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.response import Response

SIDES = {"head": 0.0, "tail": 180.0}
COLOURS = {"head": "blue", "tail": "orange"}


def history(response: Response, quantity: str, shell: str, side: str) -> FloatArray:
    """Return one history in SI, shape (T,)."""
    return np.asarray(getattr(response, quantity)(shell, [SIDES[side]]))[:, 0]


def least_stress(
    response: Response, shell: str, side: str, what: str, source: str, stored: Sequence[float], rtol: float
) -> Iterator[Finding]:
    """Yield value (MPa) and time of the least stress against a stored pair (time, value) of four digits."""
    stress = history(response, "stress", shell, side) / 1e6
    at = int(stress.argmin())
    yield close(f"{what}: least stress", source, stored[1], float(stress[at]), rtol, unit="MPa")
    yield close(f"{what}: time of the least stress", source, stored[0], float(response.time[at]), 1.5e-3, unit="a/c", measure="absolute")


def both_sides(response: Response, quantity: str, shell: str, scale: float) -> list[Curve]:
    """Return the curves at head and tail, times a scale."""
    return [Curve(side, response.time, scale * history(response, quantity, shell, side), colour=COLOURS[side]) for side in SIDES]


def extremum(label: str, stored: Sequence[float], side: str) -> Curve:
    """Return a stored pair (time, value) as a point."""
    return Curve(label, np.array([stored[0]]), np.array([stored[1]]), "points", colour=COLOURS[side])
