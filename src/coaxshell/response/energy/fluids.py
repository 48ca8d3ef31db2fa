"""Energy of the enclosed fluids, integrated from the field itself: pressure and particle velocity of every order at many radii.

In a fluid of density ratio rho and slowness alpha, with Pi = p/s the time integral of the pressure (rho v = -grad Pi),

    E = (1/(2 rho)) sum_m beta pi integral of [alpha^2 p_m^2 + (dPi_m/dr)^2 + (m Pi_m/r)^2] r dr,

exact in theta by Parseval, by Gauss-Legendre points in r. Nothing here knows the work done at the walls.

How much of the spectrum and how many radii it needs: waves of phase h across the region (frequency times slowness times width) make an
energy density with 2 h/(2 pi) periods, which h/2 Gauss points integrate. Nearly all the energy lies far below the highest frequency, so
the whole band would be a waste. The field is kept up to the frequency above which a part NEGLIGIBLE of the walls' kinetic energy lies,
with a roll-off around it: what is left out meets what is kept only within the roll-off, so the energy loses a part of about that size.
Full resolution is given to frequencies up to the one above which a part FAINT lies, half as much to the rest.

Every K-th instant of the many modal histories comes from their transforms without the instants between: a sum over the nodes at the
times n K dt does not see multiples of the frequency 2 pi/(K dt), so nodes that differ by one are added up first, and a short FFT does
the rest. K need not divide the number of samples; its greatest common divisor with it does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy import fft

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.acoustics.operators import annulus_amplitudes
from coaxshell.acoustics.radial_fields import annulus_field, disc_field
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.progress import ShareDone
from coaxshell.numerics.radial_functions import RadialFunctions
from coaxshell.numerics.threads import WORKERS
from coaxshell.response.energy.motion import Motion
from coaxshell.solver.scaling import FluidRegion


class Sampler:
    """The instants 0, K, 2 K, ... of histories whose transforms are known at the lowest nodes of a grid.

    Parameters
    ----------
    grid : LaplaceGrid
    every : int
        K.
    """

    def __init__(self, grid: LaplaceGrid, every: int) -> None:
        divisor = math.gcd(every, grid.samples)
        self.length = grid.samples // divisor
        times = grid.time[::every]
        self._gain = np.exp(grid.shift * times) / (grid.time_step * divisor)
        self._instants = slice(0, 1 + (times.size - 1) * (every // divisor), every // divisor)

    def blocks(self, count: int, width: int) -> Iterator[slice]:
        """Yield slices of the nodes 0..count - 1 of at most *width*, none of them across a multiple of the short length."""
        start = 0
        while start < count:
            stop = min(start + width, count, (start // self.length + 1) * self.length)
            yield slice(start, stop)
            start = stop

    def add(self, total: ComplexArray, spectrum: ComplexArray, block: slice) -> None:
        """Add the transforms at one block of nodes to the sums (..., length), in place."""
        start = block.start % self.length
        total[..., start : start + spectrum.shape[-1]] += spectrum

    def finish(self, total: ComplexArray) -> FloatArray:
        """Return the histories at the instants; nodes above the lowest must have been counted twice, for their conjugates."""
        mirrored = total[..., -np.arange(self.length // 2 + 1)]
        hermitian = 0.5 * (total[..., : self.length // 2 + 1] + mirrored.conj())  # real part of the sum, by a real transform
        samples = fft.irfft(hermitian, self.length, axis=-1, overwrite_x=True)[..., self._instants]
        return np.asarray(samples * self._gain, dtype=np.float64)


NEGLIGIBLE, FAINT = 4e-7, 1e-5

MAX_RADII = 500

_FULL, _NONE = 0.9, 1.2
"""The roll-off begins and ends at these multiples of the frequency."""


class Band(NamedTuple):
    """What is kept of the spectrum in one region.

    Attributes
    ----------
    window : ndarray, shape (nodes kept,)
        Weights of the lowest nodes of the grid; all but the first count double, for their conjugates.
    highest, strong : float
        Frequencies at which the window ends and above which a part FAINT of the walls' energy lies.
    """

    window: FloatArray
    highest: float
    strong: float


def band_of(motion: Motion, walls: tuple[int, ...]) -> Band:
    """Return the band for the field between the given walls."""
    grid = motion.grid
    taper, step = grid.taper(), grid.frequency_step
    needed = strong = 1
    for wall in walls:
        above = np.cumsum(motion.power(wall)[::-1])[::-1]
        whole = above[0] if motion.usual_power is None else max(above[0], motion.usual_power[wall])
        needed = max(needed, int(np.count_nonzero(above > NEGLIGIBLE * whole)))
        strong = max(strong, int(np.count_nonzero(above > FAINT * whole)))
    position = (np.arange(taper.size) / needed - _FULL) / (_NONE - _FULL)
    kept = max(2, int(np.count_nonzero(position < 1.0)))
    window: FloatArray = taper[:kept] * np.cos(0.5 * np.pi * np.clip(position[:kept], 0.0, 1.0)) ** 2
    window[1:] *= 2.0
    return Band(window, kept * step, strong * step)


def radii_needed(band: Band, phase: float, orders: float) -> int:
    """Return the number of Gauss points in a region *phase* wide (slowness times width) for modes r^m up to m = orders - 1."""
    waves = max(0.25 * band.highest, 0.45 * band.strong) * phase
    return min(MAX_RADII, int(12 + 2.0 * math.sqrt(orders) + waves))


_BLOCK_ELEMENTS = 64 * 1024
"""Order-node pairs of one block of fields: 1 MB an array."""

_WORK_BYTES = 200 * 1024 * 1024
"""Roughly what all threads together may use for the histories at their radii."""

Field = Callable[[RadialFunctions], tuple[list[ComplexArray], list[ComplexArray]]]
"""From the radial functions at a radius to the transforms of Pi and of dPi/dr, for every parity."""


class FluidEnergy(NamedTuple):
    """Energies of one enclosed fluid at the kept instants."""

    kinetic: FloatArray
    compression: FloatArray


class _Block(NamedTuple):
    nodes: slice
    radial: RadialBasis
    field: Field


def fluid_energy(motion: Motion, region: int, progress: ShareDone | None = None, radii: int | None = None) -> FluidEnergy | None:
    """Return the energy of the fluid inside shell ``region``; None for a vacuum.

    Parameters
    ----------
    motion : Motion
    region : int
        0 is the disc, i the annulus between shells i - 1 and i.
    progress : callable, optional
        Called with the finished fraction.
    radii : int, optional
        Number of Gauss points; chosen if left out.
    """
    problem = motion.problem
    fluid = problem.fluids[region]
    if fluid is None:
        return None
    inner, outer = problem.shells[region - 1].wetted[1] if region else 0.0, problem.shells[region].wetted[0]
    walls = {region: outer} if region == 0 else {region - 1: inner, region: outer}
    band = band_of(motion, tuple(walls))
    sampler = Sampler(motion.grid, motion.every)
    width = max(16, _BLOCK_ELEMENTS // motion.modes.count)
    blocks = [_block(motion, region, walls, band.window, part) for part in sampler.blocks(band.window.size, width)]
    steepest = motion.modes.count + motion.wavenumber * outer  # r^m e^{kr}
    points, weights = np.polynomial.legendre.leggauss(radii or radii_needed(band, fluid.slowness * (outer - inner), steepest))
    places = 0.5 * (inner + outer) + 0.5 * (outer - inner) * points
    total = np.zeros((2, motion.grid.time[motion.kept].size))
    parities = motion.normal.shape[1]
    memory = 5 * 16 * parities * motion.modes.count * sampler.length
    work = partial(_circle_energy, motion, fluid, blocks, sampler)
    with ThreadPoolExecutor(max(1, min(WORKERS, _WORK_BYTES // memory))) as pool:
        for done, (circle, r, weight) in enumerate(zip(pool.map(work, places), places, weights, strict=True), start=1):
            total += (0.5 * (outer - inner) * weight * r) * circle
            if progress is not None:
                progress(done / places.size)
    return FluidEnergy(*total)


def _block(motion: Motion, region: int, walls: dict[int, float], window: FloatArray, nodes: slice) -> _Block:
    """Return what the fields at a block of nodes share: functions and weighted slopes at the walls, given with their wetted radii."""
    fluid = motion.problem.fluids[region]
    assert fluid is not None
    radial = RadialBasis(motion.modes, motion.grid.nodes[nodes])
    at_walls = [radial(fluid.slowness, radius) for radius in walls.values()]
    # Slope of Pi at a wall: rho s w.
    moving = [motion.face_velocity(wall, int(wall < region)) for wall in walls]
    slopes = [fluid.density * velocity[..., nodes] * window[nodes] for velocity in moving]
    inner, outer = at_walls[0], at_walls[-1]
    amplitudes = annulus_amplitudes(inner, outer) if len(walls) == 2 else None

    def field(here: RadialFunctions) -> tuple[list[ComplexArray], list[ComplexArray]]:
        per_wall = (disc_field(here, outer),) if amplitudes is None else annulus_field(here, inner, outer, amplitudes)
        parities = range(slopes[0].shape[0])
        return tuple(  # type: ignore[return-value]
            [sum(getattr(one, part) * slope[parity] for one, slope in zip(per_wall, slopes, strict=True)) for parity in parities]
            for part in ("pressure", "slope")
        )

    return _Block(nodes, radial, field)


def _circle_energy(motion: Motion, fluid: FluidRegion, blocks: list[_Block], sampler: Sampler, r: float) -> FloatArray:
    """Return kinetic and compression energy per unit of r dr at a radius, shape (2, kept instants)."""
    parities, modes = motion.normal.shape[1], motion.modes
    sums = np.zeros((3, parities, modes.count, sampler.length), np.complex128)
    for block in blocks:
        here = block.radial.passing(fluid.slowness, r)
        impulse, slope = block.field(here)
        for parity in range(parities):
            sampler.add(sums[0, parity], slope[parity], block.nodes)
            sampler.add(sums[1, parity], impulse[parity], block.nodes)
            impulse[parity] *= block.radial.s
            sampler.add(sums[2, parity], impulse[parity], block.nodes)
    weights = motion.circle / (2.0 * fluid.density)
    energies = [
        np.einsum("m,hmt,hmt->t", weight, history, history)
        for weight, history in zip(
            (weights, weights * modes.gradient_squared(r), weights * fluid.slowness**2),
            (sampler.finish(part) for part in sums),
            strict=True,
        )
    ]
    return np.stack([energies[0] + energies[1], energies[2]])
