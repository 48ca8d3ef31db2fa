"""Laplace transforms of the pressure histories that a source can have, in dimensionless time and pressure."""

from __future__ import annotations

import math

import numpy as np
from scipy.special import erfcx

from coaxshell.acoustics.sampled_transforms import is_long, piecewise_linear
from coaxshell.model.pulses import Exponential, Gaussian, Pulse, Sampled, Step
from coaxshell.numerics.arrays import ComplexArray


def pulse_transform(pulse: Pulse, s: ComplexArray, time_scale: float, pressure_scale: float) -> ComplexArray:
    """Return the transform of a pulse at dimensionless Laplace nodes.

    Parameters
    ----------
    pulse : Pulse
        Description in SI.
    s : ndarray
        Laplace variable of dimensionless time.
    time_scale, pressure_scale : float
        a/c_e in s and rho_e c_e^2 in Pa.
    """
    match pulse:
        case Exponential():
            return pulse.peak_pressure / pressure_scale / (s + time_scale / pulse.decay_time)
        case Step():
            return pulse.pressure / pressure_scale * _ramp(s, pulse.rise_time / time_scale)
        case Gaussian():
            width, centre = pulse.width / time_scale, pulse.centre / time_scale
            return pulse.peak_pressure / pressure_scale * _gaussian(s, width, centre)
        case Sampled():
            return _record(pulse, s, time_scale, pressure_scale)
    raise TypeError(f"no transform for a pulse of type {type(pulse).__name__}")


def _record(pulse: Sampled, s: ComplexArray, time_scale: float, pressure_scale: float) -> ComplexArray:
    """Return the transform of a record; that of a long one is made once for all nodes of a contour, and kept as long as the record.

    A run asks for it at the nodes of its spectra, of its estimates and of the pressures on its walls, of which the first are all.
    """
    times, values = pulse.curve
    if not is_long(s, times):
        return piecewise_linear(s, times / time_scale, values / pressure_scale)
    contour = np.array([s[0].real, s[1].imag, time_scale, pressure_scale])
    for known, spectrum in pulse.transforms:
        if spectrum.size >= s.size and np.allclose(known, contour, rtol=1e-12, atol=0.0):
            return np.asarray(spectrum[: s.size])
    made = piecewise_linear(s, times / time_scale, values / pressure_scale)
    made.flags.writeable = False
    pulse.transforms.append((contour, made))
    return made


def _ramp(s: ComplexArray, rise: float) -> ComplexArray:
    """Unit step reached linearly within ``rise``: (1 - e^{-z})/(z s) with z = s rise, or 1/s."""
    z = s * rise
    still = z == 0.0
    return np.asarray(np.where(still, 1.0, -np.expm1(-z) / np.where(still, 1.0, z)) / s, dtype=np.complex128)


def _gaussian(s: ComplexArray, width: float, centre: float) -> ComplexArray:
    """exp(-(t - centre)^2/(2 width^2)) for t > 0, by the scaled complementary error function (DLMF 7.2)."""
    argument = (s * width**2 - centre) / (math.sqrt(2.0) * width)
    scale = width * math.sqrt(math.pi / 2.0)
    left = argument.real < 0  # erfc(-x) = 2 - erfc(x): keeps erfcx bounded
    value = np.empty_like(s)
    front = math.exp(-(centre**2) / (2.0 * width**2))
    value[~left] = front * erfcx(argument[~left])
    turned = s[left] * (0.5 * s[left] * width**2 - centre)  # argument^2 less centre^2/(2 width^2), which may be any size
    value[left] = 2.0 * np.exp(turned) - front * erfcx(-argument[left])
    return scale * value
