"""Energy of the enclosed fluids, integrated from the field itself: pressure and particle velocity of every order at many radii.

In a fluid of density ratio rho and slowness alpha, with Pi = p/s the time integral of the pressure (rho v = -grad Pi),

    E = (1/(2 rho)) sum_m beta pi integral of [alpha^2 p_m^2 + (dPi_m/dr)^2 + (m Pi_m/r)^2] r dr,

exact in theta by Parseval, by Gauss-Legendre points in r. Nothing here knows the work done at the walls.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.laplace_grid import WORKERS
from coaxshell.acoustics.operators import RadialFunctions, annulus_amplitudes
from coaxshell.acoustics.radial_fields import annulus_field, disc_field
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.progress import ShareDone
from coaxshell.response.energy.band import band_of, radii_needed
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.sampling import Sampler
from coaxshell.solver.scaling import FluidRegion

_BLOCK_ELEMENTS = 64 * 1024
"""Order-node pairs of one block of fields: 1 MB an array."""

_WORK_BYTES = 200 * 1024 * 1024
"""Roughly what all threads together may use for the histories at their radii."""

Field = Callable[[RadialFunctions], tuple[list[ComplexArray], list[ComplexArray]]]
"""From the radial functions at a radius to the transforms of Pi and of dPi/dr, for every half of the Fourier series."""


class FluidEnergy(NamedTuple):
    """Energies of one enclosed fluid at the kept instants."""

    kinetic: FloatArray
    compression: FloatArray


class _Block(NamedTuple):
    nodes: slice
    s: ComplexArray
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
    walls = (region,) if region == 0 else (region - 1, region)
    band = band_of(motion, walls)
    inner, outer = problem.shells[region - 1].radius if region else 0.0, problem.shells[region].radius
    sampler = Sampler(motion.grid, motion.every)
    width = max(16, _BLOCK_ELEMENTS // motion.orders.size)
    blocks = [_block(motion, fluid, walls, band.window, part) for part in sampler.blocks(band.window.size, width)]
    points, weights = np.polynomial.legendre.leggauss(radii or radii_needed(band, fluid.slowness * (outer - inner), motion.orders.size))
    places = 0.5 * (inner + outer) + 0.5 * (outer - inner) * points
    total = np.zeros((2, motion.grid.time[motion.kept].size))
    halves = motion.spectra.normal.shape[1]
    memory = 5 * 16 * halves * motion.orders.size * sampler.length
    work = partial(_ring_energy, motion, fluid, blocks, sampler)
    with ThreadPoolExecutor(max(1, min(WORKERS, _WORK_BYTES // memory))) as pool:
        for done, (ring, r, weight) in enumerate(zip(pool.map(work, places), places, weights, strict=True), start=1):
            total += (0.5 * (outer - inner) * weight * r) * ring
            if progress is not None:
                progress(done / places.size)
    return FluidEnergy(*total)


def _block(motion: Motion, fluid: FluidRegion, walls: tuple[int, ...], window: FloatArray, nodes: slice) -> _Block:
    """Return what the fields at a block of nodes share: functions and weighted slopes at the walls."""
    s, orders = motion.grid.nodes[nodes], motion.orders
    at_walls = [RadialFunctions(fluid.slowness * s, motion.problem.shells[wall].radius, orders) for wall in walls]
    # Slope of Pi at a wall: rho s w.
    slopes = [fluid.density * motion.normal_velocity[wall, :, :, nodes] * window[nodes] for wall in walls]
    inner, outer = at_walls[0], at_walls[-1]
    amplitudes = annulus_amplitudes(inner, outer) if len(walls) == 2 else None

    def field(here: RadialFunctions) -> tuple[list[ComplexArray], list[ComplexArray]]:
        per_wall = (disc_field(here, outer),) if amplitudes is None else annulus_field(here, inner, outer, amplitudes)
        halves = range(slopes[0].shape[0])
        return tuple(  # type: ignore[return-value]
            [sum(getattr(one, part) * slope[half] for one, slope in zip(per_wall, slopes, strict=True)) for half in halves]
            for part in ("pressure", "slope")
        )

    return _Block(nodes, fluid.slowness * s, field)


def _ring_energy(motion: Motion, fluid: FluidRegion, blocks: list[_Block], sampler: Sampler, r: float) -> FloatArray:
    """Return kinetic and compression energy per unit of r dr at a radius, shape (2, kept instants)."""
    halves, orders = motion.spectra.normal.shape[1], motion.orders
    sums = np.zeros((3, halves, orders.size, sampler.length), np.complex128)
    for block in blocks:
        here = RadialFunctions(block.s, r, orders)
        impulse, slope = block.field(here)
        for half in range(halves):
            sampler.add(sums[0, half], slope[half], block.nodes)
            sampler.add(sums[1, half], impulse[half], block.nodes)
            impulse[half] *= block.s / fluid.slowness
            sampler.add(sums[2, half], impulse[half], block.nodes)
    weights = motion.circle / (2.0 * fluid.density)
    energies = [
        np.einsum("m,hmt,hmt->t", weight, history, history)
        for weight, history in zip(
            (weights, weights * (orders / r) ** 2, weights * fluid.slowness**2), (sampler.finish(part) for part in sums), strict=True
        )
    ]
    return np.stack([energies[0] + energies[1], energies[2]])
