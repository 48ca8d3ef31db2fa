"""What actuators hold where walls have two faces: their charge under the sources and per volt, while no feedback acts.

Walls of elastic solids hold charges by the loads on their faces and by their voltage (:mod:`coaxshell.structure.solid_charges`); thin ones
beside them by their motion and by their voltage.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import FacedSystem, SolidSpectra, WallAnswer, make_shapes
from coaxshell.solver.spectral import map_node_blocks, node_blocks
from coaxshell.solver.structure_spectra import Moved
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import Gain, ShellModel
from coaxshell.structure.solid_charges import Charging, charging


class PerVolt(NamedTuple):
    """Answers of walls under control to a volt given to each, each (controlled, controlled, orders, nodes).

    Attributes
    ----------
    read : ndarray
        What the law of a wall reads, V.
    charge : ndarray
        What all actuators of a wall hold per area, that of their own voltage included.
    """

    read: ComplexArray
    charge: ComplexArray


def charge_of(wall: ShellModel, modes: Modes) -> Gain:
    """Return m, the charge per area of all actuators of a thin wall per unit (V, W)."""
    moved = [one for one, _ in wall.charges(modes)]
    zero = np.zeros_like(modes.orders)
    return Gain(sum((one.v for one in moved), zero), sum((one.w for one in moved), zero))


def per_volt(passive: Problem, shells: tuple[int, ...], modes: Modes, s: ComplexArray) -> PerVolt:
    """Return what walls under control read and hold per volt on each, of a problem without its feedback."""
    system, shape = FacedSystem(passive, s, modes), (len(shells), len(shells), modes.count, s.size)
    read, charge = np.empty(shape, np.complex128), np.empty(shape, np.complex128)
    held = {i: charging(wall, modes, s) for i in shells if isinstance(wall := passive.shells[i], ElasticWall)}
    for b, driven in enumerate(shells):
        answers = system.under_voltage(driven, 1.0)
        for a, i in enumerate(shells):
            read[a, b] = system.sensed(i, answers[i])
            charge[a, b] = _charge(passive.shells[i], held.get(i), modes, answers[i], float(a == b))
    return PerVolt(read, charge)


def _charge(wall: ShellModel, held: Charging | None, modes: Modes, answer: WallAnswer, volts: float) -> ComplexArray:
    """Return the charge per area of a wall's actuators in a motion of it under a voltage."""
    if held is not None:
        by_loads = held.per_load[0] * answer.faces.load_inner + held.per_load[1] * answer.faces.load_outer
        return np.asarray(by_loads + held.per_volt * volts)
    gain, own = charge_of(wall, modes).columns, sum(capacitance for _, capacitance in wall.charges(modes))
    return np.asarray(gain.v * answer.tangential + gain.w * answer.normal + own * volts)


def per_volt_of_grid(passive: Problem, shells: tuple[int, ...], modes: Modes, grid: LaplaceGrid) -> PerVolt:
    """Return the same at all nodes of a grid, by blocks on all threads."""
    shape = (len(shells), len(shells), modes.count, grid.nodes.size)
    found = PerVolt(np.empty(shape, np.complex128), np.empty(shape, np.complex128))
    make_shapes(passive, modes, grid.nodes)

    def work(block: slice) -> None:
        for whole, part in zip(found, per_volt(passive, shells, modes, grid.nodes[block]), strict=True):
            whole[..., block] = part

    with one_blas_thread():
        map_node_blocks(node_blocks(grid, modes.count), work, None, "voltages")
    return found


def charge_in_motion(
    wall: ShellModel, shell: int, moved: SolidSpectra | Moved, modes: Modes, grid: LaplaceGrid, volts: ComplexArray | None = None
) -> ComplexArray:
    """Return the charge per area of all actuators of one wall, (parities, M + 1, nodes), under loads and voltages (as much, V)."""
    if not isinstance(wall, ElasticWall):
        gain, own = charge_of(wall, modes).columns, sum(capacitance for _, capacitance in wall.charges(modes))
        strained = gain.v * moved.tangential[shell] + gain.w * moved.normal[shell]
        return np.asarray(strained if volts is None else strained + own * volts)
    solid, parts = moved if isinstance(moved, SolidSpectra) else moved.solid, []
    assert solid is not None
    for block in node_blocks(grid, modes.count):
        held = charging(wall, modes, grid.nodes[block])
        found = np.einsum("bmk,bhmk->hmk", held.per_load, solid.loads[:, shell, ..., block])
        parts.append(found if volts is None else found + held.per_volt * volts[..., block])
    return np.concatenate(parts, axis=-1)
