"""The sources of a system as dimensionless loads on the outermost shell."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from threading import Lock

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.acoustics.sources import SourceGeometry, SurfaceLoad
from coaxshell.model.sources import Source
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.laplace_grid import LaplaceGrid, Nodes
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts


def source_spectrum(problem: Problem, source: Source, s: ComplexArray) -> ComplexArray:
    """Return the transform of the source's pulse, delayed by its delay, at the head in free field."""
    scales = problem.scales
    spectrum = pulse_transform(source.pulse, s, scales.time, scales.pressure)
    return spectrum * np.exp(-s * (source.delay / scales.time)) if source.delay else spectrum


def source_parities(problem: Problem) -> int:
    """Return how many parities are excited: 1, cosines alone, where sources and surface lie on theta = 0, 180 degrees; else 2."""
    aside = problem.planes is not None and not problem.planes.symmetric
    return 2 if aside or any(source.angle % 180.0 != 0.0 for source in problem.emitters) else 1


class UnitLoad:
    """The modal load of a unit pulse of one geometry; its projections are made when first needed.

    Parameters
    ----------
    wave : SourceGeometry
    grid : LaplaceGrid
    modes : Modes
    shared : SharedParts, optional
        Where loads are found, or left for the next one.
    """

    def __init__(self, wave: SourceGeometry, grid: LaplaceGrid, modes: Modes, shared: SharedParts | None) -> None:
        self._wave, self._grid, self._modes, self._shared = wave, grid, modes, shared
        self._lock = Lock()
        self._load: SurfaceLoad | None = None

    def __call__(self, basis: RadialBasis, nodes: slice) -> ComplexArray:
        """Return L_m at a slice of the grid's nodes, shape (orders, nodes)."""
        if self._shared is None:
            return self._made(basis, nodes)
        key = ("load", self._wave, self._grid, self._modes.key, (nodes.start, nodes.stop, nodes.step))
        load: ComplexArray = self._shared.get_or_make(key, lambda: self._made(basis, nodes))
        return load

    def _made(self, basis: RadialBasis, nodes: slice) -> ComplexArray:
        with self._lock:
            if self._load is None:
                self._load = self._wave.prepare(self._grid, self._modes)
        return self._load(basis, nodes)


@dataclass(frozen=True, eq=False)
class SourceGroup:
    """Sources of one geometry, which share their modal load, with the transforms of their pulses at some nodes.

    Attributes
    ----------
    geometry : SourceGeometry
    members : list of (Source, ndarray)
    """

    geometry: SourceGeometry
    members: list[tuple[Source, ComplexArray]]

    def at(self, nodes: slice) -> SourceGroup:
        """Return the group at a slice of its nodes."""
        return SourceGroup(self.geometry, [(source, spectrum[nodes]) for source, spectrum in self.members])


def source_groups(problem: Problem, s: ComplexArray) -> list[SourceGroup]:
    """Return the sources of a problem by geometry, with the transforms of their pulses."""
    groups: dict[SourceGeometry, list[tuple[Source, ComplexArray]]] = {}
    for source, geometry in zip(problem.emitters, problem.sources, strict=True):
        groups.setdefault(geometry, []).append((source, source_spectrum(problem, source, s)))
    return [SourceGroup(geometry, members) for geometry, members in groups.items()]


class SurfaceLoads:
    """The modal loads of all sources on the outermost shell, prepared for some modes on a Laplace grid.

    A source at angle theta_s loads cos(m theta) with cos(m theta_s) and sin(m theta) with sin(m theta_s) of its own series.
    Sources that share a geometry share its modal load. ``returned`` is that of what the planes of the sea send back, at all nodes.
    """

    def __init__(
        self, problem: Problem, grid: LaplaceGrid, modes: Modes, shared: SharedParts | None = None, returned: ComplexArray | None = None
    ) -> None:
        self.parities = source_parities(problem)
        if returned is not None:
            self.parities = max(self.parities, returned.shape[0])
        self._modes, self._returned = modes, returned
        self._groups = [(UnitLoad(group.geometry, grid, modes, shared), group) for group in source_groups(problem, grid.nodes)]

    def __call__(self, basis: RadialBasis, nodes: slice) -> list[ComplexArray]:
        """Return the load of the cosine parity, and of the sine parity if any source needs it, at a slice of the grid's nodes."""
        loads = superposed(self.parities, self._modes, ((unit(basis, nodes), group.at(nodes)) for unit, group in self._groups))
        if self._returned is not None:
            for load, back in zip(loads, self._returned, strict=False):
                load += back[..., nodes]
        return loads


def incident_on_surface(
    problem: Problem, grid: LaplaceGrid, basis: RadialBasis, returned: ComplexArray | None = None
) -> tuple[ComplexArray, ComplexArray]:
    """Return the modal pressure and slope dp/dr at the outermost surface of all incident waves, each (1 or 2, M + 1, nodes).

    Parameters
    ----------
    problem : Problem
    grid : LaplaceGrid
    basis : RadialBasis
        Of the modes at all nodes of the grid.
    returned : ndarray, shape (parities, orders, nodes), optional
        Load of what the planes of the sea send back, of as many orders and nodes or more.
    """
    pressure, slope = incident_of(source_groups(problem, grid.nodes), source_parities(problem), grid, basis)
    if returned is None:
        return pressure, slope
    surface = basis(1.0, problem.head)
    back = returned[:, : pressure.shape[1], : grid.nodes.size] / (surface.disc - surface.exterior)  # of a wave regular within r = b
    return _with_parities(pressure, surface.disc * back), _with_parities(slope, back)


def _with_parities(one: ComplexArray, other: ComplexArray) -> ComplexArray:
    """Return the sum of two modal arrays of which either may lack the sines."""
    large, small = (one, other) if one.shape[0] >= other.shape[0] else (other, one)
    total = large.copy()
    total[: small.shape[0]] += small
    return total


def incident_of(groups: list[SourceGroup], parities: int, grid: Nodes, basis: RadialBasis) -> tuple[ComplexArray, ComplexArray]:
    """Return modal pressure and slope dp/dr on the outermost surface by some sources, each (parities, orders, nodes), at all nodes."""
    waves = [group.geometry.incident(grid, basis) for group in groups]
    pressure, slope = (
        np.stack(superposed(parities, basis.modes, ((wave[which], group) for wave, group in zip(waves, groups, strict=True))))
        for which in (0, 1)
    )
    return pressure, slope


def superposed(parities: int, modes: Modes, units: Iterable[tuple[ComplexArray, SourceGroup]]) -> list[ComplexArray]:
    """Return the cosines, and the sines if there are two parities, of what all sources make, each (orders, nodes).

    *units* are what a unit pulse of each geometry makes, shape (orders, nodes), and its group at the same nodes.
    """
    totals: list[ComplexArray | float] = [0.0] * parities
    for unit, group in units:
        for parity, total in enumerate(totals):
            weights = sum(modes.projection(source.angle, parity) * spectrum for source, spectrum in group.members)
            totals[parity] = total + unit * weights
    return [np.asarray(total, dtype=np.complex128) for total in totals]
