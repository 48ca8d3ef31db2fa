"""What stands within an elastic wall, at any depth: displacements, all stresses, potentials, from the loads on its faces.

Histories keep W, V and the hoop stress at the design depth; anything else is its transfer from the loads on both faces
(:meth:`coaxshell.structure.elastic_wall.ElasticWall.transfer`), one matrix product and one inverse transform.
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.spectral import map_node_blocks, node_blocks
from coaxshell.structure.elastic_depth import STRESSES, Shown
from coaxshell.structure.elastic_wall import Asked, ElasticWall


def within(spectra: SolvedSpectra, shell: int, what: Shown, depth: float) -> FloatArray:
    """Return modal histories of a quantity at a depth of an elastic wall, SI, shape (parities, M + 1, T), at all instants of the grid.

    Parameters
    ----------
    spectra : SolvedSpectra
    shell : int
    what : str
        A displacement (m), a stress (Pa) or the potential (V).
    depth : float
        z, m, outward from the middle of the wall; between two layers the outer one is meant.
    """
    problem, grid, modes = spectra.problem, spectra.grid, spectra.modes
    wall, solid, scales = problem.shells[shell], spectra.solid, problem.scales
    assert isinstance(wall, ElasticWall)
    assert solid is not None
    found = np.empty_like(solid.normal[shell])
    wall.basis(modes)  # made once, before all threads ask for it

    def work(block: slice) -> None:
        inner, outer = wall.transfer(modes, grid.nodes[block], [Asked(what, depth / scales.length)])[0]
        loads = solid.loads[:, shell, :, :, block]
        found[..., block] = inner * loads[0] + outer * loads[1]

    with one_blas_thread():  # small products on all threads
        map_node_blocks(node_blocks(grid, modes.max_order), work, None, "depth")
    unit = 1.0 if what == "potential" else scales.pressure if what in STRESSES else scales.length
    return grid.invert(found) * unit
