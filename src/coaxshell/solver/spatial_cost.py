"""What a run in three dimensions costs: every axial wavenumber is a run in two dimensions, of which the sums at the stations are kept."""

from __future__ import annotations

from dataclasses import replace

from coaxshell.model.system import System
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.laplace_grid import WORKERS
from coaxshell.solver.axial.blocks import BLOCK_NODES
from coaxshell.solver.axial.sampling import AxialSampling, axial_sampling
from coaxshell.solver.run_size import Size
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings

_FIELDS = 9
"""Transforms kept at each station: three displacements, four derivatives along the axis, potentials of two layers."""
_WORKING = 40.0
"""Arrays of orders and nodes of a block that a thread works with, for each shell."""
_SIDE_BY_SIDE = 1000
"""Nodes below which threads take turns: there are two blocks, and NumPy lets others run only beside loops of more than 500 numbers."""


def sampling_of(system: System, settings: Settings, highest_order: int) -> AxialSampling:
    """Return the axial wavenumbers of a run, *highest_order* in the place of "auto"; InputError for a period that is too short."""
    return axial_sampling(dimensionless(system, dimensions=3, settings=settings), replace(settings, modes=highest_order))


def spatial_cost(system: System, settings: Settings, size: Size) -> Cost:
    """Return the cost of a run in three dimensions, given the *size* of the same run in two; InputError for a period that is too short."""
    tops = sampling_of(system, settings, size.orders - 1).tops
    pairs = float(tops.sum() + tops.size) * size.nodes
    stations, amplitudes = len(settings.stations), size.shells * size.source_parities
    kept = stations * amplitudes * (_FIELDS * (size.plane + size.history) + 6.0 * size.plane)
    turns = 2.0 if size.nodes < _SIDE_BY_SIDE else 1.0
    return Cost(
        kept + size.shells * (6.0 * size.plane + WORKERS * _WORKING * size.plane * min(0.5, BLOCK_NODES / size.nodes)),
        0.1 + turns * pairs * (0.3e-6 * size.shells + 2e-9 * _FIELDS * stations * amplitudes),
    )
