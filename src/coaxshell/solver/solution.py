"""What every engine returns: modal histories in dimensionless form, and how far to trust them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import Settings

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Estimates:
    """Relative errors estimated by the engine itself, each relative to the L2 norm over the surface and the whole time.

    Attributes
    ----------
    modal_displacement, modal_stress : ndarray, shape (shells,)
        What the orders above M would add to the displacement and to the mid-surface stress of each shell.
    time_window : float
        Wrap-around and band limit of the inverse Laplace transform, relative to the largest displacement.
    """

    modal_displacement: FloatArray
    modal_stress: FloatArray
    time_window: float


@dataclass(frozen=True)
class ModalSolution:
    """Modal histories of one run; all arrays dimensionless (lengths in a, times in a/c_e).

    Attributes
    ----------
    problem : Problem
        The dimensionless problem that was solved, with its scales.
    settings : Settings
        Resolution, with ``modes`` resolved to a number.
    time : ndarray, shape (T,)
        Times from 0 in steps of the time step.
    normal : ndarray, shape (shells, halves, M + 1, T)
        W: w = sum_m W[.,0,m] cos(m theta) + W[.,1,m] sin(m theta), positive inward. ``halves`` is 1 when the sine half vanishes.
    tangential : ndarray, same shape
        V: v = sum_m V[.,0,m] sin(m theta) - V[.,1,m] cos(m theta), so that dv/dtheta = sum m (V0 cos + V1 sin).
    estimates : Estimates
    warnings : tuple of str
        Physics warnings, one sentence each with both numbers and the remedy.
    timings : dict
        Seconds by stage.
    normal_rate, tangential_rate : ndarray, same shape, or None
        dW/dt and dV/dt, kept where feedback needs them.
    absorber_displacement : ndarray, shape (absorbers, T)
        q_n.
    absorber_force : ndarray, shape (absorbers, 2, T)
        Line force f_n^(i)/(rho_e c_e^2 a) on the inner [0] and outer [1] of the shells it links, positive inward on the shell.
    control_correction : ndarray, shape (shells, halves, M + 1, T), or None
        Modal pressure of the saturated minus that of the linear control law, where saturation is on.
    """

    problem: Problem
    settings: Settings
    time: FloatArray
    normal: FloatArray
    tangential: FloatArray
    estimates: Estimates
    warnings: tuple[str, ...] = ()
    timings: dict[str, float] = field(default_factory=dict)
    normal_rate: FloatArray | None = None
    tangential_rate: FloatArray | None = None
    absorber_displacement: FloatArray | None = None
    absorber_force: FloatArray | None = None
    control_correction: FloatArray | None = None
