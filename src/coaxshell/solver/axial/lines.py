"""Line absorbers in three dimensions: uniform along the axis, and at every z as free as anywhere else.

An absorber at theta_n is a continuum of oscillators side by side. With its properties per metre, at every z by itself

    f_j(z) = c dD_j/dt + k_l D_j + k_nl D_j^3,    D_j = q(z) - w_j(theta_n, z),    m d2q/dt2 = -f_0 - f_1,

so that what is linear in it is the same at every axial wavenumber: the interface of two dimensions once for each of them. Only the cubes
couple wavenumbers, or other laws that are not linear; a law remembers at every z what it went through there.

Where all angles lie on a lattice, theta_0 + 360 n/N degrees, cos m(theta_a - theta_b) is the same for all orders m = +-l (mod N): their
compliances are added up beforehand, and N/2 classes l take the place of the orders.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeVar

import numpy as np

from coaxshell.acoustics.sources import PlaneGeometry, SphericalFrontGeometry
from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.families import axial_position
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.series import AxialSeries
from coaxshell.solver.excitation import source_parities
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints, absorber_set
from coaxshell.solver.interface.lattice import folding, lattice_of
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import Settings

Numbers = TypeVar("Numbers", FloatArray, ComplexArray)


@dataclass(frozen=True, eq=False)
class LineLayout:
    """The line absorbers of a run.

    Attributes
    ----------
    problem : Problem
    sampling : AxialSampling
    absorbers : AbsorberSet
        Dimensionless, mirror images about theta = 0 carried once where the motion is symmetric.
    lattice : int
        N of the lattice on which all angles lie, 0 if it has no fewer classes than there are orders.
    origin : float
        z_0, in a: the plane of all sources, or 0.
    axial_parities : int
        1 where everything is even about z_0, else 2.
    """

    problem: Problem
    sampling: AxialSampling
    absorbers: AbsorberSet
    lattice: int
    origin: float
    axial_parities: int

    @cached_property
    def classes(self) -> Modes:
        """The classes of orders, or all orders."""
        return Modes.up_to(self.lattice // 2 if self.lattice else self.sampling.max_order)

    @cached_property
    def points(self) -> InterfacePoints:
        """The points of every cross-section at which absorbers hold the walls, in terms of the classes.

        Where these are those of a lattice, what is folded into them has the h_m of the arcs already.
        """
        absorbers = replace(self.absorbers, footprint=None) if self.lattice else self.absorbers
        return InterfacePoints(self.problem, absorbers, self.classes)

    def felt(self, modes: Modes) -> FloatArray:
        """Return what the points feel of the orders of a wavenumber, h_m cos m theta_n, h_m sin m theta_n, (parities, 2N, orders)."""
        shapes = np.tile(self.absorbers.shapes(modes), (1, 2, 1)) * self.absorbers.held.reshape(-1, 1)
        if self.absorbers.footprint is None:
            return shapes
        return np.asarray(shapes * self.absorbers.means(self.problem, modes).reshape(2 * self.absorbers.count, -1))

    @cached_property
    def series(self) -> AxialSeries:
        """Sums along the axis of everything that the absorbers do."""
        return AxialSeries(len(self.sampling.modes), self.axial_parities)

    @cached_property
    def _folding(self) -> FloatArray:
        """Share of each order in each class, shape (classes, M + 1)."""
        return folding(self.lattice, self.sampling.max_order)

    def folded(self, values: Numbers) -> Numbers:
        """Return compliances or kernels of the orders of a wavenumber, (surfaces, surfaces, orders, n), added up by classes."""
        count = values.shape[-2]
        if self.lattice and self.absorbers.footprint is not None:
            held = self._held[:, :count]
            values = values * (held[:, None] * held)[..., None]
        if self.lattice:
            sums: Numbers = self._folding[:, :count] @ values
            return sums
        found = np.zeros((*values.shape[:-2], self.classes.count, values.shape[-1]), values.dtype)
        found[..., :count, :] = values
        return found

    @cached_property
    def _held(self) -> FloatArray:
        """h_m of the arcs that are held on each surface, all alike there, shape (surfaces, M + 1); 1 where none is."""
        orders = Modes.up_to(self.sampling.max_order)
        found, means = np.ones((len(self.problem.surfaces), orders.count)), self.absorbers.means(self.problem, orders)
        for side in (0, 1):
            found[self.absorbers.surfaces[side]] = means[side]
        return found

    @property
    def squares(self) -> FloatArray:
        """The integral of cos^2 k_j z over a period: L for k_0, else L/2, shape (waves,)."""
        return np.asarray(self.sampling.period * np.where(self.sampling.wavenumbers == 0.0, 1.0, 0.5))

    def along(self, z: FloatArray) -> FloatArray:
        """Return cos k_j (z - z_0), and sin, at some z (in a): shape (z, waves, axial parities)."""
        phase = np.multiply.outer(z - self.origin, self.sampling.wavenumbers)
        return np.stack([np.cos(phase), np.sin(phase)][: self.axial_parities], axis=-1)


def line_layout(problem: Problem, sampling: AxialSampling) -> LineLayout:
    """Return the line absorbers of a problem.

    Raises
    ------
    InputError
        If there are point absorbers too, or sources that run along the axis.
    """
    system = problem.system
    absorbers = absorber_set(problem, system.absorber_list, source_parities(problem))
    pairs = zip(problem.emitters, problem.sources, strict=True)
    planes = {axial_position(one) / problem.scales.length for one, wave in pairs if isinstance(wave, SphericalFrontGeometry)}
    origin = planes.pop() if len(planes) == 1 else 0.0
    alike = _alike_on_surfaces(absorbers) and not problem.cut  # segments tell the angles of a lattice from each other
    lattice = lattice_of(absorbers.every_angle, sampling.max_order) if alike else 0
    return LineLayout(problem, sampling, absorbers, lattice, origin, 2 if planes else 1)


def _alike_on_surfaces(absorbers: AbsorberSet) -> bool:
    """Return whether all that hold a surface hold it over arcs of one length, so that its orders can be added up."""
    if absorbers.footprint is None:
        return True
    held = set(zip(absorbers.surfaces.ravel().tolist(), absorbers.footprint.ravel().tolist(), strict=True))
    return len(held) == np.unique(absorbers.surfaces).size


def require_lines_alone(problem: Problem, settings: Settings) -> None:
    """Refuse what cannot be beside line absorbers in three dimensions."""
    system = problem.system
    if not system.absorber_list:
        return
    if system.point_absorbers:
        raise InputError("absorbers", "line absorbers and point absorbers are not solved together", _row(problem, settings))
    for number, geometry in enumerate(problem.sources):
        if isinstance(geometry, PlaneGeometry) and geometry.inclination:
            where = f"source[{number}]" if isinstance(system.source, tuple) else "source"
            found = f"{geometry.inclination:g} degrees: a wave that runs along line absorbers is not solved"
            raise InputError(f"{where}.inclination", found, "use inclination = 0, a spherical source, or no absorbers")


def _row(problem: Problem, settings: Settings) -> str:
    """Return how point absorbers stand for a line: no further apart than half the shortest wave, a quarter where springs are cubic."""
    waves, cubic = settings.axial_modes or settings.modes, any(one.cubic_stiffness for one in problem.system.absorber_list)
    share = math.pi / (2.0 if cubic else 1.0)
    apart = (
        "closer than half the shortest axial wave"
        if isinstance(waves, str)
        else f"at most {share * problem.scales.length / waves:.2g} m apart"
    )
    each = "each with what the line has on that length"
    return f"use those with a z alone: a row of them, {apart}, {each}, is a line (z=[...] of absorber_ring); or those without alone"
