"""What the faces of all walls do under the sources and under unit pressures on the surfaces, made in one pass and read once.

All that a wall with two faces does is linear in the loads on them. So while forces are looked for no more is kept than how the faces move
and what loads act on them; with the forces these loads are added up,

    q = q of the sources + sum over surfaces of (q per unit pressure there) times its pressure,

and displacements, stresses and potentials within the walls are read of the sum alone.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver.cascade import CascadeSystem, FaceMotion, GapAnswers
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.faced_forces import held_at_one_gap, moved_surfaces
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import SolidSpectra, make_shapes, read, reading_of, room_for
from coaxshell.solver.spectral import map_node_blocks, node_blocks


class UnitFaces(NamedTuple):
    """Answers to a unit pressure on each surface.

    Attributes
    ----------
    compliance : ndarray, shape (surfaces, surfaces, orders, nodes)
        Displacement of surface i per pressure on surface j.
    loads : tuple of ndarray, shape (2, shells, orders, nodes)
        On the inner and the outer faces of all walls, by the number of the surface that is pressed on.
    """

    compliance: ComplexArray
    loads: tuple[ComplexArray, ...]

    def put_gap(self, nodes: slice, found: GapAnswers) -> None:
        """Put down what pressures on the two faces of the one gap do at a slice of the nodes."""
        for j, (faces, loads) in enumerate(zip(self.loads, found.loads, strict=True)):
            for shell, (load, receptance, behind) in enumerate(zip(loads, found.receptances, found.behind, strict=True)):
                faces[1 - shell, shell, :, nodes] = load
                np.multiply(behind, load, out=faces[shell, shell, :, nodes])
                np.multiply(receptance, load, out=self.compliance[shell, j, :, nodes])

    @property
    def nbytes(self) -> int:
        """Bytes of all arrays."""
        return self.compliance.nbytes + sum(one.nbytes for one in self.loads)


class UnderSources(NamedTuple):
    """What the sources do.

    Attributes
    ----------
    loads : ndarray, shape (2, shells, parities, orders, nodes)
        On the faces.
    surfaces : ndarray, shape (surfaces, parities, orders, nodes)
        Displacements of the surfaces on which links act.
    """

    loads: ComplexArray
    surfaces: ComplexArray


def answers_of_faces(
    problem: Problem, grid: LaplaceGrid, modes: Modes, sources: SurfaceLoads | None, progress: Progress | None = None
) -> tuple[UnderSources | None, UnitFaces]:
    """Return what loads act on all faces, and how the surfaces move, under the sources and under unit pressures, in one pass.

    Parameters
    ----------
    problem : Problem
        Its walls resolve the waves of the grid.
    grid : LaplaceGrid
    modes : Modes
    sources : SurfaceLoads or None
        Their loads; None where what they do is known.
    progress : callable, optional
    """
    faces, count, size = (2, len(problem.shells)), len(problem.surfaces), (modes.count, grid.nodes.size)
    unit = UnitFaces(_room(count, count, *size), tuple(_room(*faces, *size) for _ in range(count)))
    under = None
    if sources is not None:
        under = UnderSources(_room(*faces, sources.parities, *size), _room(count, sources.parities, *size))
    make_shapes(problem, modes, grid.nodes)

    def work(block: slice) -> None:
        cascade = CascadeSystem(problem, grid.nodes[block], modes)  # nothing within the walls is asked for
        if sources is not None and under is not None:
            for parity, load in enumerate(sources(cascade.radial, block)):
                moved = cascade.solve_outside(load)
                _put(under.loads[:, :, parity, :, block], under.surfaces[:, parity, :, block], problem, moved)
        if held_at_one_gap(problem):
            unit.put_gap(block, cascade.gap_answers())
            return
        for j, surface in enumerate(problem.surfaces):
            moved = cascade.solve(surface.shell, 1.0, surface.side)
            _put(unit.loads[j][..., block], unit.compliance[:, j, :, block], problem, moved)

    with one_blas_thread():  # small products on all threads
        map_node_blocks(node_blocks(grid, modes.max_order), work, progress, "frequencies")
    return under, unit


def _room(*shape: int) -> ComplexArray:
    return np.empty(shape, np.complex128)


def _put(loads: ComplexArray, surfaces: ComplexArray, problem: Problem, moved: list[FaceMotion]) -> None:
    """Put down the loads on the faces of all walls, (2, shells, ...), and the displacements of the surfaces."""
    for shell, wall in enumerate(moved):
        loads[0, shell], loads[1, shell] = wall.load_inner, wall.load_outer
    for place, displacement in zip(surfaces, moved_surfaces(problem, moved), strict=True):
        place[...] = displacement


def under_pressures(sources: UnderSources, unit: UnitFaces, pressure: ComplexArray) -> UnderSources:
    """Return what the sources and pressures on the surfaces, (surfaces, parities, M + 1, nodes), do together."""
    parities = pressure.shape[1]
    loads, surfaces = (_widened(given, parities) for given in sources)
    for j, parity in np.ndindex(len(unit.loads), parities):
        given = pressure[j, parity]
        for place in np.ndindex(loads.shape[:2]):
            loads[(*place, parity)] += unit.loads[j][place] * given
        for i, displacement in enumerate(unit.compliance[:, j]):
            surfaces[i, parity] += displacement * given
    return UnderSources(loads, surfaces)


def _widened(given: ComplexArray, parities: int) -> ComplexArray:
    """Return a copy of transforms (..., parities, orders, nodes) with at least so many parities."""
    known = given.shape[-3]
    found = np.empty((*given.shape[:-3], max(known, parities), *given.shape[-2:]), np.complex128)
    found[..., :known, :, :], found[..., known:, :, :] = given, 0.0
    return found


def read_within(problem: Problem, grid: LaplaceGrid, modes: Modes, moved: UnderSources, progress: Progress | None = None) -> SolidSpectra:
    """Return all that walls do: of solids by the loads on their faces, of thin ones, which are surfaces themselves, by their W."""
    found, read_now = room_for(problem, grid, modes, moved.loads)
    make_shapes(problem, modes, grid.nodes, read_now)
    surface = {one.shell: number for number, one in enumerate(problem.surfaces) if one.side is None}

    def work(block: slice) -> None:
        for shell, wall in enumerate(problem.shells):
            reading = reading_of(wall, modes, grid.nodes[block], read_now)
            for parity in range(moved.loads.shape[2]):
                inner, outer = moved.loads[:, shell, parity, :, block]
                w = moved.surfaces[surface[shell], parity, :, block] if shell in surface else inner
                found.put_read(shell, parity, block, read(reading, FaceMotion(w, w, inner, outer), read_now))

    with one_blas_thread():
        map_node_blocks(node_blocks(grid, modes.max_order), work, progress, "motion within the walls")
    return found
