"""A ring of equal linear absorbers at equal spacing, solved exactly by its own symmetry.

With the modes written e^{i m theta}, m = -M..M, a ring of N absorbers couples only orders that differ by multiples of N. Per residue
class k = m mod N and Laplace node, the ring sees one amplitude per shell,

    a_k = sum_{m = k mod N} w_m e^{i m theta_0},       p_m = N/(2 pi R) e^{-i m theta_0} f_k,

so that what is an N x N problem for any layout is N problems of the two shells here. A footprint weighs both by h_m.
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.solver.interface.absorbers import AbsorberSet, admittance
from coaxshell.solver.interface.linear import LinearAbsorberSpectra, LinearStructure
from coaxshell.solver.interface.signed_orders import of_parities, signed_orders

_SAME_ANGLE = 1e-9


def is_ring(absorbers: AbsorberSet) -> bool:
    """Return whether the absorbers of the description are equal and equally spaced."""
    properties = (absorbers.mass, absorbers.damping, absorbers.linear, absorbers.cubic, *absorbers.surfaces, *_held(absorbers))
    if absorbers.count == 0 or absorbers.elements is not None or any(np.ptp(x) > 0 for x in properties):
        return False
    angles = np.sort(absorbers.every_angle % 360.0)
    gaps = np.diff(np.append(angles, angles[0] + 360.0))
    return bool(np.all(np.abs(gaps - 360.0 / angles.size) <= _SAME_ANGLE))


def _held(absorbers: AbsorberSet) -> tuple[FloatArray, ...]:
    return () if absorbers.footprint is None else tuple(absorbers.footprint)


def solve_ring(structure: LinearStructure, absorbers: AbsorberSet) -> LinearAbsorberSpectra:
    """Return the interface spectra of a ring of linear absorbers, exact up to the modal truncation."""
    nodes, count = structure.grid.nodes, absorbers.every_angle.size
    surfaces, (inner, outer) = structure.problem.surfaces, absorbers.surfaces[:, 0].tolist()
    pair = slice(inner, outer + 1, outer - inner)  # these two alone
    orders = np.arange(-structure.modes.max_order, structure.modes.max_order + 1)
    start = float(absorbers.every_angle[0])
    phase = np.exp(1j * np.radians(orders * start))
    linear = signed_orders(structure.surface_motion[pair])
    density = count / (2.0 * np.pi * np.array([one.radius for one in surfaces[pair]]))
    means = None if absorbers.footprint is None else absorbers.means(structure.problem, structure.modes)[:, 0]
    own, other, mass = (x[:, 0] for x in admittance(absorbers, nodes))
    ring_index = np.rint((absorbers.angle - start) / (360.0 / count))
    force = np.zeros((2, absorbers.count, nodes.size), np.complex128)
    displacement = np.zeros((absorbers.count, nodes.size), np.complex128)
    pressure = np.zeros_like(linear)
    for k in range(min(count, orders.size)):
        members = np.flatnonzero((orders - orders[k]) % count == 0)
        turn, above = phase[members][:, None], np.abs(orders[members])
        compliance, moved = structure.compliance[pair, pair][:, :, above], linear[:, members]
        if means is not None:
            held = means[:, above, None]
            compliance, moved = compliance * (held[:, None] * held[None, :]), moved * held
        excited = (moved * turn).sum(axis=1)
        receptance = compliance.sum(axis=2) * density[None, :, None]
        amplitude = _two_by_two(receptance, own, other, excited)
        line_force = -np.stack([own * amplitude[0] + other * amplitude[1], other * amplitude[0] + own * amplitude[1]])
        pressure[:, members] = line_force[:, None, :] * density[:, None, None] / turn
        if means is not None:
            pressure[:, members] *= held
        around = np.exp(2j * np.pi * orders[k] * ring_index / count)[:, None]
        force += around * line_force[:, None, :]
        displacement += around * mass * (amplitude[0] + amplitude[1])
    full = np.zeros((len(surfaces), absorbers.parities, structure.modes.count, nodes.size), np.complex128)
    full[pair] = of_parities(pressure, absorbers.parities)
    return LinearAbsorberSpectra(force.reshape(2 * absorbers.count, -1), displacement, full)


def _two_by_two(receptance: ComplexArray, own: ComplexArray, other: ComplexArray, excited: ComplexArray) -> ComplexArray:
    """Return the amplitudes a of (1 + G Y) a = a_linear for the two shells, shape (2, nodes)."""
    (g00, g01), (g10, g11) = receptance
    a, b = 1.0 + g00 * own + g01 * other, g00 * other + g01 * own
    c, d = g10 * own + g11 * other, 1.0 + g10 * other + g11 * own
    determinant = a * d - b * c
    return np.stack([(d * excited[0] - b * excited[1]) / determinant, (a * excited[1] - c * excited[0]) / determinant])
