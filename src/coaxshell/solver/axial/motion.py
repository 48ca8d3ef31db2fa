"""The motion of all walls in one axial wavenumber, at all Laplace nodes: what integrals along the whole axis are made of.

With families of sources in different planes (e and o of :mod:`coaxshell.solver.axial.families` at z = 0)

    w = A cos kz - B sin kz,        A = sum_f e_f W_f,      B = sum_f o_f W_f,

and likewise v and the pressures; u = A_u sin kz + B_u cos kz. A and B do not meet in an integral of a product over an axial period L,

    integral of w w' dz = L (A A' + B B')/2,        L A A' for k = 0:

they are two more parities, of the axis, which share all operators. Forces of point absorbers make waves too, which add to A and B.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.basis import RadialBasis
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.threads import map_on_threads
from coaxshell.solver.axial.belts import charged, driven_sets
from coaxshell.solver.axial.faced import make_shapes
from coaxshell.solver.axial.faced_motion import motions_and_faces
from coaxshell.solver.axial.families import Family, WaveSet
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.limited_wave import lacking
from coaxshell.solver.axial.point_forces import WallPoints
from coaxshell.solver.axial.sampling import AxialSampling, spherical_fronts
from coaxshell.solver.axial.sums import amplitudes_of, given_voltages
from coaxshell.solver.axial.tied_wave import motion_parities
from coaxshell.solver.excitation import incident_of
from coaxshell.solver.faced_forces import surface_motion
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solid_spectra import FacedMotion
from coaxshell.solver.spectral import node_blocks

_NOTHING = 1e-13
"""Of a motion, below which what is odd along the axis is rounding."""


@dataclass(frozen=True, eq=False)
class WaveMotion:
    """Motion in one axial wavenumber; parities of the circle for each of the axis, first those of A.

    Attributes
    ----------
    modes : Modes
    length : float
        Integral along the axis of a product of two amplitudes 1, in a; 1 where all is uniform along it, for its energy per length.
    normal, tangential, axial : ndarray, shape (shells, parities, orders, nodes)
        Transforms of W, V and U.
    solid : FacedMotion or None
        What the faces do, where they move differently.
    voltage : ndarray or None
        Transforms of the actuators' voltages, (shells, parities, orders, nodes), where feedback ties walls or orders to each other, or
        amplifiers stop at a limit.
    charged : ndarray, shape (orders,), or None
        By how much more they charge layers, where electrodes are cut along the axis (:func:`coaxshell.solver.axial.belts.charged`).
    """

    modes: Modes
    length: float
    normal: ComplexArray
    tangential: ComplexArray
    axial: ComplexArray
    _families: list[Family]
    _shares: FloatArray
    _around: int
    _problem: Problem
    _grid: LaplaceGrid
    solid: FacedMotion | None = None
    voltage: ComplexArray | None = None
    charged: FloatArray | None = None
    _number: int = 0

    @property
    def around(self) -> int:
        """How many parities of the circle there are for each of the axis."""
        return self._around

    def incident(self, basis: RadialBasis) -> tuple[ComplexArray, ComplexArray]:
        """Return modal pressure and slope dp/dr on the outermost surface as if nothing were there, each (parities, orders, nodes)."""
        parities = motion_parities(self._problem)
        sources = [i for i, family in enumerate(self._families) if family.groups and family.acts_in(self._number)]
        if not sources:  # uniform ones, of k = 0 alone
            nothing = np.zeros((self._around * self._shares.shape[1], *self.normal.shape[2:]), np.complex128)
            return nothing, nothing
        found = [np.stack(incident_of(self._families[i].groups, parities, self._grid, basis)) for i in sources]
        pressure, slope = _superposed(self._shares[sources], found, self._around)
        return pressure, slope

    @property
    def of_surfaces(self) -> ComplexArray:
        """Transforms of the displacements of the surfaces on which links act, (surfaces, parities, orders, nodes)."""
        return self.normal if self.solid is None else surface_motion(self._problem, self.normal, self.solid.faces)

    def at_points(self, points: WallPoints) -> ComplexArray:
        """Return what this wavenumber adds to the transforms of w at points of walls, the means over their patches, (P, nodes)."""
        k, found = float(self.modes.wavenumber), np.empty((points.count, self.normal.shape[-1]), np.complex128)
        along = points.along(k) * np.array([np.cos(k * points.z), -np.sin(k * points.z)])[: self._shares.shape[1]]
        shapes = [points.around(self._problem, self.modes, parity) for parity in range(self._around)]
        moved = self.of_surfaces
        for n, surface in enumerate(points.surface):
            columns = np.concatenate([share * shape[n] for share in along[:, n] for shape in shapes])
            found[n] = columns @ moved[surface].reshape(columns.size, -1)
        return found


def wave_motions(problem: Problem, sampling: AxialSampling, grid: LaplaceGrid, forces: WallForces | None = None) -> Iterator[WaveMotion]:
    """Yield the motion of every axial wavenumber in turn, of sources that are all spherical or all uniform along the axis.

    Parameters
    ----------
    problem : Problem
        Of three dimensions.
    sampling : AxialSampling
    grid : LaplaceGrid
    forces : WallForces, optional
        Of absorbers, at these wavenumbers and nodes.
    """
    origin, around = np.zeros(1), motion_parities(problem)
    around = around if forces is None else max(around, forces.parities)
    blocks = node_blocks(grid, sampling.max_order)
    per_block = [
        _one_set(driven_sets(problem, sampling, origin, grid, block, None if forces is None else forces.at(block))) for block in blocks
    ]
    waves = _one_set(driven_sets(problem, sampling, origin, grid, slice(None), forces))
    spherical, looped = bool(spherical_fronts(problem)), problem.tied or waves.limited
    for j, modes in enumerate(waves.modes):
        shares = np.array([[family.even[0, j], family.odd[0, j]] for family in waves.families])
        if not shares[:, 1].any():
            shares = shares[:, :1]

        def work(which: int, j: int = j, shares: FloatArray = shares) -> ComplexArray:
            solve = motions_and_faces if problem.two_faced else amplitudes_of
            found = solve(problem, per_block[which], j, grid, blocks[which])
            if looped and not problem.two_faced:
                modes, s = per_block[which].modes[j], grid.nodes[blocks[which]]
                for place, family in enumerate(per_block[which].families):
                    volts = given_voltages(problem, modes, s, found[place]) + lacking(problem, family, modes)
                    found[place] = np.concatenate([found[place][:3], volts[None]])
            rows = (7 if problem.two_faced else 3) + int(looped)
            return _superposed(shares, [amplitude[:rows] for amplitude in found], around)

        make_shapes(problem, [modes])
        with one_blas_thread():
            motion = np.concatenate(list(map_on_threads(work, range(len(blocks)))), axis=-1)
        length = (sampling.period if spherical else 1.0) * (1.0 if modes.two_dimensional else 0.5) if waves.modes is sampling.modes else 1.0
        if forces is not None and np.abs(motion[:, :, around:]).max(initial=0.0) <= _NOTHING * np.abs(motion).max():
            motion, shares = motion[:, :, :around], shares[:, :1]  # forces in pairs about z = 0 make nothing odd
        solid = FacedMotion(motion[3:5], motion[5:7]) if problem.two_faced else None
        voltage = motion[-1] if looped else None
        known = waves.families, shares, around, problem, grid, solid, voltage, charged(problem, sampling, j), j
        yield WaveMotion(modes, length, motion[0], motion[1], motion[2], *known)


def _one_set(sets: list[WaveSet]) -> WaveSet:
    """Return all families in one set: forces of absorbers under uniform sources have their one wavenumber, k = 0."""
    return sets[0] if len(sets) == 1 else WaveSet(sets[0].modes, [family for waves in sets for family in waves.families])


def _superposed(shares: FloatArray, amplitudes: list[ComplexArray], around: int) -> ComplexArray:
    """Return what families make with their shares (families, axial parities): (..., parities, orders, nodes), first those of A.

    Of each axial parity there are so many *around*; families that have fewer are zero there.
    """
    whole = [_widened(amplitude, around) for amplitude in amplitudes]
    parts = [sum(share * amplitude for share, amplitude in zip(column, whole, strict=True)) for column in shares.T]
    return np.concatenate(parts, axis=-3)


def _widened(amplitude: ComplexArray, around: int) -> ComplexArray:
    missing = around - amplitude.shape[-3]
    if missing == 0:
        return amplitude
    zeros = np.zeros((*amplitude.shape[:-3], missing, *amplitude.shape[-2:]), np.complex128)
    return np.concatenate([amplitude, zeros], axis=-3)
