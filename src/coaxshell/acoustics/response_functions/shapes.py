"""Weights of the resonances: f(t) = sum_k g u_k(wall) u_k(r)/(N_k x_k) sin(x_k t), g = rb at the outer, -ra at the inner wall.

N = int u^2 r dr = [(r^2 - m^2/x^2) u^2]/2 between the walls, where u' = 0. By the Wronskian the mode shape is 2/(pi x r |H_m'|) at
either wall, with the sign (-1)^k between them; elsewhere it is J_m(xr) sin(phi) - Y_m(xr) cos(phi), phi the phase of H_m' at a wall.
"""

from __future__ import annotations

import numpy as np
from scipy.special import jv, yv

from coaxshell.acoustics.response_functions.debye import expand, reach
from coaxshell.acoustics.response_functions.echoes import Response
from coaxshell.acoustics.response_functions.resonances import Resonances
from coaxshell.numerics.arrays import FloatArray


def expansion(modes: Resonances, response: Response) -> FloatArray:
    """Return the weight of sin(x_k t) for every resonance."""
    x, square = modes.wavenumbers, (modes.order / modes.wavenumbers) ** 2
    at_outer = np.ones_like(x)
    at_inner = np.zeros_like(x)
    norm = 0.5 * (response.outer**2 - square)
    if response.inner > 0.0:
        sign = 1.0 - 2.0 * (modes.count % 2)
        at_inner = sign * (modes.outer.modulus / modes.inner.modulus) * (response.outer / response.inner)
        norm -= 0.5 * (response.inner**2 - square) * at_inner**2
    drive = -response.inner * at_inner if response.driven_inside else response.outer * at_outer
    if response.at == response.outer:
        here = at_outer
    elif response.at == response.inner > 0.0:
        here = at_inner
    else:
        here = _within(modes, response)
    return np.asarray(drive * here / (norm * x), dtype=np.float64)


def _within(modes: Resonances, response: Response) -> FloatArray:
    """Return u(r)/u(rb) between the walls.

    With the outer wall's phase u(r) = (J(xr) sin(phi_b) - Y(xr) cos(phi_b)) / (2/(pi x rb |H'(x rb)|)).
    """
    order, z, angle = modes.order, modes.wavenumbers * response.at, modes.outer.angle
    scale = 0.5 * np.pi * modes.wavenumbers * response.outer * modes.outer.modulus
    if response.at == 0.0:
        return np.asarray(scale * (order == 0.0) * np.sin(angle), dtype=np.float64)
    j, y = np.empty_like(z), np.zeros_like(z)
    far = z >= reach(order)
    wave = expand(order[far], z[far].astype(np.complex128), 1).value * np.exp(1j * z[far])
    j[far], y[far] = wave.real, wave.imag
    j[~far] = jv(order[~far], z[~far])
    if response.inner > 0.0:
        y[~far] = yv(order[~far], z[~far])
    else:
        y[:] = 0.0
    return np.asarray(scale * (j * np.sin(angle) - y * np.cos(angle)), dtype=np.float64)
