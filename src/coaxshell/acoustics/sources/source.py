"""What a source must tell: its modal load on the outermost surface, r = b, and the wave itself where nothing stands in its way.

Each geometry is normalised so that the free-field pressure at the head (r = b, theta = 0; b = 1 unless true faces are wetted) is
the pulse itself, whose front arrives there at t = 0. In the Laplace domain the load of a pulse f, incident plus rigidly scattered, is
f(s) L_m(s); the rigid scattering cancels the incident normal velocity, p_d = s B_m K_m/(kappa K_m'), B_m the modal radial velocity of the
incident wave at r = b. At an axial wavenumber k the free field at the head is the pulse times cos kz.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import Nodes

NEAREST = 1e-3
"""Least distance from a source at which it is evaluated; nearer points get the value there: fields stay finite."""

SurfaceLoad = Callable[[RadialBasis, slice], ComplexArray]
"""From the radial functions at some nodes, and the slice of the grid's nodes that they are, to L_m, shape (orders, nodes)."""


@dataclass(frozen=True, eq=False)
class TimeFunction:
    """A pulse in dimensionless form: its history, its integral from 0, both zero before 0, and its transform."""

    history: Callable[[FloatArray], FloatArray]
    impulse: Callable[[FloatArray], FloatArray]
    transform: Callable[[ComplexArray], ComplexArray]


class FreeField(Protocol):
    """An incident wave at points: the source lies on the positive x axis, its front reaches the head at t = 0.

    Velocities are in units of c_e, pressures in rho_e c_e^2.
    """

    def pressure(self, time: float) -> FloatArray:
        """Return the pressure at all points at an instant."""
        ...

    def velocity(self, time: float) -> tuple[FloatArray, FloatArray]:
        """Return the particle velocity along x and y at all points at an instant."""
        ...


class SpatialField(Protocol):
    """An incident wave at points in space, z from the plane of its head point; the source lies at y = z = 0, x > 0.

    Velocities are in units of c_e, pressures in rho_e c_e^2.
    """

    def pressure(self, time: float) -> FloatArray:
        """Return the pressure at all points at an instant."""
        ...

    def velocity(self, time: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the particle velocity along x, y and z at all points at an instant."""
        ...


class SourceGeometry(Hashable, Protocol):
    """A kind of source at its place; equal ones share their modal load."""

    @property
    def distance(self) -> float | None:
        """Distance from the axis, in units of a; None for a plane wave."""
        ...

    @property
    def head(self) -> float:
        """Distance of the head point from the axis, in units of a: the radius b of the surface that the exterior fluid wets."""
        ...

    @property
    def along_rays(self) -> bool:
        """Whether the wave is its pulse carried along rays, so that its load in time is an integral over the wetted arc."""
        ...

    def prepare(self, grid: Nodes, modes: Modes) -> SurfaceLoad:
        """Return the load function for some modes on a Laplace grid."""
        ...

    def incident(self, grid: Nodes, basis: RadialBasis) -> tuple[ComplexArray, ComplexArray]:
        """Return the modal pressure and slope dp/dr at the head's radius of a unit pulse without any scattering, at all nodes of a grid."""
        ...

    def free_field(self, pulse: TimeFunction, x: FloatArray, y: FloatArray, latest: float) -> FreeField:
        """Return the wave at points; *latest* is the last instant that will be asked for."""
        ...


class SpatialGeometry(SourceGeometry, Protocol):
    """A kind of source of three-dimensional runs."""

    def spatial_field(self, pulse: TimeFunction, x: FloatArray, y: FloatArray, z: FloatArray, latest: float) -> SpatialField:
        """Return the wave at points in space, z from the plane of its head point; *latest* is the last instant that will be asked for."""
        ...


class SteadyGeometry(SourceGeometry, Protocol):
    """A kind of source whose wave is known at one frequency everywhere."""

    def free_spectrum(self, s: ComplexArray, x: FloatArray, y: FloatArray) -> ComplexArray:
        """Return the pressure of a unit pulse at points of the plane z = 0, shape (points, nodes)."""
        ...


class UniformField:
    """A wave that is alike in every cross-section, in space.

    Parameters
    ----------
    plane : FreeField
        In the cross-section.
    """

    def __init__(self, plane: FreeField) -> None:
        self._plane = plane

    def pressure(self, time: float) -> FloatArray:
        """Return the pressure at all points at an instant."""
        return self._plane.pressure(time)

    def velocity(self, time: float) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the particle velocity along x and y, and 0 along z."""
        along_x, along_y = self._plane.velocity(time)
        return along_x, along_y, np.zeros_like(along_x)


def incident_of_regular(geometry: SourceGeometry, grid: Nodes, basis: RadialBasis) -> tuple[ComplexArray, ComplexArray]:
    """Return the modal pressure P0 and slope dp0/dr at r = b of a wave that is regular inside r = b, each (orders, nodes).

    It has P0 = D dp0/dr with D = I_m/(kappa I_m'), and its load is L = P0 - E dp0/dr with E = K_m/(kappa K_m'), so dp0/dr = L/(D - E).
    """
    surface = basis(1.0, geometry.head)
    slope = geometry.prepare(grid, basis.modes)(basis, slice(0, grid.nodes.size)) / (surface.disc - surface.exterior)
    return surface.disc * slope, slope


def rays(distance: float, x: FloatArray, y: FloatArray) -> tuple[FloatArray, tuple[FloatArray, FloatArray]]:
    """Return the distance of points from a source at (distance, 0) and the unit vector from the source to them."""
    along, across = x - distance, y
    range_ = np.hypot(along, across)
    clear = np.maximum(range_, NEAREST)
    return clear, (along / clear, across / clear)
