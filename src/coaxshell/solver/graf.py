"""What the planes of the sea send back of a scattered wave, order by order, by Graf's addition theorem (DLMF 10.44.3).

Seen from an image of the axis at the distance D, an outgoing wave is regular around the shells. With angles from the direction of the image
and a mirrored image (a surface or a bottom),

    K_n(kappa r') cos n theta' = sum_m (eps_m/2) [K_{n+m}(kappa D) + K_{n-m}(kappa D)] I_m(kappa r) cos m theta,
    K_n(kappa r') sin n theta' = sum_m            [K_{n+m}(kappa D) - K_{n-m}(kappa D)] I_m(kappa r) sin m theta,

and shells answer c_m I_m(kappa r) as any incident wave, by its load -c_m/(kappa b K_m'(kappa b)). Waves A_n at r = b make the load, with
E = K/(kappa K'),

    -(E_m/b) (eps_m/2) sum_n [K_{n+m}(kappa D) +- K_{n-m}(kappa D)]/(K_m(kappa b) K_n(kappa b)) A_n,

symmetric in m and n, bounded, and late by e^{-kappa (D - 2 b)}. A row follows from the one before by ratios of neighbouring orders.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np

from coaxshell.acoustics.images import Image, Planes
from coaxshell.numerics import bessel_ratios as br
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.radial_functions import RadialFunctions


def returned_load(
    outgoing: ComplexArray, surface: RadialFunctions, planes: Planes, images: Iterable[Image], *, transposed: bool = False
) -> ComplexArray:
    """Return the load on r = b of what the planes send back of an outgoing wave, its rigid scattering included, same shape.

    Parameters
    ----------
    outgoing : ndarray, shape (1 or 2, orders, nodes)
        Its modal pressure at r = b: cosines of theta, and sines.
    surface : RadialFunctions
        At r = b, of all orders up to a highest one.
    planes : Planes
    images : iterable of Image
        Of the axis.
    transposed : bool
        Whether it is what loads change that is given, and what outgoing waves change that is asked for.
    """
    m = surface.orders
    scale = -surface.exterior / surface.radius * np.where(m == 0.0, 0.5, 1.0)[:, None]
    turned = _turned(outgoing, m, planes.up) * (scale if transposed else 1.0)
    total = np.zeros_like(turned)
    for image in images:
        total += image.sign * _seen(turned, surface, image, transposed=transposed)
    return _turned(total * (1.0 if transposed else scale), m, -planes.up)


def causal_images(planes: Planes, head: float, lasting: float) -> list[Image]:
    """Return the images of the axis that are heard again at r = b within so many transits after something left it."""
    return [image for image in planes.images(lasting + 2.0 * head) if abs(image.shift) - 2.0 * head < lasting]


def _turned(waves: ComplexArray, orders: FloatArray, angle: float) -> ComplexArray:
    """Return the cosines and sines of theta - angle from those of theta; a single parity stays one, the angle then being a half turn."""
    cos, sin = (Modes(orders).projection(angle, parity) for parity in (0, 1))
    if waves.shape[0] == 1:
        return cos * waves
    return np.stack([cos * waves[0] + sin * waves[1], cos * waves[1] - sin * waves[0]])


def _seen(waves: ComplexArray, surface: RadialFunctions, image: Image, *, transposed: bool) -> ComplexArray:
    """Return sum_n [K_{n+m}(kappa D) +- K_{n-m}(kappa D)]/(K_m K_n) A_n, with the signs of an image above or below, mirrored or not."""
    alternating = np.where(surface.orders % 2 == 0.0, 1.0, -1.0)[:, None]
    arriving, leaving = np.ones_like(alternating), np.ones_like(alternating)
    if image.shift < 0.0:  # angles from the other side
        arriving, leaving = alternating, alternating
    signs = np.ones(waves.shape[0])
    if not image.mirrored:
        leaving = leaving * alternating
        signs[1:] = -1.0
    if transposed:  # the sums themselves are symmetric in m and n
        arriving, leaving = leaving, arriving
    found = np.empty_like(waves)
    apart = RadialFunctions(surface.kappa, abs(image.shift), np.arange(2.0 * surface.max_order + 1.0))
    for m, (high, low) in enumerate(_rows(surface, apart)):
        for parity, sign in enumerate((1.0, -1.0)[: waves.shape[0]]):
            row = (high + sign * low) * leaving
            found[parity, m] = signs[parity] * arriving[m] * np.einsum("nk,nk->k", row, waves[parity])
    return found


def _rows(surface: RadialFunctions, apart: RadialFunctions) -> Iterator[tuple[ComplexArray, ComplexArray]]:
    """Yield K_{n+m}(kappa D)/(K_m(kappa b) K_n(kappa b)) and K_{n-m}(kappa D)/(...) for all n, each (orders, nodes), for m = 0, 1, ..."""
    count = surface.orders.size
    up = apart.k_ratios  # K_{j+1}/K_j at kappa D
    down = 1.0 / up[:count]
    steps = 1.0 / surface.k_ratios
    order_zero = br.kve(0, apart.argument) / br.kve(0, surface.argument) ** 2 * np.exp(2.0 * surface.argument - apart.argument)
    high = br.running_product(order_zero, up[:count] * steps)
    low = high.copy()
    for m in range(count):
        yield high, low
        high = high * (up[m : m + count] * steps[m])
        factor = np.empty_like(low)
        factor[: m + 1] = up[m::-1]  # n <= m: K_{m+1-n}/K_{m-n}
        factor[m + 1 :] = down[: count - m - 1]  # n > m: K_{n-m-1}/K_{n-m}
        low = low * factor * steps[m]
