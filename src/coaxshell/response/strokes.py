"""Strokes of absorbers: how far their masses move relative to the shells that they hold."""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.absorbers import linked_shells
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.absorbers import SIDES, absorber_displacement
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.solver.electrodes import segment_mean
from coaxshell.solver.solution import ModalSolution


def absorber_stroke(solution: ModalSolution) -> xr.DataArray:
    """Return the strokes q_n - w(theta_n) of the absorbers in two dimensions, m, dims (absorber, side, time): what their links stretch by.

    Positive where the mass has moved inward relative to the shell of that side, whose mid-surface counts, as the mean over the arc where
    a footprint is given. NaN where there is no link; relative to a rigid core, which rests, the motion of the mass itself.

    Raises
    ------
    InputError
        If the system has no absorbers, or the run has three dimensions.
    """
    absorbers, modal = solution.problem.system.absorber_list, solution.normal
    if solution.along is not None or (solution.problem.system.point_absorbers and not absorbers):
        raise InputError("absorbers", "strokes are read in two dimensions", "read absorber_displacement, and displacement of the shells")
    masses = absorber_displacement(solution)
    length, shells = solution.problem.scales.length, solution.problem.system.shells
    orders = np.arange(float(modal.shape[2]))
    basis = angle_basis(np.array([one.angle for one in absorbers]), modal.shape[2], modal.shape[1])
    strokes = np.empty((len(absorbers), len(SIDES), modal.shape[3]))
    for n, one in enumerate(absorbers):
        for side, name in enumerate(SIDES):
            held = one.links in ("both", name)
            shell = linked_shells(one)[side] if len(shells) > 1 else 0
            arc = segment_mean(orders, (one.footprint or 0.0) / shells[shell].radius)
            wall = length * at_angles(modal[shell], basis[n : n + 1] * arc)[:, 0] if held else 0.0
            strokes[n, side] = masses.to_numpy()[n] - wall if held or one.grounded else np.nan
    coordinates = {**masses.coords, "side": xr.Variable("side", list(SIDES), {"long_name": "which of the two linked shells"})}
    attributes = {"units": "m", "long_name": "displacement of the absorber's mass relative to the shell", "sign": masses.attrs["sign"]}
    return xr.DataArray(strokes, coordinates, ("absorber", "side", "time"), "absorber_stroke", attributes)
