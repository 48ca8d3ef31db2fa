"""What voltages on electrodes move where walls have two faces, and what the sensors read of it, while no feedback acts.

A volt on the actuators of an elastic wall moves its free faces and makes its sensors read (:meth:`ElasticWall.under_voltage
<coaxshell.structure.elastic_wall.ElasticWall.under_voltage>`); the fluids answer by loads on all faces, by the cascade.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.progress import Progress
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import FacedSystem, SolidSpectra, make_shapes, nothing_moves, sensed_place
from coaxshell.solver.spectral import map_node_blocks, node_blocks
from coaxshell.structure.elastic_wall import ElasticWall


def readings_per_volt(passive: Problem, shells: Sequence[int], modes: Modes, s: ComplexArray) -> ComplexArray:
    """Return volts read on some walls per volt given to each other, shape (controlled, controlled, orders, nodes).

    Parameters
    ----------
    passive : Problem
        Without feedback.
    shells : sequence of int
        Those under control.
    modes : Modes
    s : ndarray, shape (nodes,)
    """
    system, found = FacedSystem(passive, s, modes), np.empty((len(shells), len(shells), modes.count, s.size), np.complex128)
    for b, driven in enumerate(shells):
        answers = system.under_voltage(driven, 1.0)
        for a, read in enumerate(shells):
            found[a, b] = system.sensed(read, answers[read])
    return found


def readings_of_grid(passive: Problem, shells: Sequence[int], modes: Modes, grid: LaplaceGrid) -> ComplexArray:
    """Return the same at all nodes of a grid, by blocks on all threads."""
    found = np.empty((len(shells), len(shells), modes.count, grid.nodes.size), np.complex128)
    make_shapes(passive, modes, grid.nodes)

    def work(block: slice) -> None:
        found[..., block] = readings_per_volt(passive, shells, modes, grid.nodes[block])

    with one_blas_thread():
        map_node_blocks(node_blocks(grid, modes.count), work, None, "voltages")
    return found


def read_of_solids(passive: Problem, shells: Sequence[int], solid: SolidSpectra, modes: Modes) -> ComplexArray:
    """Return what the sensors of some walls read of a motion, V, (controlled, parities, M + 1, nodes)."""
    found = []
    for i in shells:
        wall = passive.shells[i]
        if isinstance(wall, ElasticWall):
            found.append(solid.potentials[sensed_place(wall), i])
        else:
            gain = wall.sensor_gain(modes).columns
            found.append(gain.v * solid.tangential[i] + gain.w * solid.normal[i])
    return np.stack(found)


def moved_by_voltages(
    passive: Problem, grid: LaplaceGrid, modes: Modes, voltage: ComplexArray, progress: Progress | None = None
) -> SolidSpectra:
    """Return all that voltages in orders, V, shape (shells, parities, M + 1, nodes), move without sources and feedback."""
    found = nothing_moves(passive, voltage.shape[1], modes.count, grid.nodes.size)
    acting = [i for i, volts in enumerate(voltage) if volts.any()]
    if not acting:
        return found
    make_shapes(passive, modes, grid.nodes)

    def work(block: slice) -> None:
        system = FacedSystem(passive, grid.nodes[block], modes)
        for parity in range(voltage.shape[1]):
            found.put(parity, block, system.under_voltages([(i, voltage[i, parity, :, block]) for i in acting]))

    with one_blas_thread():
        map_node_blocks(node_blocks(grid, modes.count), work, progress, "motion by voltages")
    return found
