"""Layers between electrodes by hand, from the electric enthalpy of a layer, H = (1/2) Q eps^2 - e32~ eps E - (1/2) mu33~ E^2 per volume.

With E = u/t uniform through a layer, what multiplies u in the integral of -H is the load of a driven layer; a layer without charge has
the E for which the integral of dH/dE vanishes, which gives its voltage t E and what it adds to the stiffness. Cross-sections alone: k = 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import legendre

from coaxshell.apps.verification.independent.walls import strains
from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import FloatArray

_GAUSS = legendre.leggauss(3)


@dataclass(frozen=True)
class Electrodes:
    """What the electrodes of a wall do to (V, W, U) of an order, SI: load per volt, mean reading (V/m), stiffness of open circuits."""

    load: FloatArray
    reading: FloatArray
    stiffness: FloatArray

    @classmethod
    def of(cls, shell: Shell, m: int) -> Electrodes:
        """Return those of a shell."""
        load, readings, stiffness, z = np.zeros(3), [], np.zeros((3, 3)), -shell.thickness / 2
        for layer in shell.layers:
            x, t = layer.material, layer.thickness
            if isinstance(x, Piezoelectric):
                e = x.e32 - x.c23 * x.e33 / x.c33
                mu = x.permittivity_33 + x.e33**2 / x.c33
                points = zip(*_GAUSS, strict=True)
                stretched = np.sum([weight * t / 2 * _hoop(m, shell.radius, z + t * (1 + at) / 2) for at, weight in points], axis=0)
                field = -e * stretched / (mu * t)  # of an open circuit, per (V, W, U)
                if layer.role in ("actuator", "self-sensing"):
                    load += e * stretched / t
                if layer.role in ("sensor", "charge-sensor", "self-sensing"):
                    readings.append(t * field)
                if layer.role == "sensor":
                    stiffness += mu * t * np.outer(field, field)
            z += t
        return cls(load, np.mean(readings, axis=0), stiffness)


def _hoop(m: int, radius: float, z: float) -> FloatArray:
    """Return the hoop strain at a depth per (V, W, U)."""
    mid, slope = strains(m, 0.0, radius)
    total: FloatArray = mid[1] + z * slope[1]
    return total
