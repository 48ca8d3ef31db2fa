"""The fields of three dimensions, wave by wave: what drives the fluids at each axial wavenumber, in a second pass over those of a run.

A run keeps the motion of the walls at its stations alone. A field solves the same waves again, at the nodes of the band that it needs and
with the axial period that its own place and instants ask for: often a smaller one than that of the run. Forces that are known at the
wavenumbers of the run alone make it take those, or are solved again where these are too few.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import nullcontext
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal, TypeVar

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.threads import WORKERS, map_on_threads
from coaxshell.response.fields.inversion import direct_matrix, window
from coaxshell.response.fields.modal_field import Transfer, region_slopes
from coaxshell.response.fields.request import SMEAR, FieldRequest, Region, Tell, filter_weight
from coaxshell.solver.axial.belts import driven_sets
from coaxshell.solver.axial.causality import reach
from coaxshell.solver.axial.faced import make_shapes
from coaxshell.solver.axial.faced_motion import faces_of
from coaxshell.solver.axial.families import Family, WaveSet
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.sampling import AxialSampling, axial_sampling, fastest_wave, spherical_fronts
from coaxshell.solver.axial.solution import SpatialSolution
from coaxshell.solver.axial.solve import forces_of
from coaxshell.solver.axial.sums import amplitudes_of
from coaxshell.solver.axial.tied_wave import motion_parities
from coaxshell.solver.cost import run_cost
from coaxshell.solver.excitation import superposed
from coaxshell.solver.scaling import Problem

_PAIRS = 16 * 1024
"""Radius-node pairs of a block: a quarter of a megabyte an order, of which a dozen share a cache."""
_FEWEST_NODES = 8

Found = TypeVar("Found")

SpatialQuantity = Literal["pressure", "radial", "angular", "axial"]
"""Pressure, and the particle velocity outward, towards increasing angle and along z; all dimensionless."""


def share(waves: WaveSet, family: Family, quantity: SpatialQuantity) -> npt.NDArray[np.number]:
    """Return how a quantity of a family goes along the axis: e, or k o = -de/dz of the axial velocity; shaped as the family's e."""
    return np.asarray(waves.wavenumber * family.odd) if quantity == "axial" else family.even


@dataclass(frozen=True, eq=False)
class Drive:
    """What drives the fluids at one axial wavenumber.

    Attributes
    ----------
    radial : RadialBasis
        Orders, wavenumber and nodes.
    normal : ndarray, shape (1 or 2, shells, families, parities, orders, nodes)
        W, or that of inner and of outer faces.
    incident : ndarray, shape (families, parities, orders, nodes)
        Slope of the incident wave at the outermost surface.
    """

    radial: RadialBasis
    normal: ComplexArray
    incident: ComplexArray

    def added_up(self, shares: npt.NDArray[np.number]) -> Drive:
        """Return sums of the families in the place of these, each family times its share in a sum: (sums, families, 1 or nodes)."""
        weight = shares[:, :, None, None]
        normal = np.stack([np.sum(self.normal * each, axis=2) for each in weight], axis=2)
        return Drive(self.radial, normal, np.stack([np.sum(self.incident * each, axis=0) for each in weight]))

    def transfer(self, region: Region, part: str) -> Transfer | None:
        """Return the field of a region, its families and parities in one dimension; None where the part vanishes."""
        faces, incident = self.normal.reshape(*self.normal.shape[:2], -1, *self.normal.shape[4:]), self.incident
        slopes = region_slopes(region, part, faces[0], lambda: incident.reshape(-1, *incident.shape[2:]), self.radial, faces[-1])
        return None if slopes is None else Transfer(region, slopes, self.radial.s, self.radial.modes)


