"""The motion of a finished run in the form that energies are made of: transforms, histories, and weights of the circle."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.recompute import spectra_of
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra


class Motion:
    """Displacements and velocities of all shells of a finished run, made again from its solution.

    Every quantity of an energy balance passes the same roll-off of the spectra, so that all of them belong to one motion of
    the same linear system and the balance between them is exact.

    Parameters
    ----------
    solution : ModalSolution
    every : int
        Stores are taken at every such instant that the run kept.
    spectra : SolvedSpectra, optional
        Those of the solution, if known.
    """

    def __init__(self, solution: ModalSolution, every: int, spectra: SolvedSpectra | None = None) -> None:
        self.solution = solution
        self.spectra = spectra_of(solution) if spectra is None else spectra
        self.every = every * solution.settings.refinement

    @property
    def problem(self) -> Problem:
        """The dimensionless problem."""
        return self.solution.problem

    @property
    def grid(self) -> LaplaceGrid:
        """The Laplace grid on which the run was solved: all its instants, of which a refined run kept some."""
        return self.spectra.grid

    @property
    def kept(self) -> slice:
        """The grid's instants at which stores are taken, ``every`` steps apart."""
        return slice(None, None, self.every)

    @cached_property
    def orders(self) -> FloatArray:
        """Orders 0, 1, ..., M."""
        return self.spectra.modes.orders

    @cached_property
    def circle(self) -> FloatArray:
        """Integrals of cos^2(m theta) over the circle, beta pi, shape (M + 1,)."""
        return np.pi * np.where(self.orders == 0, 2.0, 1.0)

    @cached_property
    def normal_velocity(self) -> ComplexArray:
        """Transform of dW/dt, shape (shells, parities, M + 1, nodes)."""
        return self.spectra.normal * self.grid.nodes

    def histories(self, shell: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return W, V, dW/dt and dV/dt of one shell, each of shape (parities, M + 1, T)."""
        w, v, s = self.spectra.normal[shell], self.spectra.tangential[shell], self.grid.nodes
        w, v, dw, dv = (self.grid.invert(x) for x in (w, v, w * s, v * s))
        return w, v, dw, dv
