"""Electrodes cut along the axis into equal belts: what they read of waves along it, and what their voltages are in these.

Belt n has its middle at z_n = n p, p the pitch, and is l long; strips between belts are at ground. It reads the mean of what lies under
it, and its voltage is the same all along it. With an axial period of P belts, k_q = 2 pi q/(P p) and rho_q = sin(k_q l/2)/(k_q l/2), the
waves A_q cos k_q z + B_q sin k_q z are read as

    phi_n = sum_c (cos 2 pi c n/P sum_q rho_q A_q + sin 2 pi c n/P sum_q eps_q rho_q B_q),      q = j P +- c,

for the P belts cannot tell waves apart whose numbers differ by P: those are a class c, 0 to P/2, and eps_q = 1 where q = j P + c, -1 where
q = j P - c, 0 where both are the same. Voltages U_n of the same form, U_c and U'_c, are in waves

    A_q = (l/p) g_q rho_q U_c,      B_q = (l/p) eps_q rho_q U'_c,

g_q = 2 where q = j P + c and j P - c are the same and q > 0, else 1. What a wave reads of what it is given, r_q = (l/p) g_q rho_q^2, adds
up to 1 in every class.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from coaxshell.numerics.arrays import FloatArray


@dataclass(frozen=True)
class Belts:
    """The belts of the walls under control.

    Attributes
    ----------
    pitch : float
        p, from middle to middle, in a.
    length : float
        l, of each along the axis, in a.
    dead_belts : tuple of int
        Those that are held at ground whole.
    dead_electrodes : tuple of (int, int)
        Belt and segment of others that are.
    """

    pitch: float
    length: float
    dead_belts: tuple[int, ...] = ()
    dead_electrodes: tuple[tuple[int, int], ...] = ()

    @property
    def broken(self) -> bool:
        """Whether single belts or electrodes of them are dead, which ties all classes of waves."""
        return bool(self.dead_belts or self.dead_electrodes)

    @property
    def dead_ends(self) -> tuple[float, ...]:
        """Where belts of which something is dead begin and end, in a, belt by belt."""
        dead, half = sorted({*self.dead_belts, *(belt for belt, _ in self.dead_electrodes)}), 0.5 * self.length
        return tuple(n * self.pitch + end for n in dead for end in (-half, half))

    @property
    def lopsided(self) -> bool:
        """Whether what is dead is not even about z = 0."""
        whole, single = set(self.dead_belts), set(self.dead_electrodes)
        return whole != {-n for n in whole} or single != {(-n, segment) for n, segment in single}

    def dead_at(self, z: float) -> tuple[int, ...]:
        """Return the segments that are dead, alone, in the belt next to a place (in a)."""
        nearest = round(z / self.pitch)
        return tuple(segment for belt, segment in self.dead_electrodes if belt == nearest)

    @property
    def covered(self) -> float:
        """Share of the length that lies under electrodes, l/p."""
        return self.length / self.pitch

    def share(self, wavenumbers: FloatArray) -> FloatArray:
        """Return rho of wavenumbers (in 1/a)."""
        return np.asarray(np.sinc(wavenumbers * (self.length / (2.0 * np.pi))))

    def count(self, period: float) -> int:
        """Return how many belts an axial period (in a) has."""
        return round(period / self.pitch)

    def over(self, z: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the number of the belt next to each place (in a), and 1 where it lies over it, else 0, as of dead belts."""
        nearest = np.rint(np.asarray(z) / self.pitch)
        beside = np.abs(z - nearest * self.pitch) > 0.5 * self.length * (1.0 + 1e-12)
        return nearest, np.where(beside | np.isin(nearest, self.dead_belts), 0.0, 1.0)


@dataclass(frozen=True, eq=False)
class BeltClasses:
    """The classes of the waves of an axial period.

    Attributes
    ----------
    belts : Belts
    count : int
        P, belts of the period.
    wavenumbers : ndarray, shape (waves,)
        k_q, ascending from k_0 = 0, in 1/a.
    """

    belts: Belts
    count: int
    wavenumbers: FloatArray

    @property
    def classes(self) -> int:
        """Number of classes, P/2 + 1."""
        return self.count // 2 + 1

    @cached_property
    def _numbers(self) -> FloatArray:
        return np.arange(self.wavenumbers.size, dtype=np.float64)

    @cached_property
    def of(self) -> FloatArray:
        """c of each wave, shape (waves,)."""
        return np.asarray(np.abs(self._numbers - self.count * np.rint(self._numbers / self.count)))

    @cached_property
    def alone(self) -> FloatArray:
        """Whether j P + c and j P - c are the same waves, as 1 or 0, shape (waves,)."""
        return np.where((self.of == 0.0) | (2.0 * self.of == self.count), 1.0, 0.0)

    @cached_property
    def read(self) -> FloatArray:
        """What belts read of cosines, rho_q, and of sines, eps_q rho_q, shape (2, waves)."""
        rho = self.belts.share(self.wavenumbers)
        sign = np.sign(self._numbers - self.count * np.rint(self._numbers / self.count)) * (1.0 - self.alone)
        return np.stack([rho, sign * rho])

    @cached_property
    def push(self) -> FloatArray:
        """A_q per U_c and B_q per U'_c, shape (2, waves)."""
        twice = np.where((self.alone == 1.0) & (self._numbers > 0.0), 2.0, 1.0)
        return self.belts.covered * np.stack([twice, np.ones_like(twice)]) * self.read

    @cached_property
    def loop_shares(self) -> FloatArray:
        """r_q, shape (waves,)."""
        return np.asarray(self.push[0] * self.read[0])

    def waves_of(self, number: int) -> list[int]:
        """Return the waves of a class, ascending."""
        return [int(one) for one in np.flatnonzero(self.of == number)]

    def kept(self, tops: FloatArray, orders: FloatArray) -> FloatArray:
        """Return the sum of r_q over the waves that have an order, of each class and order, (classes, orders).

        Parameters
        ----------
        tops : ndarray, shape (waves,)
            The highest order of each wave.
        orders : ndarray, shape (orders,)
        """
        shares = self.loop_shares[:, None] * (tops[:, None] >= orders)
        found = np.zeros((self.classes, orders.size))
        np.add.at(found, self.of.astype(int), shares)
        return found

    def patterns(self, belts: FloatArray) -> FloatArray:
        """Return cos 2 pi c n/P and sin 2 pi c n/P at some belts n, shape (2, belts, classes)."""
        phase = 2.0 * np.pi / self.count * np.multiply.outer(belts, np.arange(float(self.classes)))
        return np.stack([np.cos(phase), np.sin(phase)])
