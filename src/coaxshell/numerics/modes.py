"""The functions in which every field is expanded on a cylinder.

A mode is cos m theta or sin m theta times cos kz or sin kz. Its parities share every operator: only the order m and the axial
wavenumber k (in 1/a; 0 for the plane problem) tell modes apart.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import wraps
from typing import Any, TypeVar
from weakref import WeakKeyDictionary

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray


@dataclass(frozen=True, eq=False)
class Modes:
    """Circumferential orders at one axial wavenumber.

    Attributes
    ----------
    orders : ndarray, shape (M,)
        Ascending, all or a sample.
    wavenumber : float or ndarray of complex, shape (nodes,)
        k, in units of 1/a; one for each Laplace node where a wave runs along the axis, k = -i s sin(alpha).
    sparse : bool
        Whether the orders are few of many: the recurrences of the Bessel functions then leave out what lies between (not to the last bit
        what they give at all orders).
    whole : Modes or None
        Modes in use of which these are some: what is kept of all of them need not be made again.
    """

    orders: FloatArray
    wavenumber: float | ComplexArray = 0.0
    sparse: bool = False
    whole: Modes | None = None

    @classmethod
    def up_to(cls, max_order: int, wavenumber: float | ComplexArray = 0.0) -> Modes:
        """Return the orders 0, 1, ..., max_order."""
        return cls(np.arange(max_order + 1, dtype=np.float64), wavenumber)

    def some(self, places: npt.NDArray[np.int64]) -> Modes:
        """Return a sample of these modes, by ascending places among them."""
        return Modes(self.orders[places], self.wavenumber, sparse=True, whole=self)

    @property
    def max_order(self) -> int:
        """The highest order."""
        return int(self.orders[-1])

    @property
    def count(self) -> int:
        """Number of orders."""
        return int(self.orders.size)

    @property
    def column(self) -> FloatArray:
        """The orders with an axis for the nodes."""
        return self.orders[:, None]

    @property
    def key(self) -> tuple[bytes, bytes, bool]:
        """What tells these modes from others, for caches."""
        return self.orders.tobytes(), np.asarray(self.wavenumber).tobytes(), self.sparse

    @property
    def two_dimensional(self) -> bool:
        """Whether nothing changes along the axis: k = 0."""
        return not np.any(self.wavenumber)

    @property
    def neumann(self) -> FloatArray:
        """Neumann's factor as a column: 1 for order 0, else 2."""
        return np.where(self.orders == 0, 1.0, 2.0)[:, None]

    def kappa(self, slowness: float, s: ComplexArray) -> ComplexArray:
        """Return sqrt(alpha^2 s^2 + k^2), the root with a positive real part for Re s > 0."""
        return self.radial(slowness * s)

    def radial(self, along: ComplexArray) -> ComplexArray:
        """Return sqrt(q^2 + k^2), of q with a positive real part the root that has one too."""
        if self.two_dimensional:
            return along
        return np.asarray(np.sqrt(along - 1j * self.wavenumber) * np.sqrt(along + 1j * self.wavenumber))

    def gradient_squared(self, radius: float) -> FloatArray:
        """Return (m/r)^2 + k^2: the mean square of a mode's gradient along the wall per mean square of the mode."""
        return np.asarray((self.orders / radius) ** 2 + self.wavenumber**2)

    def projection(self, angle: float, parity: int) -> FloatArray:
        """Return cos(m angle), or sin(m angle) for parity 1, as a column; exact at multiples of 90 degrees: symmetric systems stay so.

        Parameters
        ----------
        angle : float
            Degrees.
        parity : int
        """
        turns = np.mod(self.orders * angle, 360.0)[:, None]
        exact = {0.0: (1.0, 0.0), 90.0: (0.0, 1.0), 180.0: (-1.0, 0.0), 270.0: (0.0, -1.0)}
        value = np.cos(np.radians(turns)) if parity == 0 else np.sin(np.radians(turns))
        for multiple, pair in exact.items():
            value = np.where(turns == multiple, pair[parity], value)
        return value


Thing = TypeVar("Thing")
Found = TypeVar("Found")
_kept: WeakKeyDictionary[Modes, dict[tuple[Any, int], tuple[object, Any]]] = WeakKeyDictionary()


def kept_with_modes(function: Callable[[Thing, Modes], Found]) -> Callable[[Thing, Modes], Found]:
    """Let what a function finds of a thing that never changes and of modes of one wavenumber be kept as long as the modes are.

    Blocks of Laplace nodes share their modes: it is then found once, not once a block. Nobody may change what is found.
    """

    @wraps(function)
    def found(thing: Thing, modes: Modes) -> Found:
        if np.ndim(modes.wavenumber):
            return function(thing, modes)
        known, key = _kept.setdefault(modes, {}), (function, id(thing))
        if key not in known:
            known[key] = thing, function(thing, modes)  # with the thing, whose number is then nobody else's
        value: Found = known[key][1]
        return value

    return found
