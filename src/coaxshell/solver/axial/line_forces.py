"""Forces of line absorbers along the axis, as loads on the waves of a three-dimensional run.

A force per length f(z) at theta_n on a surface of radius R is, F(k) the integral of f cos k(z - z_0) over an axial period, the pressure

    P(m, k) = F(k) h_m [cos, sin](m theta_n)/(beta_m pi R),    f(z) = (1/L) [F(k_0) + 2 sum_{j>=1} F(k_j) cos k_j (z - z_0)] + odd,

h_m = sinc(m b/2R) where it is spread over an arc of length b, else 1.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.lines import LineLayout
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.scaling import Problem


@dataclass(frozen=True, eq=False)
class LineForces:
    """Transforms of the forces of all line absorbers at every axial wavenumber.

    Attributes
    ----------
    layout : LineLayout
    force : ndarray, shape (waves, 2N, axial parities, nodes)
        F, of the absorbers carried, positive inward, those on the inner shells first.
    """

    layout: LineLayout
    force: ComplexArray

    @property
    def parities(self) -> int:
        """How many parities the motion around the circle has."""
        return self.layout.absorbers.parities

    @property
    def origin(self) -> float:
        """z_0, in a."""
        return self.layout.origin

    @property
    def axial_parities(self) -> int:
        """1 where everything is even about the origin, else 2."""
        return self.layout.axial_parities

    @property
    def sampling(self) -> AxialSampling:
        """The waves at whose wavenumbers they are known."""
        return self.layout.sampling

    def at(self, nodes: slice) -> LineForces:
        """Return the forces at a slice of their nodes."""
        return replace(self, force=self.force[..., nodes])

    def loads(self, problem: Problem, modes: Modes, *, odd: bool) -> dict[int, list[ComplexArray]]:
        """Return the pressure amplitudes on surfaces, by number, even or odd along z: one (orders, nodes) a parity around.

        Between the wavenumbers of the run forces are those of the nearest, above them those of the last.
        """
        assert isinstance(modes.wavenumber, float)  # forces make no waves of a complex wavenumber
        nearest = round(modes.wavenumber / self.layout.sampling.spacing)
        force = self.force[min(nearest, len(self.force) - 1), :, int(odd)]
        absorbers = self.layout.absorbers
        shares, weighed = problem.point_force_shares(absorbers, modes), absorbers.footprint is not None or absorbers.elements is not None
        means = absorbers.means(problem, modes) * absorbers.held[:, :, None] if weighed else np.ones((2, absorbers.count, 1))
        found: dict[int, list[ComplexArray]] = {}
        for side in (0, 1):
            for number in np.unique(absorbers.surfaces[side]):
                surface, chosen = int(number), np.flatnonzero(absorbers.surfaces[side] == number)
                columns = np.ascontiguousarray(force[chosen + side * absorbers.count]).view(np.float64)
                spread = [(share[chosen] * means[side, chosen]).T if weighed else share[chosen].T for share in shares]
                loads = [(each @ columns).view(np.complex128) / problem.surfaces[surface].radius for each in spread]
                before = found.get(surface)
                found[surface] = loads if before is None else [a + b for a, b in zip(before, loads, strict=True)]
        return found


def line_forces(layout: LineLayout, amplitudes: ComplexArray) -> LineForces:
    """Return forces from transforms of their amplitudes along the axis, (waves, 2N, axial parities, nodes): F_0 = L f_0, else L f_j/2."""
    return LineForces(layout, amplitudes * layout.squares[:, None, None, None])