@dataclass(frozen=True, eq=False)
class SpatialWaves:
    """The waves of a run as a field at some axial positions and instants needs them.

    A pressure p e(z) makes the particle velocity -grad(p e)/(rho s): slope and derivative around by e, p itself by k o.

    Attributes
    ----------
    problem : Problem
    sampling : AxialSampling
    grid : LaplaceGrid
        The band of nodes.
    z : ndarray
        Axial positions, in a.
    part : str
    filter : str or None
    forces : WallForces or None
        Of absorbers, at the nodes of the run.
    """

    problem: Problem
    sampling: AxialSampling
    grid: LaplaceGrid
    z: FloatArray
    part: str
    filter: str | None
    forces: WallForces | None = None

    @property
    def parities(self) -> int:
        """How many parities the motion around the circle has."""
        return max(motion_parities(self.problem), 1 if self.forces is None else self.forces.parities)

    def sets(self, block: slice) -> list[WaveSet]:
        """Return all waves at a slice of the nodes."""
        forces = None if self.forces is None else self.forces.at(block)
        return driven_sets(self.problem, self.sampling, self.z, self.grid, block, forces)

    def drive(self, waves: WaveSet, j: int, block: slice) -> Drive:
        """Return what wave j of a set drives the fluids with, at a slice of the nodes."""
        modes = waves.modes[j]
        radial = RadialBasis(modes, self.grid.nodes[block])
        weight = self._weight(waves, j)[:, None]
        faces = self._faces(waves, j, block)
        moved = np.zeros((len(faces[0]), faces[0].shape[1], len(faces), self.parities, *faces[0].shape[3:]), np.complex128)
        incident = np.zeros(moved.shape[2:], np.complex128)
        for number, (family, w) in enumerate(zip(waves.families, faces, strict=True)):
            moved[:, :, number, : w.shape[2]] = w * weight
            if family.groups and family.acts_in(j):
                slope = self._incident(family, radial)
                incident[number, : slope.shape[0]] = slope * weight
        return Drive(radial, moved, incident)

    def _faces(self, waves: WaveSet, j: int, block: slice) -> list[ComplexArray]:
        """Return W of all walls for each family, or of their inner and outer faces, (1 or 2, shells, parities, orders, nodes)."""
        if self.problem.two_faced:
            return [found[:2] for found in faces_of(self.problem, waves, j, self.grid, block)]
        return [found[:1] for found in amplitudes_of(self.problem, waves, j, self.grid, block)]

    def _incident(self, family: Family, radial: RadialBasis) -> ComplexArray:
        units = ((group.geometry.incident(self.grid, radial)[1], group) for group in family.groups)
        return np.stack(superposed(family.parities, radial.modes, units))

    def _weight(self, waves: WaveSet, j: int) -> FloatArray:
        """Return the filter's weight of every order: by the distance of (m, k) from the ellipse on which orders and wavenumbers end."""
        modes, top = waves.modes[j], self.sampling.max_order
        along = 0.0 if np.iscomplexobj(modes.wavenumber) else float(np.asarray(modes.wavenumber)) / self.sampling.highest
        return filter_weight(self.filter, np.hypot(modes.orders, along * top) / (top + 1.0))

    @property
    def families(self) -> int:
        """How many ways the waves of one wavenumber have to go along the axis, at most."""
        return max(len(waves.families) for waves in self.sets(slice(0, 1)))

    def inverse(self, times: FloatArray) -> FloatArray:
        """Return the matrix of direct sums under the band's window, shape (2 nodes, T)."""
        return direct_matrix(self.grid, times) * np.repeat(window(self.grid), 2)[:, None]

    def block_size(self, radii: int) -> int:
        """Return how many nodes to take at a time for a field at so many radii."""
        return max(_FEWEST_NODES, min(-(-self.grid.nodes.size // WORKERS), _PAIRS // max(1, radii)))

    def pairs(self, radii: int) -> float:
        """Return how many values of an order, a wave, a node and a radius a field at so many radii adds up."""
        sets = self.sets(slice(0, 1))
        return float(sum(modes.count for waves in sets for modes in waves.modes)) * self.grid.nodes.size * radii


def cut_waves(
    spatial: SpatialSolution, grid: LaplaceGrid, z: FloatArray, latest: float, asked: FieldRequest
) -> tuple[SpatialWaves | None, npt.NDArray[np.int64]]:
    """Return the waves that a field needs, and at which of its axial positions there is a scattered wave by the latest instant.

    Parameters
    ----------
    spatial : SpatialSolution
    grid : LaplaceGrid
        The band of nodes.
    z : ndarray
        Axial positions, in a.
    latest : float
        Transits.
    asked : FieldRequest

    Returns
    -------
    tuple
        (waves, positions); no waves where no position is reached. Forces of the run, see :func:`with_own_forces`.
    """
    problem, settings = spatial.problem, spatial.settings
    until = latest + SMEAR * asked.resolution
    fronts, speed = spherical_fronts(problem), fastest_wave(problem, spatial.sampling.highest)
    felt = np.arange(z.size)
    if len(fronts) == len(problem.sources):
        far = np.array([abs(z - front.z) - reach(until - front.delay, front.start, speed) for front in fronts])
        felt = np.flatnonzero(far.min(axis=0) <= 0.0)
    if not felt.size:
        return None, felt
    ends = sorted({float(z[felt].min()) * problem.scales.length, float(z[felt].max()) * problem.scales.length})
    forces = forces_of(spatial)
    known = None if forces is None else forces.sampling
    if known is not None:
        until = min(until, settings.duration)  # after which no force is known
    sampling = axial_sampling(problem, replace(settings, stations=tuple(ends), duration=until, axial_period=None))
    if known is not None and known.period >= sampling.period * (1.0 - 1e-12):
        sampling = known
    make_shapes(problem, sampling.modes)
    return SpatialWaves(problem, sampling, grid, z[felt], asked.part, asked.filter, forces), felt


def with_own_forces(waves: SpatialWaves, spatial: SpatialSolution) -> SpatialWaves:
    """Return waves whose forces are known at their own wavenumbers: solved again where those of the run are too few.

    A force that is felt at z turns with k as cos kz does: in the nearest wave of the run it is another one.
    """
    return waves if waves.forces is None else replace(waves, forces=forces_of(spatial, waves.sampling))


def own_forces_cost(waves: SpatialWaves, spatial: SpatialSolution) -> Cost:
    """Return what :func:`with_own_forces` costs: where forces are solved again about what a run does with as many waves."""
    known = None if waves.forces is None else waves.forces.sampling
    if known is None or known.period == waves.sampling.period:
        return Cost(0.0)
    period = waves.sampling.period * spatial.problem.scales.length
    return run_cost(spatial.problem, replace(spatial.settings, axial_period=period))


def each_block(waves: SpatialWaves, radii: int, work: Callable[[slice], Found], tell: Tell) -> Iterator[Found]:
    """Yield what a function makes of blocks of nodes, worked on by all threads, and tell the share done."""
    count = waves.grid.nodes.size
    edges = np.linspace(0, count, max(1, -(-count // waves.block_size(radii))) + 1).astype(int)
    blocks = [slice(int(a), int(b)) for a, b in pairwise(edges)]
    with one_blas_thread() if waves.problem.two_faced else nullcontext():  # products of elastic walls' shapes
        for done, found in enumerate(map_on_threads(work, blocks), start=1):
            tell(done / len(blocks))
            yield found
