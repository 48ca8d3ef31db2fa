"""Modal stiffness of a thin layered wall on the amplitudes (V, W) of sin(m theta) and cos(m theta), and its piezoelectric parts."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.structure.section import PiezoelectricLayer, Section
from coaxshell.structure.shell_model import Gain, WallStiffness


def membrane_strain(m: FloatArray, radius: float) -> tuple[FloatArray, FloatArray]:
    """Return e = (m, -1)/R: mid-surface hoop strain per unit (V, W)."""
    return m / radius, np.full_like(m, -1.0 / radius)


def bending_strain(m: FloatArray, radius: float) -> tuple[FloatArray, FloatArray]:
    """Return k = (m, -m^2)/R^2: hoop strain per unit z (outward) and unit (V, W)."""
    return m / radius**2, -(m**2) / radius**2


def open_circuit_stiffness(layer: PiezoelectricLayer, m: FloatArray, radius: float) -> FloatArray:
    """Return kappa_j = E_j^2/(zeta33 + m^2 zeta22/R^2), N m: bending stiffness added by an open-circuit layer (from Eq. 20)."""
    return layer.coupling**2 / (layer.zeta33 + m**2 * layer.zeta22 / radius**2)


def wall_stiffness(section: Section, m: npt.ArrayLike) -> WallStiffness:
    """Return K = a22 e e' + b22 (e k' + k e') + (d22 + sum_j kappa_j) k k', the modal stiffness of a thin circular wall.

    Parameters
    ----------
    section : Section
        Section integrals.
    m : array_like
        Circumferential orders.

    Returns
    -------
    WallStiffness
        N/m^3, so that I d2(v, w)/dtau2 + K (v, w) is the load per unit area.
    """
    m = np.asarray(m, dtype=np.float64)
    ev, ew = membrane_strain(m, section.radius)
    kv, kw = bending_strain(m, section.radius)
    a, b = section.membrane, section.cross
    d = section.bending + sum(open_circuit_stiffness(layer, m, section.radius) for layer in section.piezoelectric)
    return WallStiffness(
        vv=a * ev * ev + 2 * b * ev * kv + d * kv * kv,
        vw=a * ev * ew + b * (ev * kw + kv * ew) + d * kv * kw,
        ww=a * ew * ew + 2 * b * ew * kw + d * kw * kw,
    )


def potential_gain(layer: PiezoelectricLayer, m: npt.ArrayLike, radius: float) -> Gain:
    """Return the potential of an open-circuit layer per unit (V, W), V/m (sensor equation, Eq. 20).

    phi_j = E_j (m V - m^2 W)/(zeta33 R^2 + m^2 zeta22); a rigid translation (m = 1, V = W) gives none.
    """
    m = np.asarray(m, dtype=np.float64)
    gain = layer.coupling / (layer.zeta33 * radius**2 + m**2 * layer.zeta22)
    return Gain(gain * m, -gain * m**2)
