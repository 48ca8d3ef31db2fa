"""What walls some of which have two faces do in a wave along the axis, under the loads of families of sources, with all feedback."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol, runtime_checkable

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.faced import READ, FacedWave
from coaxshell.solver.axial.families import WaveSet
from coaxshell.solver.axial.limited_wave import lacking, limited_faces
from coaxshell.solver.axial.tied_faces import Closed, TiedFaces
from coaxshell.solver.scaling import Problem


@runtime_checkable
class FacedDriver(Protocol):
    """What the voltages of belts do to walls with two faces, at a block of nodes."""

    def wave(self, wave: int) -> FacedWave:
        """Return a wave without feedback."""
        ...

    def closed(self, wave: int) -> list[Closed]:
        """Return what the faces of all walls do in a wave, and the voltages that make it, one a family."""
        ...


def wave_at(
    problem: Problem, waves: WaveSet, j: int, grid: LaplaceGrid, block: slice, *, reads: bool = True, modes: Modes | None = None
) -> FacedWave:
    """Return wave j without feedback; that which belts have made, or one of *modes* of its own that keep no shapes."""
    if isinstance(waves.belts, FacedDriver):
        return waves.belts.wave(j)
    return FacedWave(problem, grid.nodes[block], waves.modes[j] if modes is None else modes, reads=reads, opened=waves.limited)


def closed_motions(wave: FacedWave, waves: WaveSet, j: int, grid: LaplaceGrid, block: slice) -> Iterator[Closed]:
    """Yield what the faces of all walls do under each family's loads; voltages where the solver closes loops, else none (0 rows)."""
    if isinstance(waves.belts, FacedDriver):
        yield from waves.belts.closed(j)
        return
    if waves.limited:
        yield from limited_faces(wave, waves, grid, block)
        return
    none = np.zeros((0, 0, wave.modes.count, wave.s.size), np.complex128)
    loops = TiedFaces(wave, max(family.parities for family in waves.families)) if wave.problem.tied else None
    for family in waves.families:
        free = wave.faces(family, grid, block)
        yield Closed(free, none) if loops is None else loops.closed(free)


def faced_amplitudes(problem: Problem, waves: WaveSet, j: int, grid: LaplaceGrid, block: slice, layers: int) -> list[ComplexArray]:
    """Return what walls are read for in wave j under each family's loads, (9 + layers, shells, parities, orders, nodes).

    Where amplifiers stop at a limit what laws ask for stands in the place of the voltages that walls give.
    """
    wave, found = wave_at(problem, waves, j, grid, block), []
    for family, closed in zip(waves.families, closed_motions(wave, waves, j, grid, block), strict=True):
        shown, lack = closed.read(wave, layers), lacking(problem, family, wave.modes)
        for i, wall in enumerate(problem.shells):
            if not isinstance(lack, float) and wall.gains is not None and wall.shows_control:
                shown[len(READ) + wall.shown_potentials - 1, i] -= lack[i]
        found.append(shown)
    return found


def motions_and_faces(problem: Problem, waves: WaveSet, j: int, grid: LaplaceGrid, block: slice) -> list[ComplexArray]:
    """Return W, V, U, what :func:`faces_of` gives, and voltages of loops that the solver closes of each family.

    (7 or 8, shells, parities, orders, nodes) each.
    """
    wave, found = wave_at(problem, waves, j, grid, block), []
    for faces, voltage in closed_motions(wave, waves, j, grid, block):
        each = []
        for parity, one in enumerate(faces):
            volts = voltage[:, parity] if voltage.size else None
            rows = [wave.read(one, 0, volts)[:3], np.stack([np.stack(moving) for moving in one], axis=1)]
            each.append(np.concatenate(rows if volts is None else [*rows, volts[None]]))
        found.append(np.stack(each, axis=2))
    return found


def faces_of(problem: Problem, waves: WaveSet, j: int, grid: LaplaceGrid, block: slice) -> list[ComplexArray]:
    """Return what the faces of all walls do in wave j under each family's loads, (4, shells, parities, orders, nodes).

    Displacements of the inner and of the outer faces and the loads on them, all positive inward; nothing within elastic walls is read.
    """
    wave, found = wave_at(problem, waves, j, grid, block, reads=False), []
    for faces, _ in closed_motions(wave, waves, j, grid, block):
        each = [np.stack([np.stack(moving) for moving in one], axis=1) for one in faces]
        found.append(np.stack(each, axis=2))
    return found
