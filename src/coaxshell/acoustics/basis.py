"""The Bessel ratios of modes, and the radial wavenumbers that belong to them.

A fluid of slowness alpha = c_e/c gives the modes of axial wavenumber k the radial wavenumber

    kappa^2 = alpha^2 s^2 + k^2,        Re kappa > 0,

the only place where k enters a fluid; s^2 in front of a wall's motion stays s^2.
"""

from __future__ import annotations

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.radial_functions import RadialFunctions

__all__ = ["Modes", "RadialBasis"]


class RadialBasis:
    """The Bessel ratios of some modes at some Laplace nodes, evaluated once for each slowness and radius.

    Parameters
    ----------
    modes : Modes
    s : ndarray, shape (nodes,)
        Laplace variable, Re s > 0 unless ``left``.
    left : bool
        Whether s may lie on the imaginary axis or, not far, to its left: where systems ring. kappa is continued from the right, past
        the ends of its branch cuts at s = +-i k/alpha.
    """

    def __init__(self, modes: Modes, s: ComplexArray, *, left: bool = False) -> None:
        self.modes, self.s, self._left = modes, s, left
        self._known: dict[tuple[float, float], RadialFunctions] = {}

    def __call__(self, slowness: float, radius: float) -> RadialFunctions:
        """Return the ratios at kappa * radius of a fluid."""
        key = (slowness, radius)
        if key not in self._known:
            self._known[key] = self.passing(slowness, radius)
        return self._known[key]

    def passing(self, slowness: float, radius: float) -> RadialFunctions:
        """Return the ratios at a radius that is visited once: they are not kept."""
        return RadialFunctions(self.modes.kappa(slowness, self.s), radius, self.modes.orders, self.modes.sparse, self._left)

    @property
    def surface(self) -> RadialFunctions:
        """Radial functions of the exterior fluid at r = 1."""
        return self(1.0, 1.0)
