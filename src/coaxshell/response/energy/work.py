"""The pressure on the outermost surface, taken apart into incident, rigidly scattered and radiated, and the work that each of them does.

Work is integrated over time exactly rather than by a quadrature of samples. Inverted from the grid's nodes, a modal history is
e^{sigma t} times a trigonometric polynomial. The power of a pressure on a velocity is then e^{2 sigma t} times another one of twice the
bandwidth, which is sampled without loss at half the time step and integrated term by term,

    P(t) = e^{2 sigma t} sum_j q_j e^{i omega_j t},    integral of P = e^{2 sigma t} sum_j q_j e^{i omega_j t}/(2 sigma + i omega_j).

(Simpson's rule at the time step of the paper is off by 3e-6 of the work on the bare system: pressures start with a kink.)
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy import fft

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.threads import WORKERS
from coaxshell.response.energy.motion import Motion


class SurfacePressures(NamedTuple):
    """Transforms of the modal pressures on the outermost surface; incident and scattered may lack sines that are zero.

    Attributes
    ----------
    incident, scattered : ndarray, shape (1 or 2, M + 1, nodes)
        Of the undisturbed wave, and of the wave that a rigid cylinder would add.
    radiated : ndarray, shape (parities, M + 1, nodes)
        Of the surface's own motion.
    """

    incident: ComplexArray
    scattered: ComplexArray
    radiated: ComplexArray


def surface_pressures(motion: Motion) -> SurfacePressures:
    """Return the three parts of the pressure on the outermost surface."""
    s = motion.grid.nodes
    radial = RadialBasis(motion.modes, s)
    surface = radial(1.0, motion.problem.head)
    incident, slope = motion.incident(radial)
    outermost = motion.normal[-1] if motion.solid is None else motion.solid.faces[1, -1]
    return SurfacePressures(incident, -surface.exterior * slope, surface.exterior * s**2 * outermost)


_LEAD = 64
"""Steps before t = 0 from which work is counted: the roll-off of the spectra lets histories start a few steps early."""


class SurfaceWork:
    """Cumulative work of modal pressures on one surface that moves with a modal velocity.

    Parameters
    ----------
    grid : LaplaceGrid
    weight : ndarray, shape (M + 1,)
        Integral over the surface of cos^2(m theta): beta pi times its radius.
    velocity : ndarray, shape (parities, M + 1, nodes)
        Transforms of the velocity, in the direction in which the pressures push.
    """

    def __init__(self, grid: LaplaceGrid, weight: FloatArray, velocity: ComplexArray) -> None:
        self._grid, self._weight = grid, weight
        self._velocity = [self._damped(parity) for parity in velocity]

    def _damped(self, spectrum: ComplexArray) -> FloatArray:
        """Return e^{-sigma t} times the histories over the whole period, at half the time step."""
        grid, double = self._grid, 2 * self._grid.samples
        histories = fft.irfft(spectrum * grid.taper(), double, axis=-1, workers=WORKERS, overwrite_x=True)
        histories *= 2.0 / grid.time_step
        return np.asarray(histories, dtype=np.float64)

    def __call__(self, pressure: ComplexArray) -> FloatArray:
        """Return the work done since before the shock at the grid's times, shape (T,), of pressures (parities, M + 1, nodes)."""
        power = np.zeros(2 * self._grid.samples)
        for parity, velocity in zip(pressure, self._velocity, strict=False):  # a missing parity is zero
            power += np.einsum("m,mt,mt->t", self._weight, self._damped(parity), velocity)
        return self._integral(power)

    def _integral(self, damped: FloatArray) -> FloatArray:
        grid, count = self._grid, damped.size
        frequency = grid.frequency_step * np.arange(count // 2 + 1)
        primitive = fft.irfft(fft.rfft(damped) / (2.0 * grid.shift + 1j * frequency), count)
        before = primitive[count - 2 * _LEAD] * np.exp(-2.0 * grid.shift * _LEAD * grid.time_step)
        work: FloatArray = primitive[: 2 * grid.steps + 1 : 2] * np.exp(2.0 * grid.shift * grid.time) - before
        return work
