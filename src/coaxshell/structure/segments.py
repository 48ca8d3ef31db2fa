"""Electrodes cut into N equal segments around a wall: what they read of the orders, and what their voltages are in orders.

Segment k has its middle at theta_k = 2 pi k/N and covers an angle alpha; between segments lie strips at ground. It reads the mean of
what lies under it, and its voltage u_k is the same all over it: with sigma_m = sin(m alpha/2)/(m alpha/2),

    phi_k = sum_m sigma_m (phi_m cos m theta_k + phi'_m sin m theta_k),      u_m = alpha/(beta_m pi) sigma_m sum_k u_k cos m theta_k,

beta_0 = 2, else 1, and the same with sines. In the patterns cos q theta_k and sin q theta_k of the segments, q up to N/2, only the orders
m = q, N - q, N + q, 2N - q, ... count: each pattern is a loop of its own, which reads them all and pushes on all of them (spill-over).
What an order of a pattern reads per unit of its own and pushes back is r_m = (alpha N/2 pi) sigma_m^2, counted twice where +m and -m
are the same pattern and m > 0; it tends to 1 as (pi m/N)^2/3, N growing without gaps.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray

Values = TypeVar("Values", ComplexArray, FloatArray)


@dataclass(frozen=True)
class Segments:
    """The segments of one wall.

    Attributes
    ----------
    count : int
        N.
    covered : float
        Share of the circumference under electrodes, alpha N/2 pi.
    dead : tuple of int
        Those held at ground.
    """

    count: int
    covered: float = 1.0
    dead: tuple[int, ...] = ()

    @property
    def centres(self) -> FloatArray:
        """theta_k, radians."""
        return np.asarray(2.0 * np.pi * np.arange(self.count) / self.count)

    def share(self, orders: FloatArray) -> FloatArray:
        """Return sigma_m."""
        return np.asarray(np.sinc(orders * (self.covered / self.count)))

    def numbers(self, parities: int) -> FloatArray:
        """Return q of each pattern, cosines first, then, with two parities, sines."""
        cosines = np.arange(self.count // 2 + 1, dtype=np.float64)
        return cosines if parities == 1 else np.concatenate([cosines, cosines[1 : (self.count + 1) // 2]])

    def patterns(self, parities: int) -> FloatArray:
        """Return cos q theta_k and sin q theta_k, shape (N, patterns)."""
        even = self.count // 2 + 1
        phase = self.centres[:, None] * self.numbers(parities)
        return np.concatenate([np.cos(phase[:, :even]), np.sin(phase[:, even:])], axis=1)

    def amplitudes(self, parities: int) -> FloatArray:
        """Return the matrix from values on the segments to their patterns, (patterns, N)."""
        patterns = self.patterns(parities)
        return np.ascontiguousarray((patterns / (patterns**2).sum(axis=0)).T)

    def waves(self, orders: FloatArray, parities: int) -> FloatArray:
        """Return sigma_m cos m theta_k, then sigma_m sin m theta_k, shape (N, parities, orders)."""
        phase = self.centres[:, None] * orders
        return np.asarray(self.share(orders) * np.stack([np.cos(phase), np.sin(phase)][:parities], axis=1))

    def readings(self, orders: FloatArray, parities: int) -> FloatArray:
        """Return what each pattern reads of each order, shape (patterns, parities, orders)."""
        return np.asarray(np.einsum("qk,khm->qhm", self.amplitudes(parities), self.waves(orders, parities)))

    def loads(self, orders: FloatArray, parities: int) -> FloatArray:
        """Return u_m of each pattern of voltages, shape (parities, orders, patterns)."""
        weight = self.covered / self.count * np.where(orders == 0, 1.0, 2.0)
        return np.asarray(np.einsum("khm,kq->hmq", weight * self.waves(orders, parities), self.patterns(parities)))

    def means(self, modal: Values) -> Values:
        """Return the mean under each segment of a quantity in orders 0 to M, (parities, M + 1, ...): shape (N, ...)."""
        orders = np.arange(float(modal.shape[1]))
        return np.tensordot(self.waves(orders, modal.shape[0]), modal, 2)

    def values(self, modal: Values) -> Values:
        """Return u_k, (N, ...), from the u_m that it makes, (parities, M + 1, ...): each pattern shows in its own order, or not."""
        parities, even = modal.shape[0], self.count // 2 + 1
        numbers = self.numbers(parities).astype(int)
        parity = np.where(np.arange(numbers.size) < even, 0, 1)
        own = self.loads(np.arange(float(even)), parities)[parity, numbers, np.arange(numbers.size)]
        shown = numbers < modal.shape[1]
        return np.tensordot((self.patterns(parities) / own)[:, shown], modal[parity[shown], numbers[shown]], 1)

    def of_patterns(self, sizes: FloatArray, orders: FloatArray) -> FloatArray:
        """Return for each order the sum of the sizes of loops, (orders,), that its pattern goes around by."""
        pattern = np.abs(orders - self.count * np.rint(orders / self.count))
        return np.asarray((self.loop_shares(orders, 1) @ sizes)[pattern.astype(int)])

    def loop_shares(self, orders: FloatArray, parities: int) -> FloatArray:
        """Return r_m of each order in each pattern, shape (patterns, orders); no pattern moves another one."""
        return np.asarray(np.einsum("qhm,hmq->qm", self.readings(orders, parities), self.loads(orders, parities)))

    def at(self, theta: FloatArray) -> FloatArray:
        """Return which segment lies over each angle (radians); -1 in between."""
        place = np.asarray(theta) * (self.count / (2.0 * np.pi))
        nearest = np.rint(place)
        beside = np.abs(place - nearest) > 0.5 * self.covered + 1e-12
        return np.where(beside, -1, np.mod(nearest, self.count)).astype(np.int64)
