"""What a finished run did at its links, from the forces that it kept: stretches, their rates, and the motion of the walls by modes.

The march's own scheme is applied to its own forces, so that every sum here is the one that the march made, to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import fft

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.threads import WORKERS
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.structure_spectra import StructureSpectra


@dataclass(frozen=True)
class MarchedLinks:
    """Histories of N absorbers carried by a march, dimensionless.

    Attributes
    ----------
    force, stretch, stretch_rate : ndarray, shape (2N, T)
        f, D and dD/dt of every link.
    mass_velocity, mass_acceleration : ndarray, shape (N, T)
        u, and -S/m or what the trapezoidal rule makes of u where there is no mass.
    modal_force : ndarray, shape (shells, parities, M + 1, T)
        Modal pressures of the links.
    forced_velocity : ndarray, same shape
        Velocities that they give to the walls.
    """

    force: FloatArray
    stretch: FloatArray
    stretch_rate: FloatArray
    mass_velocity: FloatArray
    mass_acceleration: FloatArray
    modal_force: FloatArray
    forced_velocity: FloatArray


@dataclass(frozen=True)
class MarchedByLaws:
    """Histories of absorbers carried by a march by laws, as means over the steps, dimensionless.

    Attributes
    ----------
    mass_acceleration : ndarray, shape (N, T)
    modal_force, forced_velocity : ndarray, shape (shells, parities, M + 1, T)
        Modal pressures of the links, and the velocities that they give to the walls.
    """

    mass_acceleration: FloatArray
    modal_force: FloatArray
    forced_velocity: FloatArray


def marched_links(
    structure: StructureSpectra, absorbers: AbsorberSet, points: InterfacePoints, force: FloatArray, displacement: FloatArray
) -> MarchedLinks:
    """Return the histories of a march from its forces (2N, T) and the displacements of its masses (N, T)."""
    dt = structure.grid.time_step
    modal = points.project(force)
    forced = convolved(structure.kernels.kernels, modal)
    moved = points.evaluate(forced)
    walls = points.evaluate(structure.linear_displacement) + trapezoidal_integral(moved, dt)
    moving = points.evaluate(structure.linear_velocity) + moved
    both = force[: absorbers.count] + force[absorbers.count :]
    heavy = absorbers.mass > 0
    acceleration = -both / np.where(heavy, absorbers.mass, 1.0)[:, None]
    velocity = trapezoidal_integral(acceleration, dt)
    if not heavy.all():
        loose = ~heavy
        velocity[loose] = trapezoidal_derivative(displacement[loose], dt)
        acceleration[loose] = trapezoidal_derivative(velocity[loose], dt)
    stretch = np.tile(displacement, (2, 1)) - walls
    return MarchedLinks(force, stretch, np.tile(velocity, (2, 1)) - moving, velocity, acceleration, modal, forced)


def marched_by_laws(
    structure: StructureSpectra, absorbers: AbsorberSet, points: InterfacePoints, force: FloatArray, displacement: FloatArray
) -> MarchedByLaws:
    """Return the histories of a march by laws, in the means over the steps, from forces (2N, T) and the masses' displacements (N, T)."""
    dt = structure.grid.time_step
    modal = points.project(force)
    velocity = np.diff(displacement, axis=-1, prepend=0.0) / dt
    heavy = absorbers.mass > 0
    acceleration = -(force[: absorbers.count] + force[absorbers.count :]) / np.where(heavy, absorbers.mass, 1.0)[:, None]
    acceleration[~heavy] = trapezoidal_derivative(velocity[~heavy], dt)
    return MarchedByLaws(acceleration, modal, convolved(structure.kernels.kernels, modal))


def convolved(kernels: FloatArray, inputs: FloatArray) -> FloatArray:
    """Return sum_k kernels[i, j, m, k] inputs[j, parity, m, n - k], shape (outputs, parities, M + 1, T)."""
    steps = inputs.shape[-1]
    length = fft.next_fast_len(2 * steps - 1, real=True)
    answers = fft.rfft(kernels[..., :steps], length, axis=-1, workers=WORKERS)
    spectrum = fft.rfft(inputs, length, axis=-1, workers=WORKERS)
    total = np.einsum("ijmk,jhmk->ihmk", answers, spectrum)
    return np.asarray(fft.irfft(total, length, axis=-1, workers=WORKERS)[..., :steps])


def trapezoidal_integral(rate: FloatArray, time_step: float) -> FloatArray:
    """Return x_n = x_{n-1} + (dt/2)(r_n + r_{n-1}) from x_0 = 0, along the last axis."""
    summed = np.zeros_like(rate)
    np.cumsum(0.5 * time_step * (rate[..., 1:] + rate[..., :-1]), axis=-1, out=summed[..., 1:])
    return summed


def trapezoidal_derivative(values: FloatArray, time_step: float) -> FloatArray:
    """Return r_n of x_n = x_{n-1} + (dt/2)(r_n + r_{n-1}) from r_0 = 0, along the last axis."""
    rate = np.zeros_like(values)
    slope = np.diff(values, axis=-1) * (2.0 / time_step)
    for n in range(1, values.shape[-1]):
        rate[..., n] = slope[..., n - 1] - rate[..., n - 1]
    return rate
