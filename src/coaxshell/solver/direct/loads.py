"""Modal loads in time (Eqs. B.11, B.13, B.14): incident pressure by quadrature over the wetted arc, scattering by convolution."""

from __future__ import annotations

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.pulse_histories import pulse_corners, pulse_history, pulse_impulse
from coaxshell.acoustics.rays import front_angle, surface_rays
from coaxshell.acoustics.sources import SourceGeometry
from coaxshell.model.sources import Source
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.late import signal
from coaxshell.solver.direct.weights import scattering_weights
from coaxshell.solver.excitation import source_parities, source_spectrum
from coaxshell.solver.scaling import Problem

_TIMES = 128
"""Times worked on together."""


def surface_loads(problem: Problem, grid: LaplaceGrid, max_order: int) -> FloatArray:
    """Return the modal loads on the outermost shell, incident plus rigidly scattered, shape (parities, M + 1, T)."""
    modes = Modes.up_to(max_order)
    parities = source_parities(problem)
    loads = np.zeros((parities, modes.count, grid.time.size))
    scattering = scattering_weights(grid, modes)
    for source, geometry in zip(problem.emitters, problem.sources, strict=True):
        if not geometry.along_rays:
            load = _load_by_series(problem, source, geometry, grid, modes)
        else:
            pressure, velocity = arc_integrals(problem, source, geometry, grid.time, modes)
            scattered = signal.fftconvolve(velocity, scattering, axes=1)[:, : grid.time.size]
            load = pressure + scattered
        for parity in range(parities):
            loads[parity] += modes.projection(source.angle, parity) * load
    return loads


def arc_integrals(
    problem: Problem, source: Source, geometry: SourceGeometry, times: FloatArray, modes: Modes
) -> tuple[FloatArray, FloatArray]:
    """Return P0_m(t) and the modal radial velocity b_m(t) at r = 1 of a wave that is carried along rays, each (M + 1, T).

    The integrals run over the arc that the front has passed, 0 <= theta <= theta_front(t), split where the pulse's jumps and corners are
    at that time: between them the integrand is smooth, and Gauss-Legendre quadrature fine enough for the highest order is exact.
    """
    scales, orders, reach = problem.scales, modes.orders, geometry.distance
    nodes, weights = np.polynomial.legendre.leggauss(int(0.55 * np.pi * orders[-1]) + 48)
    pressure, velocity = np.zeros((2, orders.size, times.size))
    since = times - source.delay / scales.time
    corners = np.append(pulse_corners(source.pulse, scales.time), np.inf)
    for start in range(0, times.size, _TIMES):
        block = slice(start, start + _TIMES)
        front = front_angle(since[block], reach)
        for corner in corners:
            behind = front_angle(since[block] - corner, reach)
            if (front > behind).any():
                theta = behind[:, None] + 0.5 * (front - behind)[:, None] * (nodes + 1.0)
                rays = surface_rays(theta, reach)
                clock = since[block][:, None] - rays.path
                p = rays.spread * pulse_history(source.pulse, clock, scales.time, scales.pressure)
                v = rays.slope * (p + rays.spread * rays.curvature * pulse_impulse(source.pulse, clock, scales.time, scales.pressure))
                arc = 0.5 * (front - behind)[:, None] * weights / np.pi
                both = _project(np.stack([p * arc, v * arc]), np.cos(theta), modes)
                pressure[:, block] += both[0]
                velocity[:, block] += both[1]
            front = behind
    return pressure, velocity


def _project(values: FloatArray, cosine: FloatArray, modes: Modes) -> FloatArray:
    """Return the sums over nodes of values * eps_m cos(m theta), shape (2, M + 1, T), by Chebyshev's recurrence in m."""
    result = np.empty((2, modes.count, cosine.shape[0]))
    previous, present = cosine, np.ones_like(cosine)  # cos(-theta), cos 0
    for m in range(modes.count):
        result[:, m] = np.einsum("qtn,tn->qt", values, present)
        previous, present = present, 2.0 * cosine * present - previous
    return result * modes.neumann


def _load_by_series(problem: Problem, source: Source, geometry: SourceGeometry, grid: LaplaceGrid, modes: Modes) -> FloatArray:
    """Return the load of a source whose time history has no closed form by inverse transform of its modal series."""
    load = geometry.prepare(grid, modes)
    return grid.invert(load(RadialBasis(modes, grid.nodes), slice(None)) * source_spectrum(problem, source, grid.nodes))
