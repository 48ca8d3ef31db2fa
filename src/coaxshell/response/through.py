"""What stands within an elastic wall, at any depth: displacements, all stresses, potentials, from the loads on its faces.

Histories keep W, V and the hoop stress at the design depth; anything else is its transfer from the loads on both faces
(:meth:`coaxshell.structure.elastic_wall.ElasticWall.transfer`), one matrix product and one inverse transform.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import islice

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.solver.spectral import map_node_blocks, node_blocks
from coaxshell.structure.elastic_depth import STRESSES, Shown
from coaxshell.structure.elastic_wall import Asked, ElasticWall

BYTES = 2**26
"""Transforms at several depths that are found together."""


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
    (found,) = each_within(spectra, shell, [Asked(what, depth)])
    return np.asarray(found[0])


def each_within(spectra: SolvedSpectra, shell: int, asked: Sequence[Asked], per: int = 1) -> Iterator[FloatArray]:
    """Yield modal histories of quantities at depths (m) of an elastic wall, *per* of them together, (per, parities, M + 1, T), SI.

    As many as fit into :data:`BYTES` are one matrix product.
    """
    problem, grid, modes = spectra.problem, spectra.grid, spectra.modes
    wall, solid, scales = problem.shells[shell], spectra.solid, problem.scales
    assert isinstance(wall, ElasticWall)
    assert solid is not None
    loads, blocks = solid.loads[:, shell], node_blocks(grid, modes.max_order)
    volts = None if spectra.voltage is None or wall.transducers is None else spectra.voltage[shell]
    wall.prepare(modes)
    together = per * max(1, BYTES // (per * loads[0].nbytes))
    for start in range(0, len(asked), together):
        some = [Asked(one.what, one.depth / scales.length) for one in asked[start : start + together]]
        found = np.empty((len(some), *loads.shape[1:]), np.complex128)

        def work(block: slice, some: list[Asked] = some, found: ComplexArray = found) -> None:
            s, given = grid.nodes[block], None
            inner, outer = np.moveaxis(wall.transfer(modes, s, some, fed_back=volts is None), 1, 0)
            if volts is not None:
                given = wall.under_voltage(modes, s, some).shown
            for parity in range(loads.shape[1]):
                there = found[:, parity, :, block]
                np.multiply(inner, loads[0, parity, :, block], out=there)
                there += outer * loads[1, parity, :, block]
                if given is not None and volts is not None:
                    there += given * volts[parity, :, block]

        with one_blas_thread():  # small products on all threads
            map_node_blocks(blocks, work, None, "depth")
        units = (1.0 if x.what == "potential" else scales.pressure if x.what in STRESSES else scales.length for x in some)
        histories = (grid.invert(one) * unit for one, unit in zip(found, units, strict=True))
        yield from (np.stack(list(islice(histories, per))) for _ in range(len(some) // per))
