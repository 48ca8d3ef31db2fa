"""The band of a pulse: the frequency below which nine tenths of its energy lie; and how long it lasts."""

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
            return _sampled_band(*pulse.curve)
        case Step():
            return 0.0


def _sampled_band(times: np.ndarray, pressures: np.ndarray) -> float:
    uniform, step = np.linspace(times[0], times[-1], _POINTS, retstep=True)
    energy = np.abs(np.fft.rfft(np.interp(uniform, times, pressures), 4 * _POINTS)) ** 2
    total = np.cumsum(0.5 * (energy[1:] + energy[:-1]))
    if total[-1] <= 0.0:
        return 0.0
    return float(np.searchsorted(total, SHARE * total[-1]) + 1) / (4 * _POINTS * float(step))


def pulse_end(pulse: Pulse) -> float:
    """Return when the pulse is over, s: at its last sample, when it has fallen to a hundredth of its peak, or when a step is reached."""
    match pulse:
        case Exponential():
            return math.log(100.0) * pulse.decay_time
        case Gaussian():
            return pulse.centre + math.sqrt(2.0 * math.log(100.0)) * pulse.width
        case Sampled():
            return float(pulse.curve[0][-1])
        case Step():
            return pulse.rise_time


def largest_after(pulse: Pulse, moment: float) -> float:
    """Return the largest magnitude of the pressure after a moment (s), Pa; of a step what its rise has still to bring."""
    match pulse:
        case Exponential():
            return pulse.peak * math.exp(-max(moment, 0.0) / pulse.decay_time)
        case Gaussian():
            return pulse.peak * math.exp(-0.5 * (max(moment - pulse.centre, 0.0) / pulse.width) ** 2)
        case Step():
            return pulse.peak * max(0.0, 1.0 - moment / pulse.rise_time) if pulse.rise_time > moment else 0.0
        case Sampled():
            times, values = pulse.curve[0], np.abs(pulse.curve[1])
            later = values[times > moment]
            if not later.size:
                return 0.0
            return float(max(later.max(), np.interp(moment, times, values)))
