"""The motion of a finished run in the form that energies are made of: transforms, histories, and weights of the circle."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.excitation import incident_on_surface
from coaxshell.solver.interface.link_motion import LinkMotion
from coaxshell.solver.recompute import spectra_of
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import FacedMotion, SolidSpectra, band
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra

Incident = Callable[[RadialBasis], tuple[ComplexArray, ComplexArray]]
"""From the radial functions at all nodes to the modal pressure of the undisturbed waves at the outermost surface and its slope."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Motion of all shells in the orders of one axial wavenumber, 0 in two dimensions.

    Every quantity of an energy balance passes the same roll-off of the spectra, so that all of them belong to one motion of
    the same linear system and the balance between them is exact.

    Attributes
    ----------
    problem : Problem
    grid : LaplaceGrid
        On which the run was solved: all its instants, of which a refined run kept some.
    modes : Modes
    normal, tangential : ndarray, shape (shells, parities, M + 1, nodes)
        Transforms of W and V. Energies do not ask which parity is which: those of the axis stand beside those of the circle.
    axial : ndarray or None
        That of U, None where nothing moves along the axis.
    every : int
        Stores are taken at every such instant of the grid.
    incident : callable
        The waves as if nothing were there, at the outermost surface.
    links : LinkMotion or None
        Of the absorbers, if there are any.
    actuation : ndarray, shape (shells, parities, M + 1, T), or None
        Modal pressure that saturating actuators gave, None where the linear law held throughout.
    voltage : ndarray, shape (shells, parities, M + 1, nodes), or None
        Transforms of the actuators' voltages, where they are no law of each order's own motion.
    solid : SolidSpectra, FacedMotion or None
        What walls whose faces move differently do.
    usual_power : ndarray, shape (shells,), or None
        Of a motion that is one of many: all :meth:`power` of each wall in such a one on average. What is left out of a motion is measured
        by it where the motion has less.
    around : int
        How many parities there are of the circle, for each of the axis; all where there is none of the axis.
    charged : ndarray, shape (orders,), or None
        By how much more voltages charge layers than they move walls.
    """

    problem: Problem
    grid: LaplaceGrid
    modes: Modes
    normal: ComplexArray
    tangential: ComplexArray
    axial: ComplexArray | None
    every: int
    incident: Incident
    links: LinkMotion | None = None
    actuation: FloatArray | None = None
    voltage: ComplexArray | None = None
    solid: SolidSpectra | FacedMotion | None = None
    usual_power: FloatArray | None = None
    around: int = 2
    charged: FloatArray | None = None

    @classmethod
    def of(cls, solution: ModalSolution, every: int, spectra: SolvedSpectra | None = None) -> Motion:
        """Return the motion of a two-dimensional run, made again from its solution.

        Parameters
        ----------
        solution : ModalSolution
        every : int
            Stores are taken at every such instant that the run kept.
        spectra : SolvedSpectra, optional
            Those of the solution, if known.
        """
        known = spectra_of(solution) if spectra is None else spectra
        return cls(
            problem=solution.problem.resolving(band(known.grid)),
            grid=known.grid,
            modes=known.modes,
            normal=known.normal,
            tangential=known.tangential,
            axial=None,
            every=every * solution.settings.refinement,
            incident=partial(incident_on_surface, known.problem, known.grid, returned=known.structure.returned),
            links=known.links,
            actuation=known.actuation,
            voltage=known.voltage,
            solid=known.solid,
        )

    @property
    def wavenumber(self) -> float:
        """k, in 1/a."""
        assert isinstance(self.modes.wavenumber, (int, float))
        return self.modes.wavenumber

    @property
    def kept(self) -> slice:
        """The grid's instants at which stores are taken, ``every`` steps apart."""
        return slice(None, None, self.every)

    @cached_property
    def circle(self) -> FloatArray:
        """Integrals of cos^2(m theta) over the circle, beta pi, shape (M + 1,)."""
        return np.pi * np.where(self.modes.orders == 0, 2.0, 1.0)

    @cached_property
    def normal_velocity(self) -> ComplexArray:
        """Transform of dW/dt, shape (shells, parities, M + 1, nodes)."""
        return self.normal * self.grid.nodes

    def face_velocity(self, shell: int, side: int) -> ComplexArray:
        """Return the transform of dW/dt of the inner (0) or the outer (1) face of a wall, shape (parities, M + 1, nodes)."""
        if self.solid is None:
            return np.asarray(self.normal_velocity[shell])
        return np.asarray(self._face_velocities[side, shell])

    @cached_property
    def _face_velocities(self) -> ComplexArray:
        assert self.solid is not None
        return np.asarray(self.solid.faces * self.grid.nodes)

    def power(self, wall: int) -> FloatArray:
        """Return how the kinetic energy of a wall's normal motion is spread over the nodes, in a unit of its own, shape (nodes,).

        Of walls of two faces that of both: thickness resonances show at the faces and leave the middle at rest.
        """
        moving = [self.normal_velocity[wall]] if self.solid is None else self._face_velocities[:, wall]
        total = sum(np.einsum("m,hmk->k", self.circle, np.abs(velocity) ** 2) for velocity in moving)
        return np.asarray(total * self.grid.taper() ** 2)

    def histories(self, shell: int) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return W, V, dW/dt and dV/dt of one shell, each of shape (parities, M + 1, T)."""
        w, v, s = self.normal[shell], self.tangential[shell], self.grid.nodes
        w, v, dw, dv = (self.grid.invert(x) for x in (w, v, w * s, v * s))
        return w, v, dw, dv

    def axial_histories(self, shell: int) -> tuple[FloatArray, FloatArray] | tuple[None, None]:
        """Return U and dU/dt of one shell, each of shape (parities, M + 1, T); None where nothing moves along the axis."""
        if self.axial is None:
            return None, None
        u = self.axial[shell]
        return self.grid.invert(u), self.grid.invert(u * self.grid.nodes)
