"""What electrodes on the faces of a layer do to a thin wall, and read of it.

A voltage u over a layer makes the field u/t in it and so the forces N = -e32~ u and N z_a about the mid-surface, z_a the middle of the
layer. In plane strain, as a load on (V, W), and of an open circuit (no charge, D = e32~ eps + mu33~ u/t = 0) as a reading, with B the
strain per (V, W),

    Q = e32~ B(z_a) u,      phi = -(t/mu33~) e32~ B(z_s),      B(z) = (m, -1)/R + z (m, -m^2)/R^2.

The field of the open circuit stiffens its layer by (t/mu33~) e32~^2 B B'. A layer that is driven has none: its voltage is given. A
charge-sensor's is held at zero by an amplifier that takes its charge, whose voltage on a condenser of the layer's own capacity is phi. A
self-sensing one is driven, and a bridge takes mu33~ u/t from its charge, so that it reads what it would with its circuit open.

With an axial wavenumber the forces N_z = -e31~ u and N_z z_a come to them: on (V, W, U) e32~ B is e32~ B_theta(z) + e31~ B_z(z), with the
strains B_z and B_theta of :mod:`coaxshell.structure.axial`, in loads, readings and stiffening alike.

The potential within a layer between its electrodes, a half cosine (Eq. A.7), is orthogonal to these uniform fields and stays in all.
"""

from __future__ import annotations

import numpy as np

from coaxshell.model.layers import Shell, serves
from coaxshell.model.piezoelectric import Piezoelectric
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.modes import Modes, kept_with_modes
from coaxshell.structure.axial import AXIAL, HOOP, Strain, axial_gain, strain
from coaxshell.structure.section import PiezoelectricLayer, Section
from coaxshell.structure.shell_model import FieldGain, Gain, WallStiffness
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


def opened(section: Section) -> list[PiezoelectricLayer]:
    """Return the layers whose circuits are open: those that are sensors alone."""
    return [layer for layer in section.piezoelectric if layer.role == "sensor"]


def push(section: Section, modes: Modes, layer: PiezoelectricLayer) -> Gain:
    """Return the load on (V, W, U) per volt on one layer, e32~ B(z_a); its charge per area and unit (V, W, U) too."""
    return _sum(section, modes, [(layer, _couplings(layer))])


def drive(section: Section, modes: Modes) -> Gain:
    """Return the load on (V, W, U) per volt on all actuators together, sum of e32~ B(z_a)."""
    return _sum(section, modes, [(layer, _couplings(layer)) for layer in serving(section, "actuator")])


def reading(section: Section, modes: Modes) -> Gain:
    """Return the mean of the open-circuit voltages of all sensors per unit (V, W, U), V."""
    sensors = serving(section, "sensor")
    return _sum(section, modes, [(layer, tuple(volts / len(sensors) for volts in _open_circuit(layer))) for layer in sensors])


def open_reading(section: Section, modes: Modes, layer: PiezoelectricLayer) -> Gain:
    """Return the open-circuit voltage of one layer per unit (V, W, U), V."""
    return _sum(section, modes, [(layer, _open_circuit(layer))])


def open_reading_of_fields(section: Section, orders: FloatArray, layer: PiezoelectricLayer) -> FieldGain:
    """Return the open-circuit voltage of one layer per unit of the fields at a station, V."""
    return _of_fields(section, orders, layer, _open_circuit(layer))


def push_of_fields(section: Section, orders: FloatArray, layer: PiezoelectricLayer) -> FieldGain:
    """Return the charge per area of one layer per unit of the fields at a station, without that of its voltage."""
    return _of_fields(section, orders, layer, _couplings(layer))


def _of_fields(section: Section, orders: FloatArray, layer: PiezoelectricLayer, factors: tuple[float, float]) -> FieldGain:
    """Return a hoop and an axial strain in the middle of a layer, times a factor each, per unit of the fields at a station."""
    (around, along), one = factors, np.ones_like(orders)
    v, w = strain_gain(orders, section.radius, layer.centre)
    return FieldGain(v=around * v, w=around * w, u_z=along * one, w_zz=along * layer.centre * one)


def open_circuit_voltage(layer: PiezoelectricLayer) -> float:
    """Return volts per hoop strain in the middle of a layer, -t e32~/mu33~."""
    return _open_circuit(layer)[0]


def _open_circuit(layer: PiezoelectricLayer) -> tuple[float, float]:
    """Return volts per hoop and per axial strain in the middle of a layer."""
    around, along = _couplings(layer)
    return -layer.thickness * around / layer.permittivity, -layer.thickness * along / layer.permittivity


def _couplings(layer: PiezoelectricLayer) -> tuple[float, float]:
    """Return e32~ and e31~, 0 where it is not known: in two dimensions nothing asks for it."""
    return layer.reduced_coupling, 0.0 if layer.axial is None else layer.axial.reduced_coupling


def open_circuit_stiffness(section: Section, m: FloatArray) -> WallStiffness:
    """Return the sum of (t/mu33~) e32~^2 B B' over the layers that are sensors alone, on (V, W)."""
    total = WallStiffness(np.zeros_like(m), np.zeros_like(m), np.zeros_like(m))
    for layer in opened(section):
        v, w = strain_gain(m, section.radius, layer.centre)
        stiffness = -layer.reduced_coupling * open_circuit_voltage(layer)
        total = WallStiffness(total.vv + stiffness * v * v, total.vw + stiffness * v * w, total.ww + stiffness * w * w)
    return total


@kept_with_modes
def axial_open_circuit_stiffness(section: Section, modes: Modes) -> FloatArray:
    """Return the same on (U, V, W) at an axial wavenumber, shape (3, 3, orders) or (3, 3, orders, nodes)."""
    at = strain(modes, section.radius)
    total = np.zeros_like(at.membrane)
    for layer in opened(section):
        row = _row(layer, _couplings(layer), at)
        total = total + layer.thickness / layer.permittivity * np.einsum("a...,b...->ab...", row, row)
    return total


def stress_per_volt(layer: PiezoelectricLayer, component: str) -> float:
    """Return the stress that a volt over a layer makes in it, -e32~/t (hoop) or -e31~/t (axial); no shear."""
    if component == "shear":
        return 0.0
    if component == "hoop":
        return -layer.reduced_coupling / layer.thickness
    return 0.0 if layer.axial is None else -layer.axial.reduced_coupling / layer.thickness


def _row(layer: PiezoelectricLayer, factors: tuple[float, ...], at: Strain) -> FloatArray:
    """Return a hoop and an axial strain in the middle of a layer, times a factor each, per unit (U, V, W): (3, orders) or more."""
    around, along = factors
    strains = at.at(layer.centre)
    return np.asarray(around * strains[HOOP] + along * strains[AXIAL])


def _sum(section: Section, modes: Modes, factors: list[tuple[PiezoelectricLayer, tuple[float, ...]]]) -> Gain:
    """Return the sum over layers of their strains times the factors of each, of the hoop and of the axial strain."""
    if not modes.two_dimensional:
        at = strain(modes, section.radius)
        return axial_gain(sum((_row(layer, pair, at) for layer, pair in factors), np.zeros_like(at.membrane[0])))
    v, w = np.zeros_like(modes.orders), np.zeros_like(modes.orders)
    for layer, (around, _) in factors:
        strain_v, strain_w = strain_gain(modes.orders, section.radius, layer.centre)
        v, w = v + around * strain_v, w + around * strain_w
    return Gain(v, w)
