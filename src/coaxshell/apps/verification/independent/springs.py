"""Laws of links that remember nothing, in SI, written from their descriptions alone."""

from __future__ import annotations

import numpy as np

from coaxshell.model import laws
from coaxshell.numerics.arrays import FloatArray


def force_of(law: laws.Single, stretch: FloatArray, rate: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return f of a law (N, per metre), its slope in the stretch (m) and in the rate (m/s)."""
    nothing = np.zeros_like(stretch)
    match law:
        case laws.Linear():
            return law.stiffness * stretch + law.damping * rate, nothing + law.stiffness, nothing + law.damping
        case laws.Cubic():
            return law.k1 * stretch + law.k3 * stretch**3, law.k1 + 3 * law.k3 * stretch**2, nothing
        case laws.Bistable():
            rest = {"inwards": law.well, "outwards": -law.well, "middle": 0.0}[law.rest]
            place = rest + stretch
            return law.k1 * place + law.k3 * place**3, law.k1 + 3 * law.k3 * place**2, nothing
        case laws.Polynomial():
            powers = np.polynomial.Polynomial([0.0, *law.coefficients])
            return powers(stretch), powers.deriv()(stretch), nothing
        case laws.Table():
            piece = np.clip(np.searchsorted(law.stretch, stretch) - 1, 0, len(law.slopes) - 1)
            slope = np.array(law.slopes)[piece]
            return np.array(law.force)[piece] + slope * (stretch - np.array(law.stretch)[piece]), slope, nothing
        case laws.Friction() if law.speed is not None:
            share = np.tanh(rate / law.speed)
            return law.force * share, nothing, law.force * (1 - share**2) / law.speed
    raise NotImplementedError(f"the law {law.type!r} is not written in the independent solver")
