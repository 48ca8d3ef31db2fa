"""Energy of the point absorbers of a three-dimensional run, from the motion of the walls where they hold them."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.response.energy.absorbers import AbsorberEnergy, held_energy
from coaxshell.solver.axial.blocks import node_blocks, on_threads
from coaxshell.solver.axial.faced import make_shapes
from coaxshell.solver.axial.linked import point_structure, solve_points
from coaxshell.solver.axial.motion import WaveMotion
from coaxshell.solver.axial.points import point_layout
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.interface.absorbers import Properties
from coaxshell.solver.scaling import Problem


class HeldPoints:
    """The point absorbers of a problem, solved again, and what the walls do where they are held.

    They are solved with the axial wavenumbers of the balance, not with those of the run: a sum that ends at k_max feels where its last
    wavenumber lies (some 1e-4 of the work at M = 6), and walls and absorbers must agree about the work between them.

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
        Of the run.
    sampling : AxialSampling
        Of the balance.
    """

    def __init__(self, problem: Problem, grid: LaplaceGrid, sampling: AxialSampling) -> None:
        layout = point_layout(problem)
        make_shapes(problem, sampling.modes)
        self._grid, self._layout = grid, layout
        self._structure = point_structure(problem, grid, sampling, layout, node_blocks(grid), on_threads)
        linked = solve_points(self._structure)
        self.forces, self._links = linked.forces, linked.links
        self._moved: ComplexArray = np.zeros((layout.points.count, grid.nodes.size), np.complex128)

    def add(self, wave: WaveMotion) -> None:
        """Add the motion of one axial wavenumber."""
        self._moved += wave.at_points(self._layout.points)

    def energy(self, kept: slice) -> AbsorberEnergy:
        """Return the energy of all absorbers at some of the grid's instants, once all wavenumbers have been added."""
        layout, grid = self._layout, self._grid
        absorbers, count = layout.absorbers, layout.member_count
        w, dw = grid.invert(self._moved), grid.invert(self._moved * grid.nodes)
        impedance = layout.of_every(self._impedance())

        def at(shell: int, here: list[int], side: list[int]) -> tuple[FloatArray, FloatArray, FloatArray]:
            points = np.array(here) + count * np.array(side)
            return w[points], dw[points], impedance[points, None]

        law = Properties(*(x[absorbers.member] for x in (absorbers.mass, absorbers.damping, absorbers.linear, absorbers.cubic)))
        linked = [(int(inner), int(outer)) for inner, outer in absorbers.shells.T[absorbers.member]]
        return held_energy(law, linked, self._links, at, grid, kept)

    def _impedance(self) -> FloatArray:
        """Return Z, by which a force at a point and its images moves the wall's own mass within half a step, at all points carried."""
        structure, problem = self._structure, self._structure.problem
        mass = np.array([problem.shells[problem.surfaces[i].shell].mass for i in self._layout.carried.surface])
        return np.asarray(2.0 * mass / (self._grid.time_step * np.diag(structure.immediate)))
