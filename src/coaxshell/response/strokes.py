"""Strokes of absorbers: how far their masses move relative to the shells that they link."""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.absorbers import SIDES, absorber_displacement
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.solver.solution import ModalSolution


def absorber_stroke(solution: ModalSolution) -> xr.DataArray:
    """Return the strokes q_n - w(theta_n) of the absorbers in two dimensions, m, dims (absorber, side, time): what their links stretch by.

    Positive where the mass has moved inward relative to the shell of that side.

    Raises
    ------
    InputError
        If the system has no absorbers.
    """
    absorbers, modal = solution.problem.system.absorber_list, solution.normal
    if solution.along is not None or (solution.problem.system.point_absorbers and not absorbers):
        raise InputError("absorbers", "strokes are read in two dimensions", "read absorber_displacement, and displacement of the shells")
    masses = absorber_displacement(solution)
    length = solution.problem.scales.length
    basis = angle_basis(np.array([one.angle for one in absorbers]), modal.shape[2], modal.shape[1])
    strokes = np.empty((len(absorbers), len(SIDES), modal.shape[3]))
    for side in range(len(SIDES)):
        shells = np.array([one.inner_shell + side for one in absorbers])
        for shell in np.unique(shells):
            there = shells == shell
            strokes[there, side] = masses.to_numpy()[there] - length * at_angles(modal[shell], basis)[:, there].T
    coordinates = {**masses.coords, "side": xr.Variable("side", list(SIDES), {"long_name": "which of the two linked shells"})}
    attributes = {"units": "m", "long_name": "displacement of the absorber's mass relative to the shell", "sign": masses.attrs["sign"]}
    return xr.DataArray(strokes, coordinates, ("absorber", "side", "time"), "absorber_stroke", attributes)
