"""One block of frequencies as quantities read it: the motion of the walls, and sums of orders that watch what is left out."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.synthesis import angle_basis
from coaxshell.solver.scaling import Problem
from coaxshell.solver.steady import SteadyMotion, SteadySystem

TOP = 0.2
"""Share of the orders whose own sum tells what those that are left out may be worth."""


@dataclass
class Tail:
    """The largest magnitude of a quantity, and of what the top fifth of its orders alone gives, over all blocks."""

    total: float = 0.0
    top: float = 0.0

    @property
    def share(self) -> float:
        """The second over the first."""
        return self.top / self.total if self.total > 0.0 else 0.0


@dataclass(eq=False)
class Steady:
    """A system at a block of frequencies.

    Attributes
    ----------
    system : SteadySystem
    motion : SteadyMotion
    tail : Tail
        Shared by all blocks.
    """

    system: SteadySystem
    motion: SteadyMotion
    tail: Tail = field(default_factory=Tail)

    @property
    def problem(self) -> Problem:
        """The problem."""
        return self.system.problem

    @property
    def s(self) -> ComplexArray:
        """(i + DAMPED) omega, shape (nodes,)."""
        return self.system.grid.nodes

    def around(self, modal: ComplexArray, theta: FloatArray, component: str = "normal") -> ComplexArray:
        """Return the sum of orders (parities, M + 1, nodes) at angles (degrees), shape (nodes, A)."""
        parities, orders, nodes = modal.shape
        basis = angle_basis(np.atleast_1d(theta), orders, parities, component)
        first = int((1.0 - TOP) * orders)
        above = basis[:, :, first:].reshape(len(basis), -1) @ modal[:, first:].reshape(-1, nodes)
        total = basis[:, :, :first].reshape(len(basis), -1) @ modal[:, :first].reshape(-1, nodes) + above
        self.tail.total = max(self.tail.total, float(np.abs(total).max(initial=0.0)))
        self.tail.top = max(self.tail.top, float(np.abs(above).max(initial=0.0)))
        return np.asarray(total.T)


def with_parities(modal: ComplexArray, parities: int) -> ComplexArray:
    """Return a modal array with zeros for the parities that it lacks."""
    if modal.shape[0] == parities:
        return modal
    full = np.zeros((parities, *modal.shape[1:]), np.complex128)
    full[: modal.shape[0]] = modal
    return full
