"""Modified Bessel functions of arguments that are large beside the square of the order, by Hankel's expansions.

    K_m(z) = sqrt(pi/(2z)) e^-z A(z),                             A(z) = sum over k of a_k/z^k,
    I_m(z) = e^z/sqrt(2 pi z) [A(-z) +- i (-1)^m e^-2z A(z)],     a_k = a_(k-1) (4 m^2 - (2k - 1)^2)/(8k)    (DLMF 10.40.2 and 10.40.5),

the upper sign where Im z >= 0; the derivatives alike, with b_k (DLMF 10.40.3 and 10.40.4) and the sign of e^-z. a_k is real and belongs to
the order, 1/z^k to the argument, so that all orders are one matrix product: no recurrence runs through orders that are not asked for.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray, real_product

FARTHEST = 4.0
"""m^2/(2 |z|) up to which the series is taken: its terms go as this to the power k over k!, which loses a digit."""
_LEAST = 30.0
"""|z| from which it is good to rounding for any order: its least term is about e^-2|z|."""
_ROUNDING = 1e-17
"""Of the first term, below which no more are added."""
_TERMS = 48
"""Enough for that: 4^48/48! is 6e-33."""


@dataclass(frozen=True, eq=False)
class LargeArguments:
    """The expansions at some orders and arguments.

    Attributes
    ----------
    argument : ndarray, shape (n,)
        z, Re z > 0.
    k_value, k_slope : ndarray, shape (orders, n)
        A(z), and B(z) of -K_m'.
    i_value, i_slope : ndarray, shape (orders, n)
        What stands in the brackets of I_m and of I_m'.
    """

    argument: ComplexArray
    orders: FloatArray

    @classmethod
    def of(cls, orders: FloatArray, argument: ComplexArray) -> Self | None:
        """Return them; None where an argument is not large enough beside the highest order."""
        least = float(np.abs(argument).min(initial=np.inf))
        return cls(argument, orders) if least >= max(_LEAST, float(orders[-1]) ** 2 / (2.0 * FARTHEST)) else None

    @cached_property
    def _parts(self) -> tuple[ComplexArray, ComplexArray, ComplexArray, ComplexArray]:
        """Return even and odd parts of A, and of B."""
        least = float(np.abs(self.argument).min())
        values, slopes = _coefficients(self.orders, least)
        powers = np.empty((values.shape[1], self.argument.size), np.complex128)
        powers[0] = 1.0
        np.divide(least, self.argument, out=powers[1])
        for k in range(2, len(powers)):
            np.multiply(powers[k - 1], powers[1], out=powers[k])
        both = np.concatenate([values, slopes])
        even, odd = real_product(both[:, ::2], powers[::2]), real_product(both[:, 1::2], powers[1::2])
        count = self.orders.size
        return even[:count], odd[:count], even[count:], odd[count:]

    @cached_property
    def k_value(self) -> ComplexArray:
        """A(z)."""
        even, odd, _, _ = self._parts
        return np.asarray(even + odd)

    @cached_property
    def k_derivative(self) -> ComplexArray:
        """B(z)."""
        _, _, even, odd = self._parts
        return np.asarray(even + odd)

    @cached_property
    def _reflected(self) -> ComplexArray:
        """+-i (-1)^m e^-2z, shape (orders, n)."""
        around = np.where(self.argument.imag < 0.0, -1j, 1j) * np.exp(-2.0 * self.argument)
        return np.asarray(np.where(self.orders % 2 == 0, 1.0, -1.0)[:, None] * around)

    @cached_property
    def i_value(self) -> ComplexArray:
        """A(-z) +- i (-1)^m e^-2z A(z)."""
        even, odd, _, _ = self._parts
        return np.asarray(even - odd + self._reflected * self.k_value)

    @cached_property
    def i_slope(self) -> ComplexArray:
        """z I_m'(z)/I_m(z)."""
        _, _, even, odd = self._parts
        return np.asarray(self.argument * (even - odd - self._reflected * self.k_derivative) / self.i_value)

    @cached_property
    def k_slope(self) -> ComplexArray:
        """z K_m'(z)/K_m(z)."""
        return np.asarray(-self.argument * self.k_derivative / self.k_value)

    def i_over(self, other: LargeArguments) -> ComplexArray:
        """Return I_m here over I_m there, of arguments on the same rays; where it underflows, zero is its limit."""
        a, b = self.argument, other.argument
        return np.asarray(self.i_value / other.i_value * (np.exp(a - b) * np.sqrt(b / a)))

    def k_over(self, other: LargeArguments) -> ComplexArray:
        """Return K_m here over K_m there."""
        a, b = self.argument, other.argument
        return np.asarray(self.k_value / other.k_value * (np.exp(b - a) * np.sqrt(b / a)))


def _coefficients(orders: FloatArray, least: float) -> tuple[FloatArray, FloatArray]:
    """Return a_k and b_k over the least |z| to the power k, (orders, terms) each, as far as they count."""
    squares, k = 4.0 * orders[:, None] ** 2, np.arange(1.0, _TERMS)
    values = np.ones((orders.size, _TERMS))
    np.cumprod((squares - (2.0 * k - 1.0) ** 2) / (8.0 * k * least), axis=1, out=values[:, 1:])
    slopes = np.ones_like(values)
    slopes[:, 1:] = values[:, :-1] * ((squares + 4.0 * k**2 - 1.0) / (8.0 * k * least))
    most = np.maximum(np.abs(values).max(axis=0), np.abs(slopes).max(axis=0))
    count = max(2, 1 + int(np.flatnonzero(most > _ROUNDING)[-1]))
    return values[:, :count], slopes[:, :count]
