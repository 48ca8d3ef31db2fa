"""Transforms of what walls with two faces do under the sources, by the cascade of all walls and fluids (:mod:`coaxshell.solver.cascade`).

A wall is read at its reference surface (W, V, and the hoop stress at its design depth) and at its faces (what the fluids feel); the loads
on the faces give everything within it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import ROLL_OFF, LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver.cascade import CascadeSystem, FaceMotion
from coaxshell.solver.excitation import SurfaceLoads
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts
from coaxshell.solver.spectral import map_node_blocks, node_blocks
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import FaceReceptance, ShellModel


def band(grid: LaplaceGrid) -> float:
    """Return the frequency up to which walls resolve waves in runs on a grid: where its roll-off begins, radians per transit."""
    return (1.0 - ROLL_OFF) * grid.nyquist


class WallAnswer(NamedTuple):
    """What one wall does, each (orders, nodes): W, V, hoop stress and potentials of its reference, 0 of thin walls, and its faces."""

    normal: ComplexArray
    tangential: ComplexArray
    hoop: ComplexArray | float
    potentials: list[ComplexArray]
    faces: FaceMotion


class FacedSystem:
    """All walls and fluids at some orders and a block of Laplace nodes, each wall read at its reference surface.

    Parameters
    ----------
    problem : Problem
    s : ndarray, shape (nodes,)
    modes : Modes
    """

    def __init__(self, problem: Problem, s: ComplexArray, modes: Modes) -> None:
        ports = [_port(wall, modes, s) for wall in problem.shells]
        self.cascade = CascadeSystem(problem, s, modes, walls=[receptance for receptance, _ in ports])
        self.radial = self.cascade.radial
        self._reading = [reading for _, reading in ports]

    def under_sources(self, load: ComplexArray) -> list[WallAnswer]:
        """Return what all walls do under a pressure on the surface that the exterior fluid wets."""
        return [self._answer(reading, faces) for reading, faces in zip(self._reading, self.cascade.solve_outside(load), strict=True)]

    def _answer(self, reading: ComplexArray, faces: FaceMotion) -> WallAnswer:
        if reading.ndim == 2:
            return WallAnswer(faces.outer, reading * faces.outer, 0.0, [], faces)
        normal, tangential, hoop, *potentials = reading[:, 0] * faces.load_inner + reading[:, 1] * faces.load_outer
        return WallAnswer(normal, tangential, hoop, potentials, faces)


def _port(wall: ShellModel, modes: Modes, s: ComplexArray) -> tuple[FaceReceptance, ComplexArray]:
    """Return how a wall answers, and what it shows: per load on either face, (3 or more, 2, orders, nodes), or of one W its V/W."""
    return wall.two_port(modes, s) if isinstance(wall, ElasticWall) else (wall.receptance(modes, s), wall.operator(modes, s).tangential)


@dataclass(frozen=True, eq=False)
class SolidSpectra:
    """Transforms under the sources of a structure some of whose walls have two faces.

    Attributes
    ----------
    normal, tangential : ndarray, shape (shells, parities, M + 1, nodes)
        W and V of the reference surfaces.
    hoop : ndarray, same shape
        Hoop stress of elastic walls at their design depths, in rho_e c_e^2; 0 of others.
    faces, loads : ndarray, shape (2, shells, parities, M + 1, nodes)
        Displacements of the inner and the outer faces and the loads on them, positive inward.
    potentials : ndarray, shape (layers, shells, parities, M + 1, nodes)
        Open-circuit voltages of the piezoelectric layers of elastic walls, V, from the inside out; 0 of walls with fewer.
    """

    normal: ComplexArray
    tangential: ComplexArray
    hoop: ComplexArray
    faces: ComplexArray
    loads: ComplexArray
    potentials: ComplexArray

    @property
    def nbytes(self) -> int:
        """Bytes beside W and V."""
        return self.hoop.nbytes + self.faces.nbytes + self.loads.nbytes + self.potentials.nbytes


class FacedMotion(NamedTuple):
    """Transforms of the displacements of the faces and the loads on them, each (2, shells, parities, orders, nodes)."""

    faces: ComplexArray
    loads: ComplexArray


def solid_spectra(
    problem: Problem,
    grid: LaplaceGrid,
    modes: Modes,
    shared: SharedParts | None = None,
    progress: Progress | None = None,
    returned: ComplexArray | None = None,
) -> SolidSpectra:
    """Return all transforms of a structure under its sources.

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
    modes : Modes
    shared : SharedParts, optional
        Where modal loads are found, or left for others.
    progress : callable, optional
    returned : ndarray, shape (parities, M + 1, nodes), optional
        Load of what the planes of the sea send back.
    """
    loads = SurfaceLoads(problem, grid, modes, shared, returned)
    shape = (len(problem.shells), loads.parities, modes.count, grid.nodes.size)
    solids = [wall for wall in problem.shells if isinstance(wall, ElasticWall)]
    layers = max(len(wall.piezoelectric) for wall in solids)
    motion, faces = (np.empty((n, *shape), np.complex128) for n in (3, 4))
    found = SolidSpectra(motion[0], motion[1], motion[2], faces[:2], faces[2:], np.zeros((layers, *shape), np.complex128))
    for wall in solids:
        wall.two_port(modes, grid.nodes[:1])  # what all blocks share is made once, before all threads ask for it

    def work(block: slice) -> None:
        system = FacedSystem(problem, grid.nodes[block], modes)
        for parity, load in enumerate(loads(system.radial, block)):
            for shell, wall in enumerate(system.under_sources(load)):
                at = (shell, parity, slice(None), block)
                found.normal[at], found.tangential[at], found.hoop[at] = wall.normal, wall.tangential, wall.hoop
                found.faces[(0, *at)], found.faces[(1, *at)] = wall.faces.inner, wall.faces.outer
                for layer, potential in enumerate(wall.potentials):
                    found.potentials[(layer, *at)] = potential
                found.loads[(0, *at)], found.loads[(1, *at)] = wall.faces.load_inner, wall.faces.load_outer

    with one_blas_thread():  # small products on all threads
        map_node_blocks(node_blocks(grid, modes.max_order), work, progress, "frequencies")
    return found
