"""Steady motion at given frequencies, s = i omega, without any time step (theory manual, section "Steady motion").

Walls and fluids answer as they do on a Laplace contour, face by face (:mod:`coaxshell.solver.cascade`), linear absorbers are solved
exactly at each frequency. Nothing is inverted, so the frequencies may be any. Every field goes with e^{i omega t}.

On the imaginary axis itself the recurrence of I_m divides by zero at the zeros of J_m, and a pole without losses has no finite answer.
Frequencies are therefore taken with a damping ratio of :data:`DAMPED`, s = (i + DAMPED) omega.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.solver.cascade import CascadeSystem, FaceMotion
from coaxshell.solver.excitation import SourceGroup, incident_of
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, absorber_set
from coaxshell.solver.interface.linear import solve_linear
from coaxshell.solver.interface.linear_ring import is_ring, solve_ring
from coaxshell.solver.point_forces import point_force_shares
from coaxshell.solver.scaling import Problem

DAMPED = 1e-12
"""Re s/omega: a pole without losses is met as if it had this damping ratio."""


@dataclass(frozen=True, eq=False)
class Frequencies:
    """Values of s = (i + DAMPED) omega.

    Attributes
    ----------
    nodes : ndarray, shape (nodes,)
    """

    nodes: ComplexArray

    @classmethod
    def of(cls, omega: FloatArray) -> Frequencies:
        """Return those of angular frequencies, radians per transit."""
        return cls(np.asarray((DAMPED + 1j) * omega, dtype=np.complex128))

    @property
    def nyquist(self) -> float:
        """The highest of them."""
        return float(np.abs(self.nodes).max())


class LineForce(NamedTuple):
    """A force of 1 per length, positive inward, on the outer face of a wall at an angle (degrees)."""

    shell: int
    angle: float


@dataclass(frozen=True, eq=False)
class SteadyMotion:
    """The motion of all walls, each (shells, parities, M + 1, nodes), positive inward.

    Attributes
    ----------
    inner, outer : ndarray
        Displacements of the faces.
    load_inner, load_outer : ndarray
        Loads on them: of the fluids, and what is given on a face.
    slope, pressure : ndarray, shape (parities, M + 1, nodes)
        Of the incident wave at the outermost surface; zeros under a force.
    links : AbsorberSet
    link_force : ndarray, shape (N, 2, nodes)
        Of every absorber of the description, on the inner and on the outer shell.
    link_displacement : ndarray, shape (N, nodes)
    """

    inner: ComplexArray
    outer: ComplexArray
    load_inner: ComplexArray
    load_outer: ComplexArray
    slope: ComplexArray
    pressure: ComplexArray
    links: AbsorberSet
    link_force: ComplexArray
    link_displacement: ComplexArray

    @property
    def parities(self) -> int:
        """1 where all is even in theta, else 2."""
        return int(self.outer.shape[1])


class SteadySystem:
    """A system at some frequencies.

    Parameters
    ----------
    problem : Problem
        Its walls resolve the frequencies.
    grid : Frequencies
    modes : Modes

    Attributes
    ----------
    radial : RadialBasis
    """

    def __init__(self, problem: Problem, grid: Frequencies, modes: Modes) -> None:
        self.problem, self.grid, self.modes = problem, grid, modes
        self.radial = RadialBasis(modes, grid.nodes)
        self._cascade = CascadeSystem(problem, grid.nodes, modes, radial=self.radial)

    def under_sources(self, groups: list[SourceGroup], parities: int) -> SteadyMotion:
        """Return the motion under sources, with the spectra of their pulses at these frequencies."""
        pressure, slope = incident_of(groups, parities, self.grid, self.radial)
        load = pressure - self.radial(1.0, self.problem.head).exterior * slope  # with what a rigid surface scatters
        return self._linked(np.stack([_stacked(self._cascade.solve_outside(one)) for one in load], axis=2), slope, pressure)

    def under_force(self, force: LineForce) -> SteadyMotion:
        """Return the motion under a line force."""
        wall, parities = self.problem.shells[force.shell], 2 if force.angle % 180.0 else 1
        side = None if wall.faces_move_alike else 1
        circle = np.pi * (wall.radius if side is None else wall.wetted[1]) * np.where(self.modes.column == 0, 2.0, 1.0)
        shape, still = (self.modes.count, self.grid.nodes.size), np.zeros((parities, self.modes.count, self.grid.nodes.size), np.complex128)
        loads = [np.broadcast_to(self.modes.projection(force.angle, parity) / circle, shape) for parity in range(parities)]
        found = [_stacked(self._cascade.solve(force.shell, np.asarray(load, np.complex128), side)) for load in loads]
        return self._linked(np.stack(found, axis=2), still, still)

    @cached_property
    def compliance(self) -> ComplexArray:
        """Displacement of surface i per modal pressure on surface j, shape (surfaces, surfaces, M + 1, nodes)."""
        surfaces = self.problem.surfaces
        columns = [self._cascade.solve(one.shell, 1.0, one.side) for one in surfaces]
        moved = [[column[i].inner if side == 0 else column[i].outer for i, side, _ in surfaces] for column in columns]
        return np.stack([np.stack(column) for column in moved], axis=1)

    def _linked(self, bare: ComplexArray, slope: ComplexArray, pressure: ComplexArray) -> SteadyMotion:
        """Return the motion with absorbers from that without, shape (4, shells, parities, M + 1, nodes)."""
        system = self.problem.system
        links = absorber_set(self.problem, system.absorber_list, bare.shape[2])
        if not links.count:
            nodes = self.grid.nodes.size
            force, moved = np.zeros((0, 2, nodes), np.complex128), np.zeros((0, nodes), np.complex128)
            return SteadyMotion(bare[0], bare[1], bare[2], bare[3], slope, pressure, links, force, moved)
        if links.of_any_law:
            remedy = "leave it out, or use laws that are linear: linear, maxwell, and inertance"
            raise InputError("absorbers.law", "is not linear, and the answer at a frequency is that of linear absorbers", remedy)
        surfaces = self.problem.surfaces
        moved_alone = np.stack([bare[0 if side == 0 else 1, i] for i, side, _ in surfaces])
        alone = _Alone(self.problem, self.grid, self.modes, bare[1], moved_alone, self.compliance)
        if is_ring(links) and self.problem.point_force_shares is point_force_shares:
            found = solve_ring(alone, links)
        else:
            found = solve_linear(alone, links, InterfacePoints(self.problem, links, self.modes))
        total = np.zeros((*bare.shape[:2], links.parities, *bare.shape[3:]), np.complex128)
        total[:, :, : bare.shape[2]] = bare
        for surface, by_parity in zip(surfaces, found.modal_pressure, strict=True):
            for parity, load in enumerate(by_parity):
                if np.any(load):
                    total[:, :, parity] += _stacked(self._cascade.solve(surface.shell, load, surface.side))
        sides = found.force.reshape(2, links.count, -1).swapaxes(0, 1)[links.member]
        moved = found.mass_displacement[links.member]
        return SteadyMotion(total[0], total[1], total[2], total[3], slope, pressure, links, sides, moved)


class _Alone(NamedTuple):
    """A structure without its absorbers, as they need it (:class:`coaxshell.solver.interface.linear.LinearStructure`)."""

    problem: Problem
    grid: Frequencies
    modes: Modes
    normal: ComplexArray
    surface_motion: ComplexArray
    compliance: ComplexArray


def _stacked(faces: Sequence[FaceMotion]) -> ComplexArray:
    """Return faces and loads of all shells, shape (4, shells, M + 1, nodes)."""
    return np.stack([np.stack(part) for part in zip(*faces, strict=True)])
