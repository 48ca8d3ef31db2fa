"""Modified Bessel functions at a sample of orders, as accurate as the ratios of all orders and at less than half their cost (Re z > 0).

Ratios cost a division at every order between two of the sample. The functions themselves need none,

    K_{m+1} = K_{m-1} + (2m/z) K_m    upward,        I_{m-1} = I_{m+1} + (2m/z) I_m    downward    (DLMF 10.29.1),

where what would over- or underflow is taken out as an exponent every few orders.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.special import ive

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.bessel_ratios import as_complex, kve, starting_ratio

_RESCALED = 16
"""Steps between two rescalings: at m = 4000 and |z| = 1e-6 they grow by 1e158."""


class BesselSample(NamedTuple):
    """One family at some orders, each array of shape (orders, n).

    Attributes
    ----------
    ratio : ndarray
        I_{m+1}/I_m or K_{m+1}/K_m.
    mantissa, exponent : ndarray
        ``mantissa`` times e^``exponent`` is I_m(z) e^{-Re z} or K_m(z) e^z.
    """

    ratio: ComplexArray
    mantissa: ComplexArray
    exponent: FloatArray

    def over(self, other: BesselSample) -> ComplexArray:
        """Return the quotient of two, each with its scaling e^{-Re z} or e^z; where it underflows, zero is its limit."""
        return np.asarray(self.mantissa / other.mantissa * np.exp(self.exponent - other.exponent), dtype=np.complex128)


def k_sample(orders: npt.NDArray[np.int64], z: npt.ArrayLike) -> BesselSample:
    """Return K at ascending orders.

    Parameters
    ----------
    orders : ndarray, shape (orders,)
    z : array_like, shape (n,)
        Complex arguments with Re z > 0.

    Raises
    ------
    ValueError
        If any Re z <= 0.
    """
    z = as_complex(z)
    here, above, exponent = _stepped(kve(0, z), kve(1, z), 2.0 / z, 1, 1, orders)
    return BesselSample(above / here, here, exponent)


def i_sample(orders: npt.NDArray[np.int64], z: npt.ArrayLike) -> BesselSample:
    """Return I at ascending orders; parameters and errors are those of :func:`k_sample`."""
    z, top = as_complex(z), int(orders[-1])
    steps = np.append(top - orders[::-1], top)  # the last is order 0, which SciPy knows
    above, here, exponent = _stepped(starting_ratio(top, z), np.ones_like(z), 2.0 / z, top, -1, steps)
    mantissa, further = here * (ive(0, z) / here[-1]), exponent - exponent[-1]
    return BesselSample((above / here)[-2::-1], mantissa[-2::-1], further[-2::-1])


def _stepped(
    older: ComplexArray, newer: ComplexArray, two_over_z: ComplexArray, first: int, sign: int, steps: npt.NDArray[np.int64]
) -> tuple[ComplexArray, ComplexArray, FloatArray]:
    """Return the last two terms of x_{j+1} = x_{j-1} + (2m/z) x_j, m = first + sign j, after some ascending numbers of steps.

    Two terms and the exponent of both, each of shape (numbers, n).
    """
    older, newer, work, exponent = older.copy(), newer.copy(), np.empty_like(newer), np.zeros(newer.size)
    terms, exponents = np.empty((2, steps.size, newer.size), np.complex128), np.empty((steps.size, newer.size))
    factors = np.empty((_RESCALED, newer.size), np.complex128)
    step = 0
    for row, asked in enumerate(steps):
        while step < asked:
            place = step % _RESCALED
            if place == 0:
                size = np.abs(newer)
                older /= size
                newer /= size
                exponent += np.log(size)
                np.multiply(two_over_z, (first + sign * np.arange(step, step + _RESCALED))[:, None], out=factors)
            np.multiply(factors[place], newer, out=work)
            np.add(work, older, out=work)
            older, newer, work = newer, work, older
            step += 1
        terms[0, row], terms[1, row], exponents[row] = older, newer, exponent
    return terms[0], terms[1], exponents
