"""Fourier transforms of histories of a run, absolute or per incident pressure spectrum.

    X(f) = integral of x(t) e^{-2 pi i f t} dt over the run,

by the trapezoidal rule at its instants: exact, but for aliases, for a history within the run's band that has died away before its end.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.errors import InputError, PhysicsWarning
from coaxshell.model.base import shown
from coaxshell.model.sources import Source
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.scalars import plain
from coaxshell.response import arguments
from coaxshell.response.shock_spectrum import frequencies_of

NYQUIST = 0.4
"""Highest frequency times the step: where the roll-off of a run's band begins."""
LAST = 0.05
"""Part of the run, at its end, in which what is left is looked for."""
LEFT = 0.01
"""Share of the largest value above which what is left is told."""
_BLOCK = 2**22


def history_spectrum(
    history: xr.DataArray, sources: Sequence[Source], frequency: npt.ArrayLike | None, per: str = "absolute", source: int | None = None
) -> xr.DataArray:
    """Return the Fourier transform of a history, with dim frequency in the place of time.

    Parameters
    ----------
    history : DataArray
        With a dim time and the coordinate time_seconds, evenly spaced.
    sources : sequence of Source
        Of the run.
    frequency : array_like, optional
        Hz, above 0; multiples of one over the duration up to 0.4/(time step) unless given.
    per : str
        "absolute": in the unit of the history per Hz; "incident": per pressure spectrum of a source at the head in free field.
    source : int, optional
        Its number, where there are several.

    Raises
    ------
    InputError
        An argument is not allowed, or a frequency is above 0.4/(time step).
    """
    arguments.one_of("per", per, ("absolute", "incident"))
    time = _instants(history)
    step = (time[-1] - time[0]) / (time.size - 1)
    hertz = frequencies_of(frequency)
    if hertz is None:
        hertz = np.arange(1, int(NYQUIST * time.size)) / (step * time.size)
    elif hertz.max() > NYQUIST / step:
        limit = f"is above {NYQUIST / step:.4g} Hz, what the time step {step:.3g} s resolves"
        raise InputError("frequency", f"{hertz.max():g} Hz {limit}", "give lower ones, or run with a smaller time_step")
    each = np.atleast_1d(hertz)
    incident = _incident(sources, source, each) if per == "incident" else None
    values = np.moveaxis(history.to_numpy(), history.dims.index("time"), 0)
    found = transform(time, values.reshape(time.size, -1), None if frequency is None else each)
    attrs = {**history.attrs, "time_dependence": "exp(i omega t)"}
    name, unit = attrs.get("long_name", str(history.name)), attrs.get("units", "")
    if incident is not None:
        found /= incident[:, None]
        attrs |= {"long_name": f"{name} per incident pressure", "units": "1" if unit == "Pa" else f"{unit}/Pa"}
    else:
        attrs |= {"long_name": f"{name}, spectrum", "units": f"{unit}/Hz"}
    left = _left(values)
    attrs["left_at_the_end"] = left
    if left > LEFT:
        blur, share = 1.0 / (time[-1] - time[0]), 100.0 * left
        told = (
            f"duration: {share:.2g} % of the largest {name} is left in the last {100.0 * LAST:g} % of the run: the spectrum is that of a "
            f"history cut there, blurred over {blur:.3g} Hz; run longer, or use frequency_response, which needs no end"
        )
        warnings.warn(told, PhysicsWarning, stacklevel=3)
        attrs["warnings"] = told
    rest = [dim for dim in history.dims if dim != "time"]
    coords = {key: value for key, value in history.coords.items() if "time" not in value.dims}
    coords["frequency"] = xr.Variable("frequency", each, {"units": "Hz", "long_name": "frequency"})
    dims, full = ["frequency", *rest], found.reshape(each.size, *values.shape[1:])
    shaped = xr.DataArray(full, dims=dims, coords=coords, name=history.name, attrs=attrs)
    return shaped if hertz.ndim else shaped.isel(frequency=0)


def transform(time: FloatArray, values: FloatArray, hertz: FloatArray | None) -> ComplexArray:
    """Return the transforms of histories (T, n), shape (F, n), by the trapezoidal rule.

    Parameters
    ----------
    time : ndarray, shape (T,)
        s, evenly spaced.
    values : ndarray, shape (T, n)
    hertz : ndarray, shape (F,), or None
        None for multiples of one over T steps, by the fast transform.
    """
    weights = np.full(time.size, (time[-1] - time[0]) / (time.size - 1))
    weights[[0, -1]] *= 0.5
    weighted = values * weights[:, None]
    if hertz is None:
        count = int(NYQUIST * time.size)
        turned = np.arange(1, count) * (time[0] / (weights[1] * time.size))
        return np.asarray(np.fft.rfft(weighted, axis=0)[1:count] * np.exp(-2j * np.pi * turned)[:, None])
    found = np.empty((hertz.size, values.shape[1]), np.complex128)
    width = max(1, _BLOCK // time.size)
    for start in range(0, hertz.size, width):
        some = slice(start, start + width)
        found[some] = np.exp(-2j * np.pi * np.multiply.outer(hertz[some], time)) @ weighted
    return found


def _instants(history: xr.DataArray) -> FloatArray:
    """Return the instants of a history, s; InputError if it is none, or they are not evenly spaced."""
    if not isinstance(history, xr.DataArray) or "time" not in history.dims or "time_seconds" not in history.coords:
        raise InputError("quantity", "is no history", 'give the name of a quantity, or what the response gave: r.stress("inner", angle=0)')
    time = np.asarray(history["time_seconds"].to_numpy(), dtype=np.float64)
    if time.size < 5 or np.ptp(np.diff(time)) > 1e-6 * (time[-1] - time[0]) / (time.size - 1):
        raise InputError("quantity", f"{time.size} instants that are not evenly spaced have no spectrum", "read it at the run's own times")
    return time


def _incident(sources: Sequence[Source], source: int | None, hertz: FloatArray) -> ComplexArray:
    """Return the pressure spectrum of a source at the head in free field, Pa/Hz."""
    number = 0 if source is None and len(sources) == 1 else plain(source)
    if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < len(sources):
        value = f"{shown(source)} is not allowed" if source is not None else f"there are {len(sources)}, and an answer belongs to one"
        raise InputError("source", value, f"give a number from 0 to {len(sources) - 1}")
    s = np.asarray((1e-12 + 1j) * 2.0 * np.pi * hertz)
    one = sources[number]
    return np.asarray(pulse_transform(one.pulse, s, 1.0, 1.0) * np.exp(-s * one.delay))


def _left(values: FloatArray) -> float:
    """Return the largest magnitude near the end over that of the whole history, of the place where it is most."""
    magnitude = np.abs(values).reshape(len(values), -1)
    largest = magnitude.max(axis=0)
    end = magnitude[-max(2, int(LAST * len(values))) :].max(axis=0)
    return float(np.divide(end, largest, out=np.zeros_like(end), where=largest > 0.0).max(initial=0.0))
