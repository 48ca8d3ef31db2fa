"""The slip of the diffracted pressure away from the shell (Eq. B.13): its front without the delay."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.model import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.fields.incident import Incident
from coaxshell.solver.scaling import Problem, dimensionless


def scattering_delay(system: System, radius: npt.ArrayLike, angle: npt.ArrayLike, time: npt.ArrayLike) -> FloatArray:
    """Return the pressure that the printed P^(d) adds outside the shell, Pa, shape (times, radii, angles).

    xi^(e) jumps to 1/sqrt(r) at t = r - 1, so that P^(d) begins with -b_m(t - (r - 1))/sqrt(r); printed is -b_m(t)/sqrt(r). Summed
    over the orders, with v0 the outward velocity of the incident wave at r = 1, the difference is
    -[v0(theta, t) - v0(theta, t - (r - 1))]/sqrt(r). It vanishes at r = 1.

    Parameters
    ----------
    system : System
    radius : array_like
        From 1 up, in units of the outer radius.
    angle : array_like
        Degrees from the direction theta = 0.
    time : array_like
        Transits.
    """
    problem = dimensionless(system)
    r, theta, t = np.atleast_1d(radius), np.radians(np.atleast_1d(angle)), np.atleast_1d(time)
    now = np.stack([_outward(problem, theta, instant) for instant in t])[:, None, :]
    then = np.stack([[_outward(problem, theta, instant - (reach - 1.0)) for reach in r] for instant in t])
    added: FloatArray = -(now - then) / np.sqrt(r)[:, None] * problem.scales.pressure
    return added


def _outward(problem: Problem, theta: FloatArray, time: float) -> FloatArray:
    """Return the outward velocity of the incident waves on the shell, units of c_e."""
    x, y = np.cos(theta), np.sin(theta)
    along, across = Incident(problem, x, y, max(float(time), 0.0)).velocity(float(time))
    return np.asarray(along * x + across * y)
