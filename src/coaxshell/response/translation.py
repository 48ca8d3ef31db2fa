"""The translation of a shell's section, and what its displacement is without it.

The rigid translation (X, Y) that fits the motion of the mid-surface best (least squares over the circumference) is the displacement of
the section's centre of mass: with u_x = -w cos(theta) - v sin(theta), u_y = -w sin(theta) + v cos(theta),

    X = (1/(2 pi)) oint u_x dtheta = -(W_1 + V_1)/2 of the cosines,      Y the same of the sines.

Less it, the displacement is what deforms the shell: breathing, the orders from 2 on, and of order 1 only
W_1 - (W_1 + V_1)/2 = (W_1 - V_1)/2. Nothing holds a section in an infinite fluid, so X goes on for as long as the water behind the front
flows, while the deformation is bounded.
"""

from __future__ import annotations

import numpy as np

from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response.labels import time_coordinates
from coaxshell.response.modal import displacement_gain
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.shell_model import Gain

LATE = 0.1
"""The last share of a window, over which growth is judged."""
STEADY = 0.01
"""Growth over that share, relative to what is reached, up to which a translation counts as settled."""


def section_translation(solution: ModalSolution, shell: int) -> FloatArray:
    """Return (V_1 + W_1)/2 of both parities, dimensionless, shape (parities, T): minus the translation (X, Y) in units of a."""
    total: FloatArray = solution.normal[shell, :, 1] + solution.tangential[shell, :, 1]
    return 0.5 * total


def relative_gain(solution: ModalSolution) -> Gain:
    """Return the gain of the normal displacement relative to the section's translation, m: (0, a), but (-a/2, a/2) for order 1."""
    gain = displacement_gain(solution)
    gain.v[1], gain.w[1] = -0.5 * gain.w[1], 0.5 * gain.w[1]
    return gain


def relative_tangential_gain(solution: ModalSolution) -> Gain:
    """Return the same for the tangential displacement: (a, 0), but (a/2, -a/2) for order 1."""
    gain = relative_gain(solution)
    return Gain(gain.w, gain.v)


def still_grows(solution: ModalSolution, shell: int, window: slice) -> bool:
    """Return whether the section's translation still grows at the end of a window.

    It does where its magnitude is at its largest at the last instant and has grown by more than STEADY in the last tenth.
    """
    magnitude = np.sqrt(np.sum(section_translation(solution, shell)[:, window] ** 2, axis=0))
    last = magnitude[-1]
    before = magnitude[int((1.0 - LATE) * (len(magnitude) - 1))]
    return bool(last > 0.0 and last >= magnitude.max() and last - before > STEADY * last)


def translation(solution: ModalSolution, shell: int) -> xr.DataArray:
    """Return the translation of the section of a shell, m, dims (time, direction): x towards the source direction, y a quarter turn on."""
    parities = -solution.problem.scales.length * section_translation(solution, shell)
    values = np.zeros((parities.shape[1], 2))
    values[:, : len(parities)] = parities.T
    label = shell_name(shell, len(solution.problem.shells))
    return xr.DataArray(
        values,
        dims=("time", "direction"),
        coords={**time_coordinates(solution), "direction": ["x", "y"]},
        name="translation",
        attrs={"units": "m", "long_name": "translation of the section", "shell": shell, "shell_name": label},
    )
