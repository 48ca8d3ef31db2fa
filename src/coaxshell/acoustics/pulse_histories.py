"""Pressure histories of the pulses in time, and their integrals, in dimensionless time and pressure: zero before t = 0."""

from __future__ import annotations

import math

import numpy as np
from scipy.special import erf

from coaxshell.model.pulses import Exponential, Gaussian, Pulse, Sampled, Step
from coaxshell.numerics.arrays import FloatArray


def pulse_history(pulse: Pulse, t: FloatArray, time_scale: float, pressure_scale: float) -> FloatArray:
    """Return the pulse f(t) at dimensionless times, of the shape of t.

    Parameters
    ----------
    pulse : Pulse
        Description in SI.
    t : ndarray
    time_scale, pressure_scale : float
        a/c_e in s and rho_e c_e^2 in Pa.
    """
    seconds = np.maximum(t, 0.0) * time_scale
    match pulse:
        case Exponential():
            pressure = pulse.peak_pressure * np.exp(-seconds / pulse.decay_time)
        case Step():
            rise = np.minimum(seconds / pulse.rise_time, 1.0) if pulse.rise_time > 0 else np.ones_like(seconds)
            pressure = pulse.pressure * rise
        case Gaussian():
            pressure = pulse.peak_pressure * np.exp(-0.5 * ((seconds - pulse.centre) / pulse.width) ** 2)
        case Sampled():
            pressure = np.interp(seconds, *pulse.curve, left=0.0, right=0.0)
    return np.asarray(np.where(t >= 0, pressure, 0.0) / pressure_scale, dtype=np.float64)


def pulse_corners(pulse: Pulse, time_scale: float, most: int = 16) -> FloatArray:
    """Return the dimensionless times after its start at which a pulse jumps or bends, ascending; of many the sharpest."""
    match pulse:
        case Step() if pulse.rise_time > 0:
            return np.array([pulse.rise_time / time_scale])
        case Sampled():
            times, values = pulse.curve
            slopes = np.diff(values) / np.diff(times)
            bends = np.append(np.abs(np.diff(slopes, prepend=0.0)), np.inf if values[-1] else np.abs(slopes[-1]))
            bends[0] = np.inf if values[0] else bends[0]
            there = np.flatnonzero((bends > 1e-12 * np.abs(slopes).max()) & (times > 0.0))
            return np.sort(times[there[np.argsort(-bends[there], kind="stable")[:most]]]) / time_scale
    return np.empty(0)


def pulse_impulse(pulse: Pulse, t: FloatArray, time_scale: float, pressure_scale: float) -> FloatArray:
    """Return the integral of the pulse from 0 to t, dimensionless, of the shape of t."""
    seconds = np.maximum(t, 0.0) * time_scale
    match pulse:
        case Exponential():
            impulse = -pulse.peak_pressure * pulse.decay_time * np.expm1(-seconds / pulse.decay_time)
        case Step():
            ramp = np.minimum(seconds, pulse.rise_time)
            impulse = pulse.pressure * (seconds - ramp + (ramp**2 / (2.0 * pulse.rise_time) if pulse.rise_time > 0 else 0.0))
        case Gaussian():
            root = math.sqrt(2.0) * pulse.width
            rise = erf((seconds - pulse.centre) / root) + math.erf(pulse.centre / root)
            impulse = pulse.peak_pressure * pulse.width * math.sqrt(math.pi / 2.0) * rise
        case Sampled():
            impulse = _sampled_impulse(*pulse.curve, seconds)
    return np.asarray(impulse / (pressure_scale * time_scale), dtype=np.float64)


def _sampled_impulse(times: FloatArray, values: FloatArray, seconds: FloatArray) -> FloatArray:
    """Integral of the piecewise-linear history, exact: quadratic between samples."""
    inside = np.clip(seconds, times[0], times[-1])
    until = np.concatenate([[0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(times))])
    index = np.clip(np.searchsorted(times, inside, side="right") - 1, 0, times.size - 2)
    elapsed = inside - times[index]
    share = elapsed / (times[index + 1] - times[index])
    return np.asarray(until[index] + elapsed * (values[index] + 0.5 * share * (values[index + 1] - values[index])), dtype=np.float64)
