"""The highest order and axial wavenumber that a tolerance asks for, both at once, chosen before the run from a sample of waves.

Waves along the wall are resolved alike in all directions: with M = k_max what is left out lies outside a circle in the plane of m and k.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.families import wave_sets
from coaxshell.solver.axial.left_out import squares_of
from coaxshell.solver.axial.sampling import AxialSampling, axial_sampling
from coaxshell.solver.estimates import ORDERS_FACTOR
from coaxshell.solver.sampled_orders import NODES, standing_for
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import Settings

HIGHEST = 400
"""The highest order and wavenumber that are chosen."""
_FEWEST = 8
_SAMPLE = 24


def resolved_sampling(problem: Problem, grid: LaplaceGrid, settings: Settings) -> tuple[AxialSampling, list[str]]:
    """Return the waves of a run, as many as it asks for or as its tolerance does, and a warning if the most are not enough.

    Raises
    ------
    InputError
        As :func:`coaxshell.solver.axial.sampling.axial_sampling`.
    """
    if settings.modes != "auto":
        return axial_sampling(problem, settings), []
    sampling = axial_sampling(problem, replace(settings, modes=HIGHEST))
    radius, share = _shares(problem, grid, sampling)
    remaining = ORDERS_FACTOR * np.sqrt(1.0 - np.cumsum(share, axis=-1)).max(axis=0, initial=0.0)
    enough = np.flatnonzero(remaining <= settings.tolerance)
    chosen = int(min(max(np.ceil(radius[enough[0]]) if enough.size else HIGHEST, _FEWEST), HIGHEST))
    found = axial_sampling(problem, replace(settings, modes=chosen))
    if enough.size and radius[enough[0]] <= HIGHEST:
        return found, []
    left = float(np.interp(HIGHEST, radius, remaining))
    return found, [
        f'modes="auto": {HIGHEST} orders and axial wavenumbers, the most that are chosen, leave an estimated {left:.2g} of the stress, '
        f"more than the tolerance {settings.tolerance:g}; accept it or shorten the source's spectrum (a longer rise_time)"
    ]


def _shares(problem: Problem, grid: LaplaceGrid, sampling: AxialSampling) -> tuple[FloatArray, FloatArray]:
    """Return ascending radii in the plane of m and k, and the share of the strain at each of them for every shell, (shells, radii)."""
    orders = np.unique(np.geomspace(1.0, 2.0 * HIGHEST + 1.0, _SAMPLE).round()) - 1.0
    around = standing_for(orders) * np.where(orders == 0, 1.0, 0.5)
    radii, squares = [], []
    for waves in wave_sets(problem, sampling, np.zeros(1), grid.nodes[NODES]):
        along = orders if waves.modes is sampling.modes else np.zeros(1)
        stands_for = standing_for(along) / sampling.spacing if along.size > 1 else np.ones(1)
        for k, weight in zip(along, stands_for, strict=True):
            wavenumber = float(k) if along.size > 1 else waves.modes[0].wavenumber
            mean = float(sampling.mean[-1]) if along.size > 1 else 1.0
            for family in waves.families:
                strain = squares_of(problem, grid, Modes(orders, wavenumber), family)[:, 1]
                radii.append(np.hypot(orders, k))
                squares.append(strain * (around * weight * mean))
    radius, square = np.concatenate(radii), np.concatenate(squares, axis=1)
    ascending = np.argsort(radius, kind="stable")
    total = np.maximum(square.sum(axis=1, keepdims=True), 1e-290)
    return radius[ascending], square[:, ascending] / total
