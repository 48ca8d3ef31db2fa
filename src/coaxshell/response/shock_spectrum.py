r"""Shock response spectra of points of a shell: what it does to small equipment that it carries.

Equipment is an oscillator (natural frequency f, Q = 1/(2 zeta)) too light to be felt by the shell; its base moves as the shell does. Its
displacement z relative to the shell obeys z'' + 2 zeta omega z' + omega^2 z = -a(t), a the acceleration of the shell, which is taken linear
between the instants of the run (:mod:`coaxshell.numerics.oscillators`). At each frequency the spectrum is the largest value of

    z ("relative-displacement"),   omega z ("pseudo-velocity"),   z'' + a ("absolute-acceleration")

while the run lasts ("primary"), in the free vibration if the shell stopped accelerating at its end ("residual"), or in both ("overall").
"""

from __future__ import annotations

import math
from typing import Literal, TypedDict, get_args

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.places import shell_name
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.finite import require_finite
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.oscillators import KINDS, Kind, Oscillators
from coaxshell.numerics.scalars import plain
from coaxshell.response import arguments
from coaxshell.response.histories import shell_acceleration
from coaxshell.response.labels import angle_coordinate
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.solution import ModalSolution

Extreme = Literal["maximax", "positive", "negative"]
During = Literal["overall", "primary", "residual"]


class SpectrumOptions(TypedDict, total=False):
    """Options of a shock response spectrum by name; see :func:`shock_spectrum`."""

    quality_factor: float
    kind: Kind
    extreme: Extreme
    during: During
    component: str


UNITS = {"relative-displacement": "m", "pseudo-velocity": "m/s", "absolute-acceleration": "m/s^2"}
COUNT = 120
"""Frequencies unless any are given."""
_PER_SAMPLE = 0.1
"""Highest frequency unless given, times the step: ten instants a cycle."""
_NYQUIST = 0.4
"""Highest frequency that is allowed, times the step: where the roll-off of a run's band begins."""


def shock_spectrum(
    motion: WallMotion,
    shell: int,
    angle: npt.ArrayLike,
    frequency: npt.ArrayLike | None = None,
    *,
    quality_factor: float = 10.0,
    kind: Kind = "pseudo-velocity",
    extreme: Extreme = "maximax",
    during: During = "overall",
    component: str = "normal",
) -> xr.DataArray:
    """Return the shock response spectrum at angles of a shell.

    Parameters
    ----------
    motion : WallMotion
    shell : int
    angle : array_like, shape () or (A,)
        Degrees from the source direction.
    frequency : array_like, optional
        Natural frequencies of the oscillators, Hz; 120 from one cycle in four runs to ten instants a cycle unless given.
    quality_factor : float
        Q = 1/(2 zeta), above 1/2: 10 is a damping of 5 %.
    kind : str
        "pseudo-velocity" (m/s), "absolute-acceleration" (m/s^2) or "relative-displacement" (m).
    extreme : str
        "maximax" (the largest magnitude), "positive" or "negative" (as magnitudes; positive inward as the shell's motion).
    during : str
        "overall", "primary" (while the run lasts) or "residual" (in the free vibration after it).
    component : str
        "normal" or "tangential" motion of the shell.

    Returns
    -------
    DataArray, dims (frequency, angle)

    Raises
    ------
    InputError
        An argument is not allowed, a frequency is above 0.4/(time step), or instants of the run are missing.
    """
    for name, value, allowed in (("kind", kind, KINDS), ("extreme", extreme, get_args(Extreme)), ("during", during, get_args(During))):
        arguments.one_of(name, value, allowed)
    theta = arguments.angles(angle)
    step = motion.solution.settings.time_step * motion.solution.problem.scales.time
    quality, hertz = quality_of(quality_factor), frequencies_of(frequency)
    if hertz is None:
        hertz = np.geomspace(0.25 / (step * (motion.solution.time.size - 1)), _PER_SAMPLE / step, COUNT)
    elif hertz.max() > _NYQUIST / step:
        limit = f"is above {_NYQUIST / step:.4g} Hz, what the time step {step:.3g} s resolves"
        raise InputError("frequency", f"{hertz.max():g} Hz {limit}", "give lower ones, or run with a smaller time_step")
    oscillators = Oscillators(np.atleast_1d(hertz), quality, step)
    distinct, places = _distinct(np.atleast_1d(theta), mirrored=component == "normal" and motion.solution.normal.shape[1] == 1)
    base = shell_acceleration(motion, shell, distinct, component)
    series = np.ascontiguousarray(base.to_numpy().T)
    end = oscillators.at_the_end(series)
    found = oscillators.after(end, kind) if during == "residual" else oscillators.during(series, end, kind)
    if during == "overall":
        found = found.joined(oscillators.after(end, kind))
    sides = {"positive": found.largest, "negative": -found.smallest, "maximax": np.maximum(found.largest, -found.smallest)}
    return _labelled(
        motion.solution, sides[extreme][:, places], oscillators.frequency, theta, shell, (kind, extreme, during, component, quality)
    )


def _distinct(theta: FloatArray, *, mirrored: bool) -> tuple[FloatArray, npt.NDArray[np.intp]]:
    """Return the angles that differ, each once, and which of them each is; theta and -theta are one where halves are mirror images."""
    return np.unique(np.abs((theta + 180.0) % 360.0 - 180.0) if mirrored else theta, return_inverse=True)


def frequencies_of(frequency: npt.ArrayLike | None) -> FloatArray | None:
    """Return natural frequencies, Hz, None for those that a run chooses; InputError if one is none."""
    if frequency is None:
        return None
    remedy = "give one number or a list of them, in Hz"
    try:
        values = np.asarray(frequency, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("frequency", f"{shown(frequency)} is not a number or a list of numbers", remedy) from None
    if values.ndim > 1 or values.size == 0:
        raise InputError("frequency", f"an array of shape {values.shape} is not allowed", remedy)
    allowed = np.isfinite(values) & (values > 0.0)
    if not np.all(allowed):
        raise InputError("frequency", f"{values[~allowed].flat[0]:g} Hz is not allowed", "give frequencies above 0")
    return values


def quality_of(value: object) -> float:
    """Return Q; InputError if it is no number above 1/2."""
    number = plain(value)
    if isinstance(number, bool) or not isinstance(number, int | float) or not math.isfinite(number) or number <= 0.5:
        raise InputError("quality_factor", f"{shown(value)} is not allowed", "give a number above 1/2; 10 is a damping of 5 %")
    return float(number)


def _labelled(
    solution: ModalSolution,
    values: FloatArray,
    frequency: FloatArray,
    theta: FloatArray,
    shell: int,
    told: tuple[str, str, str, str, float],
) -> xr.DataArray:
    kind, extreme, during, component, quality = told
    places = [("frequency", frequency), ("angle", np.atleast_1d(theta))]
    require_finite(values, "shock spectrum", places, "look for extreme layers or materials")
    name = shell_name(shell, len(solution.problem.shells))
    return xr.DataArray(
        values if theta.ndim else values[:, 0],
        dims=("frequency", "angle") if theta.ndim else ("frequency",),
        coords={
            "frequency": xr.Variable("frequency", frequency, {"units": "Hz", "long_name": "natural frequency"}),
            "angle": angle_coordinate(theta),
        },
        name=kind.replace("-", "_"),
        attrs={
            "units": UNITS[kind],
            "long_name": f"shock response spectrum, {kind.replace('-', ' ')}",
            "extreme": extreme,
            "during": during,
            "component": component,
            "quality_factor": quality,
            "shell": shell,
            "shell_name": name,
        },
    )
