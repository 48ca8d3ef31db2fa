"""The waves along the axis of which a three-dimensional answer is made: wavenumbers, and their shares at the stations.

At one axial wavenumber k walls and fluids answer with amplitudes W, V, U that do not depend on z. Along the axis they go with an even
function e and an odd one o,

    w = e W,    v = e V,    u = o U,        de/dz = -k o,    do/dz = k e.

For the share of a spherical wave from z0 with the axial period L (theory manual, section "Axial wavenumber")

    e = c cos k(z - z0),    o = c sin k(z - z0),    c = 2/L for k = 0, else 4/L,

and half of c for forces on a wall, which are taken apart into what is even and what is odd about some z; for a plane wave
inclined by alpha, of complex wavenumber k = -i s sin alpha,

    e = e^{-s z sin alpha},    o = i e.

Line sources and plane waves across the axis are uniform along it: k = 0, e = 1, o = 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.acoustics.sources import PlaneGeometry, SphericalFrontGeometry
from coaxshell.model.sources import Source
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.lack import lacks
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.tied_wave import motion_parities
from coaxshell.solver.excitation import SourceGroup, source_groups, superposed
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts

Named = Mapping[str, ComplexArray]
"""Amplitudes by what walls are read for."""


@dataclass(frozen=True, eq=False)
class Family:
    """Sources whose waves go along the axis alike.

    Attributes
    ----------
    groups : list of SourceGroup
    even, odd : ndarray, shape (stations, waves) or, for the one wave of inclined sources, (stations, 1, nodes)
        e and o of every wavenumber at the stations.
    mean : ndarray, shape (waves,)
        Mean square of e along the axis.
    parities : int
        Of the motion around the circle.
    forces : WallForces or None
        Of absorbers, instead of sources.
    odd_forces : bool
        Whether of these forces what is odd along z.
    origin : float
        z about which e is even, in a.
    of_voltages : int or None
        Of the voltages of belts, instead of sources: 0 those along cos kz, 1 along sin kz.
    """

    groups: list[SourceGroup]
    even: npt.NDArray[np.number]
    odd: npt.NDArray[np.number]
    mean: FloatArray
    parities: int
    forces: WallForces | None = None
    odd_forces: bool = False
    origin: float = 0.0
    of_voltages: int | None = None

    def acts_in(self, wave: int) -> bool:
        """Return whether it is part of a wave at all: uniform sources are of k = 0 alone."""
        return bool(self.mean[wave] > 0.0)


class Driver(Protocol):
    """What the voltages of belts do to the waves of a set, at a block of nodes (:mod:`coaxshell.solver.axial.belts`)."""

    @property
    def order(self) -> list[int]:
        """All waves by number, those of a class side by side."""
        ...

    def amplitudes(self, wave: int) -> list[ComplexArray]:
        """Return what walls are read for in a wave, one array a family."""
        ...

    def together(self, amplitudes: list[ComplexArray], some: list[int]) -> list[tuple[FloatArray, ComplexArray]]:
        """Return mean squares along the axis and what all families make of some waves together, of each parity of the axis."""
        ...

    def squares_beyond(self, modes: Modes) -> FloatArray:
        """Return the squares of W and of the strains that voltages move in a wave left out, (shells, 2, orders)."""
        ...

    def take_under(self, fields: dict[str, ComplexArray], shape: tuple[int, ...], number: int, some: list[int], of: Named) -> None:
        """Add to the fields at stations what belts over them read of some waves of a family, and take it out of their amplitudes."""
        ...

    def add_given(self, fields: dict[str, ComplexArray], shape: tuple[int, ...]) -> None:
        """Add to the fields at stations what belts over them give."""
        ...


@dataclass(frozen=True, eq=False)
class WaveSet:
    """Axial wavenumbers that some families share: one factored system of walls and fluids serves all of them.

    Attributes
    ----------
    modes : list of Modes
        One a wavenumber.
    families : list of Family
    fluids : SharedParts or None
        Where the added masses of the fluids at these waves are found, or left for the next run.
    belts : Driver or None
        What the voltages of belts do, where electrodes are cut along the axis.
    limited : bool
        Whether amplifiers stop at a limit: what they lack is a family too, and all are solved by the loops.
    """

    modes: list[Modes]
    families: list[Family]
    fluids: SharedParts | None = None
    belts: Driver | None = None
    limited: bool = False

    @property
    def order(self) -> list[int]:
        """The waves in the order in which they are best solved: those that belts tie to each other side by side."""
        return list(range(len(self.modes))) if self.belts is None else self.belts.order

    @property
    def wavenumber(self) -> npt.NDArray[np.number]:
        """k of every wave, shape (waves,), or (1, nodes) where it is complex."""
        return np.stack([np.asarray(modes.wavenumber) for modes in self.modes])


def outside_loads(family: Family, radial: RadialBasis, grid: LaplaceGrid, block: slice) -> list[ComplexArray]:
    """Return what the sources of a family load the outermost surface with in a wave, (orders, nodes) of each parity; none without any."""
    units = [(group.geometry.prepare(grid, radial.modes)(radial, block), group) for group in family.groups]
    return superposed(family.parities, radial.modes, units) if units else []


def axial_position(source: Source) -> float:
    """Return z of a source, m; 0 of one that has none."""
    return float(getattr(source, "z", 0.0))


def wave_sets(
    problem: Problem, sampling: AxialSampling, stations: FloatArray, s: ComplexArray, forces: WallForces | None = None
) -> list[WaveSet]:
    """Return all waves of the sources of a problem at some nodes, and those of the forces of absorbers.

    Parameters
    ----------
    problem : Problem
        Of three dimensions.
    sampling : AxialSampling
    stations : ndarray, shape (stations,)
        z of the stations, in a.
    s : ndarray, shape (nodes,)
    forces : WallForces, optional
        At the same nodes.
    """
    a, top, parities = problem.scales.length, sampling.max_order, motion_parities(problem)
    spherical: dict[float, list[SourceGroup]] = {}
    uniform: list[SourceGroup] = []
    sets: list[WaveSet] = []
    for group in source_groups(problem, s):
        geometry = group.geometry
        if isinstance(geometry, SphericalFrontGeometry):
            for member in group.members:
                spherical.setdefault(axial_position(member[0]) / a, []).append(SourceGroup(geometry, [member]))
        elif isinstance(geometry, PlaneGeometry) and geometry.inclination:
            shape = np.exp(-np.multiply.outer(stations, s) * geometry.trace_slowness)[:, None]
            modes = Modes(np.arange(top + 1.0), -1j * s * geometry.trace_slowness)
            sets.append(WaveSet([modes], [Family([group], shape, 1j * shape, np.ones(1), parities)]))
        else:
            uniform.append(group)
    if uniform:
        ones = np.ones((stations.size, 1))
        sets.append(WaveSet([Modes.up_to(top)], [Family(uniform, ones, np.zeros_like(ones), np.ones(1), parities)]))
    families = [Family(groups, *sampling.shares(stations - z0), sampling.mean, parities, origin=z0) for z0, groups in spherical.items()]
    if forces is not None:
        families += _force_families(sampling, stations, forces)
    if families:
        sets.append(WaveSet(sampling.modes, families, sampling.fluids))
    return [replace(one, limited=True) for one in sets] if lacks(forces) else sets


def _force_families(sampling: AxialSampling, stations: FloatArray, forces: WallForces) -> list[Family]:
    """Return the waves of forces: what is even about their origin, and what is odd if there is any; 1/L for k = 0, else 2/L."""
    cosine, sine = (0.5 * share for share in sampling.shares(stations - forces.origin))
    mean, around = 0.25 * sampling.mean, forces.parities
    even = Family([], cosine, sine, mean, around, forces)
    return [even, Family([], sine, -cosine, mean, around, forces, odd_forces=True)] if forces.axial_parities == 2 else [even]
