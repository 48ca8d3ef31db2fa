"""What electrodes on the faces of a layer do to a thin wall in plane strain, and read of it.

A voltage u over a layer makes the field u/t in it and so the forces N = -e32~ u and N z_a about the mid-surface, z_a the middle of the
layer. As a load on (V, W), and of an open circuit (no charge, D = e32~ eps + mu33~ u/t = 0) as a reading, with B the strain per (V, W),

    Q = e32~ B(z_a) u,      phi = -(t/mu33~) e32~ B(z_s),      B(z) = (m, -1)/R + z (m, -m^2)/R^2.

The field of the open circuit stiffens its layer by (t/mu33~) e32~^2 B B'. A layer that is driven has none: its voltage is given. A
self-sensing one is driven, and a bridge takes mu33~ u/t from its charge, so that it reads what it would with its circuit open.

The potential within a layer between its electrodes, a half cosine (Eq. A.7), is orthogonal to these uniform fields and stays in all.
"""

from __future__ import annotations

import numpy as np

from coaxshell.model.layers import Shell, serves
from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.numerics.arrays import FloatArray
from coaxshell.structure.section import PiezoelectricLayer, Section
from coaxshell.structure.shell_model import Gain, WallStiffness
from coaxshell.structure.stress import strain_gain


def with_plane_stress(shell: Shell) -> Shell:
    """Return a shell whose piezoelectric materials have the constants reduced by sigma_33 = 0, and none as printed."""

    def reduced(material: Piezoelectric) -> Piezoelectric:
        return material.replace(permittivity_reduction="standard", actuator_coupling="plane-stress")

    layers = (x.replace(material=reduced(x.material)) if isinstance(x.material, Piezoelectric) else x for x in shell.layers)
    return shell.replace(layers=tuple(layers))


def serving(section: Section, role: str) -> list[PiezoelectricLayer]:
    """Return the layers that serve as "sensor" or "actuator"; self-sensing ones as both."""
    return [layer for layer in section.piezoelectric if serves(layer.role, role)]


def push(section: Section, m: FloatArray, layer: PiezoelectricLayer) -> Gain:
    """Return the load on (V, W) per volt on one layer, e32~ B(z_a); its charge per area and unit (V, W) too."""
    return _sum(section, m, [(layer, layer.reduced_coupling)])


def drive(section: Section, m: FloatArray) -> Gain:
    """Return the load on (V, W) per volt on all actuators together, sum of e32~ B(z_a)."""
    return _sum(section, m, [(layer, layer.reduced_coupling) for layer in serving(section, "actuator")])


def reading(section: Section, m: FloatArray) -> Gain:
    """Return the mean of the open-circuit voltages of all sensors per unit (V, W), V."""
    sensors = serving(section, "sensor")
    return _sum(section, m, [(layer, open_circuit_voltage(layer) / len(sensors)) for layer in sensors])


def open_circuit_voltage(layer: PiezoelectricLayer) -> float:
    """Return volts per hoop strain in the middle of a layer, -t e32~/mu33~."""
    return -layer.thickness * layer.reduced_coupling / layer.permittivity


def open_circuit_stiffness(section: Section, m: FloatArray) -> WallStiffness:
    """Return the sum of (t/mu33~) e32~^2 B B' over the layers that are sensors alone, on (V, W)."""
    total = WallStiffness(np.zeros_like(m), np.zeros_like(m), np.zeros_like(m))
    for layer in section.piezoelectric:
        if layer.role == "sensor":
            v, w = strain_gain(m, section.radius, layer.centre)
            stiffness = -layer.reduced_coupling * open_circuit_voltage(layer)
            total = WallStiffness(total.vv + stiffness * v * v, total.vw + stiffness * v * w, total.ww + stiffness * w * w)
    return total


def stress_per_volt(layer: PiezoelectricLayer, component: str) -> float:
    """Return the stress that a volt over a layer makes in it, -e32~/t (hoop) or -e31~/t (axial); no shear."""
    if component == "shear":
        return 0.0
    if component == "hoop":
        return -layer.reduced_coupling / layer.thickness
    return 0.0 if layer.axial is None else -layer.axial.reduced_coupling / layer.thickness


def _sum(section: Section, m: FloatArray, factors: list[tuple[PiezoelectricLayer, float]]) -> Gain:
    v, w = np.zeros_like(m), np.zeros_like(m)
    for layer, factor in factors:
        strain_v, strain_w = strain_gain(m, section.radius, layer.centre)
        v, w = v + factor * strain_v, w + factor * strain_w
    return Gain(v, w)
