"""Points of walls that are held over a patch, and forces there as loads on the waves of a three-dimensional run.

A force F at theta_b, z_b on a surface of radius R, spread evenly over a square patch of side f, is the pressure of amplitude

    P(m, k) = F h_m h_k [cos, sin](m theta_b) [cos, sin](k z_b)/(beta_m pi R),        h_m = sinc(m f/2R),  h_k = sinc(k f/2),

beta_0 = 2 else 1, of waves that count 1/L for k = 0 and 2/L for the others, L the axial period; and a point moves as the mean of the
wall over its patch, h_m h_k again.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.point_forces import patch
from coaxshell.solver.scaling import Problem


@dataclass(frozen=True, eq=False)
class WallPoints:
    """Points of walls, all of them: two an absorber, those on the inner shells first.

    Attributes
    ----------
    surface : ndarray of int, shape (P,)
        Of the problem (:attr:`coaxshell.solver.scaling.Problem.surfaces`).
    angle : ndarray, shape (P,)
        Degrees.
    z, side : ndarray, shape (P,)
        Axial position and side of the patch, in a.
    """

    surface: npt.NDArray[np.int64]
    angle: FloatArray
    z: FloatArray
    side: FloatArray

    @property
    def count(self) -> int:
        """P."""
        return int(self.surface.size)

    def subset(self, chosen: npt.NDArray[np.int64]) -> WallPoints:
        """Return some of the points."""
        return WallPoints(self.surface[chosen], self.angle[chosen], self.z[chosen], self.side[chosen])

    def around(self, problem: Problem, modes: Modes, parity: int) -> FloatArray:
        """Return h_m cos m theta or, for parity 1, h_m sin m theta: shape (P, orders)."""
        shapes = np.array([modes.projection(float(angle), parity)[:, 0] for angle in self.angle]).reshape(self.count, -1)
        return np.asarray(shapes * self.means(problem, modes), dtype=np.float64)

    def radius(self, problem: Problem) -> FloatArray:
        """Return R of the surfaces that they lie on, in a, shape (P,)."""
        return np.array([problem.surfaces[i].radius for i in self.surface])

    def means(self, problem: Problem, modes: Modes) -> FloatArray:
        """Return h_m, shape (P, orders)."""
        return patch(np.multiply.outer(self.side / (2.0 * self.radius(problem)), modes.orders))

    def pressed(self, problem: Problem, modes: Modes, parity: int) -> FloatArray:
        """Return the pressure of each order per unit force at a point, but for the axis: shape (P, orders)."""
        beta_pi = np.pi * np.where(modes.orders == 0, 2.0, 1.0)
        return np.asarray(self.around(problem, modes, parity) / (beta_pi * self.radius(problem)[:, None]), dtype=np.float64)

    def along(self, wavenumber: float) -> FloatArray:
        """Return h_k, shape (P,)."""
        return patch(0.5 * wavenumber * self.side)


@dataclass(frozen=True, eq=False)
class PointForces:
    """Transforms of the forces at all points of a run, as loads on the waves.

    Attributes
    ----------
    points : WallPoints
    force : ndarray, shape (P, nodes)
        Positive inward, in units of rho_e c_e^2 a^2.
    parities : int
    """

    points: WallPoints
    force: ComplexArray
    parities: int
    origin = 0.0
    axial_parities = 2
    sampling = None

    def at(self, nodes: slice) -> PointForces:
        """Return the forces at a slice of their nodes."""
        return PointForces(self.points, self.force[:, nodes], self.parities)

    def loads(self, problem: Problem, modes: Modes, *, odd: bool) -> dict[int, list[ComplexArray]]:
        """Return the pressure amplitudes on surfaces, of the functions even or odd along z: one (orders, nodes) a parity around."""
        k = modes.wavenumber
        assert isinstance(k, float)  # forces make no waves of a complex wavenumber
        found: dict[int, list[ComplexArray]] = {}
        for surface in np.unique(self.points.surface):
            chosen = np.flatnonzero(self.points.surface == surface)
            here = self.points.subset(chosen)
            along = here.along(k) * (np.sin(k * here.z) if odd else np.cos(k * here.z))
            columns = np.ascontiguousarray(self.force[chosen] * along[:, None]).view(np.float64)
            found[int(surface)] = [
                (here.pressed(problem, modes, parity).T @ columns).view(np.complex128) for parity in range(self.parities)
            ]
        return found
