"""What forces on the walls tell the waves of a three-dimensional run: how they load each of them."""

from __future__ import annotations

from typing import Protocol

from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.scaling import Problem


class WallForces(Protocol):
    """Transforms of forces on the walls at some Laplace nodes, as loads on waves that count 1/L for k = 0 and 2/L for the others."""

    @property
    def parities(self) -> int:
        """How many parities the motion around the circle has."""
        ...

    @property
    def origin(self) -> float:
        """z about which waves are even or odd, in a."""
        ...

    @property
    def axial_parities(self) -> int:
        """1 where everything is even about the origin, else 2."""
        ...

    @property
    def sampling(self) -> AxialSampling | None:
        """The waves at whose wavenumbers alone they are known; None of those that are known at any."""
        ...

    def at(self, nodes: slice) -> WallForces:
        """Return the forces at a slice of their nodes."""
        ...

    def loads(self, problem: Problem, modes: Modes, *, odd: bool) -> dict[int, list[ComplexArray]]:
        """Return the pressure amplitudes on surfaces, by number, even or odd along z: one (orders, nodes) a parity around."""
        ...
