"""The scattered wave that surface and bottom send back, as a series of reflections.

What the shells scatter and radiate comes back from the planes as a further incident wave, 2 (d - b) transits after it left at the earliest,
d the distance of the nearer plane. A run without it is exact until then; solved again with what that run's motion sends back, until twice
that, and so on: after n rounds until (n + 1) 2 (d - b), whatever absorbers and actuators do, because each round is the whole structure.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.progress import Progress
from coaxshell.solver.excitation import incident_on_surface
from coaxshell.solver.graf import causal_images, returned_load
from coaxshell.solver.rounds import rounds
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.spectral import map_node_blocks, node_blocks
from coaxshell.solver.structure_spectra import StructureSpectra

SETTLED = 1e-12
"""Share of the sources' own load by which a round changes the load when nothing more comes: rounding."""


def reflected(
    structure: StructureSpectra, answer: Callable[[StructureSpectra], SolvedSpectra], progress: Progress | None = None
) -> SolvedSpectra:
    """Return the answer of a structure to its sources and to all that the planes send back within the run.

    Parameters
    ----------
    structure : StructureSpectra
        Without anything sent back.
    answer : callable
        From a structure to its answer.
    progress : callable, optional
        Called with the share of the rounds that are done.
    """
    solved = answer(structure)
    planned = rounds(structure.problem, float(structure.grid.time[-1])).done
    if not planned:
        return solved
    radial = RadialBasis(structure.modes, structure.grid.nodes)
    slope = incident_on_surface(structure.problem, structure.grid, radial)[1]
    before: ComplexArray | None = None
    for round_ in range(planned):
        if progress is not None:
            progress(round_ / planned, "reflections")
        load = sent_back(solved, slope)
        if before is not None and _alike(load, before):
            break
        solved, before = answer(structure.receiving(load)), load
    return solved


def sent_back(solved: SolvedSpectra, slope: ComplexArray) -> ComplexArray:
    """Return the load on the outermost surface of what planes send back of a run's scattered wave, (parities, M + 1, nodes).

    Parameters
    ----------
    solved : SolvedSpectra
    slope : ndarray, shape (1 or 2, M + 1, nodes)
        dp/dr of the sources and their images at the outermost surface.
    """
    structure = solved.structure
    return sent_by(structure.problem, structure, solved.face_motion.outer[-1], slope)


def sent_by(problem: Problem, structure: StructureSpectra, outer: ComplexArray, slope: ComplexArray) -> ComplexArray:
    """Return the load that planes send back, for those and the head of a problem, of an outermost face that moves by *outer*."""
    grid, planes = structure.grid, problem.planes
    assert planes is not None
    images = causal_images(planes, problem.head, float(grid.time[-1]))
    load: ComplexArray = np.zeros_like(outer)

    def work(block: slice) -> None:
        surface = RadialBasis(structure.modes, grid.nodes[block])(1.0, problem.head)
        leaving = grid.nodes[block] ** 2 * outer[..., block]
        leaving[: slope.shape[0]] -= slope[..., block]
        if structure.returned is not None:  # of a wave that is regular within
            leaving -= structure.returned[..., block] / (surface.disc - surface.exterior)
        load[..., block] = returned_load(leaving * surface.exterior, surface, planes, images)

    map_node_blocks(node_blocks(grid, structure.modes.max_order), work, None, "reflections")
    return load


def _alike(load: ComplexArray, before: ComplexArray) -> bool:
    """Return whether two loads are the same but for rounding."""
    return float(np.abs(load - before).max()) <= SETTLED * float(np.abs(before).max())
