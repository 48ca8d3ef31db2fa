"""How far the answer can be trusted: the errors that a run prints.

For displacement and stress of each shell, relative to the answer in the norm over its surface and the whole time:

- orders: what the orders above M would add and change (:mod:`coaxshell.solver.orders_left_out`), and what the points at which actuators
  are cut fold back into those kept,
- time step: the band limit of the inverse transform, and
- march: the steps of nonlinear interfaces (both :mod:`coaxshell.solver.step_error`).

The factors by which the raw estimates are multiplied are measured over random systems (``tests/random``): 0.8 % of the printed numbers for
the orders, none of those for the step, are less than half of the true error.
"""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import Progress
from coaxshell.solver.orders_left_out import Interface, left_out, relative, surface_norms
from coaxshell.solver.solution import Estimates
from coaxshell.solver.step_error import band_limit, folded_error, march_error, membrane_error
from coaxshell.solver.structure_spectra import StructureSpectra

ORDERS_FACTOR = 2.0
STEP_FACTOR = 2.0


def march_defect(
    grid: LaplaceGrid, defect: tuple[ComplexArray, ComplexArray], histories: tuple[FloatArray, FloatArray], step: float
) -> FloatArray:
    """Return the printed error of a march of limited voltages, (shells, 2): the motion that its own answer, cut once more, would add.

    ``defect`` are transforms of W and V of that motion, ``histories`` W and V of the run at instants ``step`` apart.
    """
    missing = surface_norms(*(grid.invert(x) for x in defect)).sum(axis=-1)
    return STEP_FACTOR * relative(missing, surface_norms(*histories).sum(axis=-1) * (step / grid.time_step))


def estimated_errors(
    structure: StructureSpectra,
    spectra: tuple[ComplexArray, ComplexArray],
    histories: tuple[FloatArray, FloatArray],
    step: float,
    interface: Interface | None = None,
    progress: Progress | None = None,
) -> Estimates:
    """Return the printed errors of a run.

    Parameters
    ----------
    structure : StructureSpectra
        Without feedback where saturating actuators acted as forces.
    spectra, histories : pair of ndarray
        W and V at all nodes of the grid, and at instants ``step`` apart.
    interface : Interface, optional
    progress : callable, optional
        Told where a march is repeated.
    """
    grid = structure.grid
    whole = surface_norms(*histories) * (step / grid.time_step)
    orders = ORDERS_FACTOR * left_out(structure, spectra, whole * grid.time_step, interface)
    if interface is not None and interface.asked is not None and interface.saturating is not None:
        orders = np.hypot(orders, STEP_FACTOR * folded_error(structure, interface, whole.sum(axis=-1)))
    march = np.zeros_like(orders)
    if interface is not None and interface.marched:
        total = whole.sum(axis=-1)
        march = march_error(structure, interface, total, progress) + STEP_FACTOR * membrane_error(structure, interface, total)
    return Estimates(orders, STEP_FACTOR * band_limit(grid, *spectra, whole), march)
