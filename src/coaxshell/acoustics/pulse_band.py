"""The band of a pulse: the frequency below which nine tenths of its energy lie."""

from __future__ import annotations

import math

import numpy as np
from scipy.special import erfinv

from coaxshell.model.pulses import Exponential, Gaussian, Pulse, Sampled, Step

SHARE = 0.9
_POINTS = 1 << 14


def pulse_band(pulse: Pulse) -> float:
    """Return f with int_0^f |p^|^2 df = SHARE int_0^inf |p^|^2 df, Hz; 0 for a step, whose energy lies at the lowest frequencies.

    With omega = 2 pi f: an exponential decay in tau has |p^|^2 ~ 1/(1 + (omega tau)^2), so omega tau = tan(pi SHARE/2); a Gaussian of
    deviation w has |p^|^2 ~ exp(-(omega w)^2), so erf(omega w) = SHARE; a sampled history is summed by FFT.
    """
    match pulse:
        case Exponential():
            return math.tan(0.5 * math.pi * SHARE) / (2.0 * math.pi * pulse.decay_time)
        case Gaussian():
            return float(erfinv(SHARE)) / (2.0 * math.pi * pulse.width)
        case Sampled():
            return _sampled_band(np.asarray(pulse.time), np.asarray(pulse.pressure))
        case Step():
            return 0.0


def _sampled_band(times: np.ndarray, pressures: np.ndarray) -> float:
    uniform, step = np.linspace(times[0], times[-1], _POINTS, retstep=True)
    energy = np.abs(np.fft.rfft(np.interp(uniform, times, pressures), 4 * _POINTS)) ** 2
    total = np.cumsum(0.5 * (energy[1:] + energy[:-1]))
    if total[-1] <= 0.0:
        return 0.0
    return float(np.searchsorted(total, SHARE * total[-1]) + 1) / (4 * _POINTS * float(step))
