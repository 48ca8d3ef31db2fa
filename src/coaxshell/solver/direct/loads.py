"""Modal loads in time (Eqs. B.11, B.13, B.14): incident pressure by quadrature over the wetted arc, scattering by convolution."""

from __future__ import annotations

import numpy as np

from coaxshell.acoustics.incident import neumann
from coaxshell.acoustics.laplace_grid import LaplaceGrid
from coaxshell.acoustics.operators import FloatArray, RadialFunctions, all_orders
from coaxshell.acoustics.pulse_histories import pulse_history, pulse_impulse
from coaxshell.model.sources import Source
from coaxshell.numerics.late import signal
from coaxshell.solver.direct.weights import scattering_weights
from coaxshell.solver.excitation import incident_wave, needs_sine_half, projection, source_spectrum
from coaxshell.solver.scaling import Problem

_TIMES = 128
"""Times worked on together."""


def surface_loads(problem: Problem, grid: LaplaceGrid, max_order: int) -> FloatArray:
    """Return the modal loads on the outermost shell, incident plus rigidly scattered, shape (halves, M + 1, T)."""
    orders = all_orders(max_order)
    halves = 2 if needs_sine_half(problem.system.sources) else 1
    loads = np.zeros((halves, orders.size, grid.time.size))
    scattering = scattering_weights(grid, orders)
    for source in problem.system.sources:
        if source.geometry == "line":
            load = _line_load(problem, source, grid, orders)
        else:
            pressure, velocity = arc_integrals(problem, source, grid.time, orders)
            scattered = signal.fftconvolve(velocity, scattering, axes=1)[:, : grid.time.size]
            load = pressure + scattered
        for half in range(halves):
            loads[half] += projection(orders, source.angle, half) * load
    return loads


def arc_integrals(problem: Problem, source: Source, times: FloatArray, orders: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return P0_m(t) and the modal radial velocity b_m(t) at r = 1 of a spherical or plane wave, each (M + 1, T).

    The integrals run over the arc that the front has passed, 0 <= theta <= theta_front(t), where the integrand is smooth, by
    Gauss-Legendre quadrature fine enough for the highest order.
    """
    scales = problem.scales
    nodes, weights = np.polynomial.legendre.leggauss(int(0.55 * np.pi * orders[-1]) + 48)
    distance = problem.system.source_distance(source)
    reach = None if distance is None else distance / scales.length
    pressure, velocity = np.zeros((2, orders.size, times.size))
    since = times - source.delay / scales.time
    for start in range(0, times.size, _TIMES):
        block = slice(start, start + _TIMES)
        front = _front_angle(since[block], reach)
        if not front.any():
            continue
        theta = 0.5 * front[:, None] * (nodes + 1.0)
        arrival, amplitude, slope, spread = _geometry(theta, reach)
        clock = since[block][:, None] - arrival
        p = amplitude * pulse_history(source.pulse, clock, scales.time, scales.pressure)
        v = slope * (p + amplitude * spread * pulse_impulse(source.pulse, clock, scales.time, scales.pressure))
        half_arc = 0.5 * front[:, None] * weights / np.pi
        pressure[:, block], velocity[:, block] = _project(np.stack([p * half_arc, v * half_arc]), np.cos(theta), orders)
    return pressure, velocity


def _front_angle(since: FloatArray, distance: float | None) -> FloatArray:
    """Return the angle up to which the front has passed the surface r = 1."""
    since = np.maximum(since, 0.0)
    if distance is None:
        cosine = 1.0 - since
    else:
        cosine = (1.0 + distance**2 - (distance - 1.0 + since) ** 2) / (2.0 * distance)
    return np.arccos(np.clip(cosine, -1.0, 1.0))


def _geometry(theta: FloatArray, distance: float | None) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Return arrival time, amplitude S/R, dR/dr and 1/R at r = 1 (theory manual, section "Incident wave")."""
    if distance is None:
        return 1.0 - np.cos(theta), np.ones_like(theta), -np.cos(theta), np.zeros_like(theta)
    range_ = np.sqrt(1.0 + distance**2 - 2.0 * distance * np.cos(theta))
    stand_off = distance - 1.0
    return range_ - stand_off, stand_off / range_, (1.0 - distance * np.cos(theta)) / range_, 1.0 / range_


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
