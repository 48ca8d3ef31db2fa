"""What amplifiers give to layers between electrodes, and what the fields of these hold (theory manual, "Electrodes").

The charge of a driven layer, e32~ B(z_a) (V, W, U) + (mu33~/t) u per area, takes the power u dD/dt from its amplifier: what does not move
the wall, the work of the actuators on it, charges the layer's capacitance, (1/2) (mu33~/t) u^2 per area. Segments are taken one by one.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.solid_transducers import solid_electrical
from coaxshell.response.energy.work import SurfaceWork
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.segmented_wall import SegmentedWall
from coaxshell.structure.shell_model import Gain, ShellModel


def electrical_energy(motion: Motion) -> tuple[FloatArray, FloatArray] | None:
    """Return the energy from the amplifiers since the start and that in the layers' fields, each (T,); None where nothing is driven."""
    grid, s = motion.grid, motion.grid.nodes
    supplied, held, driven = np.zeros(grid.time.size), np.zeros(grid.time.size), False
    for i, wall in enumerate(motion.problem.shells):
        if isinstance(wall, ElasticWall):
            if (found := solid_electrical(motion, i)) is not None:
                driven, supplied, held = True, supplied + found[0], held + found[1]
            continue
        charges = () if wall.gains is None else wall.charges(motion.modes)
        if wall.gains is None or not charges:
            continue
        driven, one = True, driven_at(motion, i, wall)
        history = grid.invert(one.charging)
        for strained, capacitance in one.charges:
            if one.charging is one.volts:
                supplied += SurfaceWork(grid, one.weight, s * (strained + capacitance * one.volts))(one.volts)
            else:
                supplied += SurfaceWork(grid, one.weight, s * strained)(one.volts)
                supplied += SurfaceWork(grid, one.weight, s * (capacitance * one.charging))(one.charging)
            held += 0.5 * capacitance * np.einsum("m,hmt,hmt->t", one.weight, history, history)
    return (supplied, held) if driven else None


class DrivenWall(NamedTuple):
    """What amplifiers give to one wall, in orders or on its segments.

    Attributes
    ----------
    volts : ndarray, shape (parities, orders or N, nodes)
        Transforms of the voltage that meets the charge of strain.
    charging : ndarray, same shape
        That which charges the capacitance; the same but where electrodes are cut along the axis.
    charges : list of (ndarray, float)
        Transforms of the charge of each actuator without the voltage, and its capacitance.
    weight : ndarray, shape (orders or N,)
        Of each in an integral around, over a.
    """

    volts: ComplexArray
    charging: ComplexArray
    charges: list[tuple[ComplexArray, float]]
    weight: FloatArray


def driven_at(motion: Motion, shell: int, wall: ShellModel) -> DrivenWall:
    """Return what amplifiers give to a thin wall, by its segments where it has some."""
    assert wall.gains is not None
    w, v = motion.normal[shell], motion.tangential[shell]
    u = None if motion.axial is None else motion.axial[shell]
    if motion.voltage is None:
        volts = wall.gains.at(motion.grid.nodes, motion.modes) * _combined(wall.sensor_gain(motion.modes), v, w, u)
    else:
        volts = motion.voltage[shell]
    known = wall.charges(motion.modes)
    moved, weight = [_combined(charge, v, w, u) for charge, _ in known], wall.radius * motion.circle
    more = None if motion.charged is None else motion.charged[:, None] * volts
    if isinstance(wall, SegmentedWall):
        if more is not None:
            more = on_segments(wall, more, [], motion.around)[0]
            more[:, list(wall.segments.dead)] = 0.0  # the orders of a voltage count more each by itself
        volts, moved, weight = on_segments(wall, volts, moved, motion.around)
    charging = volts if more is None else more
    return DrivenWall(volts, charging, [(one, capacitance) for one, (_, capacitance) in zip(moved, known, strict=True)], weight)


def on_segments(
    wall: SegmentedWall, volts: ComplexArray, moved: list[ComplexArray], around: int = 2
) -> tuple[ComplexArray, list[ComplexArray], FloatArray]:
    """Return voltages and charges in orders as those of the segments, and the width of each over a, (N,).

    Of parities *around* the circle, (1, N, nodes) each; (2, N, nodes) where those of the axis stand beside them. Orders end at M, and the
    voltage of a segment does not: the field under it is that of what its amplifier gives, not of its orders.
    """
    cut = wall.segments
    width = np.full(cut.count, 2.0 * np.pi * wall.radius * cut.covered / cut.count)
    parts = [slice(first, first + around) for first in range(0, len(volts), around)]
    voltage = np.stack([cut.values(volts[part]) for part in parts])  # of dead ones too: after a march they are 0 but for its error,
    return voltage, [np.stack([cut.means(one[part]) for part in parts]) for one in moved], width  # which the motion has felt


def _combined(gain: Gain, tangential: ComplexArray, normal: ComplexArray, axial: ComplexArray | None) -> ComplexArray:
    per = gain.columns
    found = per.v * tangential + per.w * normal
    return np.asarray(found if per.u is None or axial is None else found + per.u * axial)
