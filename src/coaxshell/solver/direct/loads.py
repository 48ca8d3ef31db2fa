"""Modal loads in time (Eqs. B.11, B.13, B.14): incident pressure by quadrature over the wetted arc, scattering by convolution."""

from __future__ import annotations

import numpy as np

from coaxshell.acoustics.incident import neumann
from coaxshell.acoustics.operators import RadialFunctions, all_orders
from coaxshell.acoustics.pulse_histories import pulse_corners, pulse_history, pulse_impulse
from coaxshell.acoustics.rays import front_angle, surface_rays
from coaxshell.model.sources import Source
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.late import signal
from coaxshell.solver.direct.weights import scattering_weights
from coaxshell.solver.excitation import incident_wave, projection, source_parities, source_spectrum
from coaxshell.solver.scaling import Problem

_TIMES = 128
"""Times worked on together."""


def surface_loads(problem: Problem, grid: LaplaceGrid, max_order: int) -> FloatArray:
    """Return the modal loads on the outermost shell, incident plus rigidly scattered, shape (parities, M + 1, T)."""
    orders = all_orders(max_order)
    parities = source_parities(problem.system.sources)
    loads = np.zeros((parities, orders.size, grid.time.size))
    scattering = scattering_weights(grid, orders)
    for source in problem.system.sources:
        if source.geometry == "line":
            load = _line_load(problem, source, grid, orders)
        else:
            pressure, velocity = arc_integrals(problem, source, grid.time, orders)
            scattered = signal.fftconvolve(velocity, scattering, axes=1)[:, : grid.time.size]
            load = pressure + scattered
        for parity in range(parities):
            loads[parity] += projection(orders, source.angle, parity) * load
    return loads


def arc_integrals(problem: Problem, source: Source, times: FloatArray, orders: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return P0_m(t) and the modal radial velocity b_m(t) at r = 1 of a spherical or plane wave, each (M + 1, T).

    The integrals run over the arc that the front has passed, 0 <= theta <= theta_front(t), split where the pulse's jumps and corners are
    at that time: between them the integrand is smooth, and Gauss-Legendre quadrature fine enough for the highest order is exact.
    """
    scales = problem.scales
    nodes, weights = np.polynomial.legendre.leggauss(int(0.55 * np.pi * orders[-1]) + 48)
    distance = problem.system.source_distance(source)
    reach = None if distance is None else distance / scales.length
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
                both = _project(np.stack([p * arc, v * arc]), np.cos(theta), orders)
                pressure[:, block] += both[0]
                velocity[:, block] += both[1]
            front = behind
    return pressure, velocity


def _project(values: FloatArray, cosine: FloatArray, orders: FloatArray) -> FloatArray:
    """Return the sums over nodes of values * eps_m cos(m theta), shape (2, M + 1, T), by Chebyshev's recurrence in m."""
    result = np.empty((2, orders.size, cosine.shape[0]))
    previous, present = cosine, np.ones_like(cosine)  # cos(-theta), cos 0
    for m in range(orders.size):
        result[:, m] = np.einsum("qtn,tn->qt", values, present)
        previous, present = present, 2.0 * cosine * present - previous
    return result * neumann(orders)


def _line_load(problem: Problem, source: Source, grid: LaplaceGrid, orders: FloatArray) -> FloatArray:
    """Return the load of a line source, whose time history has no closed form, by inverse transform of its modal series."""
    load = incident_wave(problem, source).prepare(grid, orders)
    surface = RadialFunctions(grid.nodes, 1.0, orders)
    return grid.invert(load(surface, slice(None)) * source_spectrum(problem, source, grid.nodes))
