"""The functions in which every field is expanded on a cylinder, and the radial wavenumbers that belong to them.

A mode is cos m theta or sin m theta times cos kz or sin kz. Its parities share every operator: only the order m and the axial
wavenumber k (in 1/a; 0 for the plane problem) tell modes apart. A fluid of slowness alpha = c_e/c gives it the radial wavenumber

    kappa^2 = alpha^2 s^2 + k^2,        Re kappa > 0,

the only place where k enters a fluid; s^2 in front of a wall's motion stays s^2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.operators import RadialFunctions
from coaxshell.numerics.arrays import ComplexArray, FloatArray


@dataclass(frozen=True, eq=False)
class Modes:
    """Circumferential orders at one axial wavenumber.

    Attributes
    ----------
    orders : ndarray, shape (M,)
        Ascending, all or a sample.
    wavenumber : float
        k, in units of 1/a.
    """

    orders: FloatArray
    wavenumber: float = 0.0

    @classmethod
    def up_to(cls, max_order: int, wavenumber: float = 0.0) -> Modes:
        """Return the orders 0, 1, ..., max_order."""
        return cls(np.arange(max_order + 1, dtype=np.float64), wavenumber)

    @property
    def max_order(self) -> int:
        """The highest order."""
        return int(self.orders[-1])

    @property
    def count(self) -> int:
        """Number of orders."""
        return int(self.orders.size)

    @property
    def key(self) -> tuple[bytes, float]:
        """What tells these modes from others, for caches."""
        return self.orders.tobytes(), self.wavenumber

    @property
    def neumann(self) -> FloatArray:
        """Neumann's factor as a column: 1 for order 0, else 2."""
        return np.where(self.orders == 0, 1.0, 2.0)[:, None]

    def kappa(self, slowness: float, s: ComplexArray) -> ComplexArray:
        """Return sqrt(alpha^2 s^2 + k^2), the root with a positive real part for Re s > 0."""
        along = slowness * s
        if self.wavenumber == 0.0:
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


class RadialBasis:
    """The Bessel ratios of some modes at some Laplace nodes, evaluated once for each slowness and radius.

    Parameters
    ----------
    modes : Modes
    s : ndarray, shape (nodes,)
        Laplace variable, Re s > 0.
    """

    def __init__(self, modes: Modes, s: ComplexArray) -> None:
        self.modes, self.s = modes, s
        self._known: dict[tuple[float, float], RadialFunctions] = {}

    def __call__(self, slowness: float, radius: float) -> RadialFunctions:
        """Return the ratios at kappa * radius of a fluid."""
        key = (slowness, radius)
        if key not in self._known:
            self._known[key] = self.passing(slowness, radius)
        return self._known[key]

    def passing(self, slowness: float, radius: float) -> RadialFunctions:
        """Return the ratios at a radius that is visited once: they are not kept."""
        return RadialFunctions(self.modes.kappa(slowness, self.s), radius, self.modes.orders)

    @property
    def surface(self) -> RadialFunctions:
        """Radial functions of the exterior fluid at r = 1."""
        return self(1.0, 1.0)
