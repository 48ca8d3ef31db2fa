"""The points at which absorbers hold the walls in three dimensions, and what forces there do to each other's points.

With the loads of :mod:`coaxshell.solver.axial.point_forces` the point a moves by

    w_a = sum_(m, k) C_ij(m, k) h_a h_b cos m(theta_a - theta_b) cos k(z_a - z_b)/(beta_m pi R_j) (eps_k/L) F_b,

eps_0 = 1 else 2: pairs of points at the same distances share their receptance, and there are far fewer of these than pairs.

Where sources and absorbers are symmetric about the plane theta = 0, or z = 0, mirror images move alike and are carried once.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from coaxshell.model.absorbers import PointAbsorber
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.progress import tell_share
from coaxshell.solver.axial.blocks import Found
from coaxshell.solver.axial.families import axial_position, wave_sets
from coaxshell.solver.axial.point_forces import WallPoints
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.axial.sums import pair_count
from coaxshell.solver.axial.surfaces import SurfaceWave
from coaxshell.solver.axial.tied_wave import motion_parities
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.links.described import LinkScales, link_elements, shells_between
from coaxshell.solver.point_forces import patch
from coaxshell.solver.scaling import Problem, Scales

Numbers = TypeVar("Numbers", FloatArray, ComplexArray)
_SAME = 1e-9
"""Degrees, and parts of a, within which places count as one."""


@dataclass(frozen=True, eq=False)
class PointLayout:
    """The absorbers of a run in three dimensions.

    Attributes
    ----------
    points : WallPoints
        Of all absorbers.
    absorbers : AbsorberSet
        Those carried; ``member`` says which of them stands for each of all.
    images : list of ndarray of int
        For each absorber carried, the absorbers that move as it does, itself first.
    parities : int
        Of the motion around the circle: 2 unless everything is symmetric about theta = 0.
    """

    points: WallPoints
    absorbers: AbsorberSet
    images: list[npt.NDArray[np.int64]]
    parities: int

    @cached_property
    def carried(self) -> WallPoints:
        """The points of the absorbers carried."""
        first = np.array([members[0] for members in self.images], dtype=np.int64)
        return self.points.subset(np.concatenate([first, first + self.member_count]))

    @property
    def member_count(self) -> int:
        """Number of all absorbers."""
        return self.points.count // 2

    def of_every(self, values: Numbers) -> Numbers:
        """Return values at all points, (P, ...), from those at the points carried."""
        member, count = self.absorbers.member, self.absorbers.count
        found: Numbers = values[np.concatenate([member, member + count])]
        return found


def point_layout(problem: Problem) -> PointLayout:
    """Return the point absorbers of a problem, dimensionless, mirror images carried once where the motion is symmetric."""
    system, a = problem.system, problem.scales.length
    listed = system.point_absorbers
    in_plane = all(axial_position(source) == 0.0 and getattr(source, "inclination", 0.0) == 0.0 for source in system.sources)
    around = motion_parities(problem) == 1 and _symmetric(listed, -1.0, 1.0)
    along = in_plane and _symmetric(listed, 1.0, -1.0)
    moving = [wall.moves for wall in problem.shells]
    images: list[list[int]] = []
    found: dict[tuple[object, ...], int] = {}
    member = []
    for number, one in enumerate(listed):
        alike = [_key(one, u, v) for u in ((1.0, -1.0) if around else (1.0,)) for v in ((1.0, -1.0) if along else (1.0,))]
        key = min(alike, key=repr) if around or along else (number,)
        place = found.setdefault(key, len(images))
        if place == len(images):
            images.append([])
        images[place].append(number)
        member.append(place)
    carried = [listed[members[0]] for members in images]
    absorbers = AbsorberSet(
        angle=np.array([one.angle for one in carried]),
        **_properties(carried, problem.scales),
        shells=np.array([shells_between(one, len(problem.shells)) for one in carried], dtype=np.int64).T.copy(),
        multiplicity=np.array([float(len(members)) for members in images]),
        member=np.array(member, dtype=np.int64),
        every_angle=np.array([one.angle for one in listed]),
        parities=2,
        surfaces=np.array([[_end(problem, one, side) for one in carried] for side in (0, 1)], dtype=np.int64).reshape(2, len(carried)),
        elements=link_elements(carried, moving, LinkScales(a, problem.scales.pressure * a**2, problem.scales.time)),
    )
    parts = [_wall_point(problem, one, _end(problem, one, side)) for side in (0, 1) for one in listed]
    surface, angle, z, width = (np.array(column) for column in zip(*parts, strict=True))
    points = WallPoints(surface.astype(np.int64), angle, z / a, width / a)
    return PointLayout(points, absorbers, [np.array(members) for members in images], 1 if around else 2)


def _end(problem: Problem, one: PointAbsorber, side: int) -> int:
    """Return the surface of a link, or that of the other link where there is none or a core: the point counts, but not what it does."""
    shell = shells_between(one, len(problem.shells))
    moves = shell[side] >= 0 and problem.shells[shell[side]].moves
    held = side if moves else 1 - side
    return problem.surface_facing(shell[held], 1 - held)


def _wall_point(problem: Problem, one: PointAbsorber, surface: int) -> tuple[float, float, float, float]:
    wall = problem.system.shells[problem.surfaces[surface].shell]
    assert isinstance(wall, Shell)  # absorbers link elastic shells
    return float(surface), one.angle, one.z, wall.thickness if one.footprint is None else one.footprint


def _properties(absorbers: Sequence[PointAbsorber], scales: Scales) -> dict[str, FloatArray]:
    """Return m/(rho_e a^3), c/(rho_e c_e a^2), k_l/(rho_e c_e^2 a) and k_nl a/(rho_e c_e^2), each (N,)."""
    a, pressure, velocity = scales.length, scales.pressure, scales.velocity
    given = [(one.mass, one.damping, one.linear_stiffness, one.cubic_stiffness) for one in absorbers]
    mass, damping, linear, cubic = np.array(given, dtype=np.float64).reshape(-1, 4).T.copy()
    return {
        "mass": mass * velocity**2 / (pressure * a**3),
        "damping": damping * velocity / (pressure * a**2),
        "linear": linear / (pressure * a),
        "cubic": cubic * a / pressure,
    }


def _key(one: PointAbsorber, around: float, along: float) -> tuple[object, ...]:
    """Return what makes two absorbers equal once their angle and axial position have been mirrored or not."""
    angle = round(around * one.angle / _SAME) % round(360.0 / _SAME)
    rest = tuple(
        repr(value) if isinstance(value, dict) else value for name, value in one.model_dump().items() if name not in ("angle", "z")
    )
    return (angle, round(along * one.z / _SAME), *rest)


def _symmetric(absorbers: Sequence[PointAbsorber], around: float, along: float) -> bool:
    """Return whether absorbers equal their mirror images."""
    return sorted(repr(_key(one, 1.0, 1.0)) for one in absorbers) == sorted(repr(_key(one, around, along)) for one in absorbers)


@dataclass(frozen=True, eq=False)
class PairClasses:
    """Which pairs of points, one carried and any one pressed, share their receptance.

    Attributes
    ----------
    number : ndarray of int, shape (carried points, points)
        The class of each pair.
    moved, pressed : ndarray of int, shape (classes,)
        Points of a pair of each class: the number among those carried, and among all.
    """

    number: npt.NDArray[np.int64]
    moved: npt.NDArray[np.int64]
    pressed: npt.NDArray[np.int64]


def pair_classes(layout: PointLayout, *, cut: bool = False) -> PairClasses:
    """Return the classes of all pairs: by surfaces, patches, and distances around and along; where electrodes are cut every pair is one."""
    carried, points = layout.carried, layout.points
    if cut:
        number = np.arange(carried.count * points.count).reshape(carried.count, points.count)
        moved, pressed = np.indices(number.shape)
        return PairClasses(number, moved.ravel(), pressed.ravel())
    turned = np.abs(carried.angle[:, None] - points.angle)
    turned = np.minimum(turned % 360.0, (360.0 - turned % 360.0) % 360.0)
    columns = [
        np.broadcast_to(carried.surface[:, None], turned.shape),
        np.broadcast_to(points.surface, turned.shape),
        np.round(turned / _SAME),
        np.round(np.abs(carried.z[:, None] - points.z) / _SAME),
        np.broadcast_to(np.round(carried.side[:, None] / _SAME), turned.shape),
        np.broadcast_to(np.round(points.side / _SAME), turned.shape),
    ]
    keys = np.stack([column.ravel() for column in columns], axis=1)
    _, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    moved, pressed = np.unravel_index(first, turned.shape)
    return PairClasses(number.reshape(turned.shape), moved.astype(np.int64), pressed.astype(np.int64))


@dataclass(frozen=True, eq=False)
class _ClassShares:
    """What the classes on surface i pressed on surface j need: numbers, shares (classes, orders), distances along, patches' h_k."""

    numbers: npt.NDArray[np.int64]
    around: FloatArray
    distance: FloatArray
    moved: WallPoints
    pressed: WallPoints

    def at(self, modes: Modes, sampling: AxialSampling, j: int) -> FloatArray:
        """Return the shares of the orders of a wavenumber, shape (classes, orders)."""
        k = float(modes.wavenumber)
        along = self.moved.along(k) * self.pressed.along(k) * np.cos(k * self.distance) * (0.5 * sampling.weights[j])
        return np.asarray(self.around[:, : modes.count] * along[:, None], dtype=np.float64)


def class_shares(problem: Problem, layout: PointLayout, classes: PairClasses, max_order: int) -> dict[tuple[int, int], _ClassShares]:
    """Return the shares of all classes by the surfaces (i moved, j pressed)."""
    moved, pressed = layout.carried.subset(classes.moved), layout.points.subset(classes.pressed)
    modes, found = Modes.up_to(max_order), {}
    for i, j in sorted({(int(i), int(j)) for i, j in zip(moved.surface, pressed.surface, strict=True)}):
        numbers = np.flatnonzero((moved.surface == i) & (pressed.surface == j))
        a, b = moved.subset(numbers), pressed.subset(numbers)
        apart = WallPoints(b.surface, a.angle - b.angle, b.z, b.side).pressed(problem, modes, 0)
        found[i, j] = _ClassShares(numbers, apart * a.means(problem, modes), a.z - b.z, a, b)
    return found


def point_sums(
    problem: Problem, grid: LaplaceGrid, sampling: AxialSampling, layout: PointLayout, classes: PairClasses, block: slice
) -> Found:
    """Return "motion", w of the points under the sources alone, (carried points, nodes), and "receptance", w of a point per unit force
    at another, (classes, nodes), at a slice of the grid's nodes.
    """
    s, carried = grid.nodes[block], layout.carried
    motion = np.zeros((carried.count, s.size), np.complex128)
    receptance = np.zeros((classes.moved.size, s.size), np.complex128)
    add = _adding(problem, layout, classes, sampling)
    shapes = [carried.around(problem, Modes.up_to(sampling.max_order), parity) for parity in range(motion_parities(problem))]
    sets = wave_sets(problem, sampling, carried.z, s)
    apart = not any(waves.modes is sampling.modes for waves in sets)
    done, whole = 0, pair_count(sets) + (sum(modes.count for modes in sampling.modes) if apart else 0)
    for waves in sets:
        for j, modes in enumerate(waves.modes):
            system = SurfaceWave(problem, s, modes, parities=2)
            along = patch(0.5 * np.asarray(modes.wavenumber) * carried.side[:, None])
            for family in waves.families:
                moved = system.under(family, grid, block)
                even = np.asarray(family.even[:, j]).reshape(carried.count, -1) * along
                for a, surface in enumerate(carried.surface):
                    for shape, each in zip(shapes, moved, strict=True):
                        motion[a] += even[a] * (shape[a, : modes.count] @ each[surface])
            if waves.modes is sampling.modes:
                add(receptance, system, j)
            done += modes.count
            tell_share(done / whole)
    for j, modes in enumerate(sampling.modes if apart else ()):
        add(receptance, SurfaceWave(problem, s, modes, parities=2), j)
        done += modes.count
        tell_share(done / whole)
    return {"motion": motion, "receptance": receptance}


def point_receptance(
    problem: Problem, s: ComplexArray, sampling: AxialSampling, layout: PointLayout, classes: PairClasses, block: slice
) -> Found:
    """Return "receptance" alone, as :func:`point_sums`, at a slice of any nodes."""
    receptance = np.zeros((classes.moved.size, s[block].size), np.complex128)
    add = _adding(problem, layout, classes, sampling)
    for j, modes in enumerate(sampling.modes):
        add(receptance, SurfaceWave(problem, s[block], modes, parities=2), j)
        tell_share((j + 1) / len(sampling.modes))
    return {"receptance": receptance}


def _adding(
    problem: Problem, layout: PointLayout, classes: PairClasses, sampling: AxialSampling
) -> Callable[[ComplexArray, SurfaceWave, int], None]:
    """Return what adds one wavenumber, by its number, to the receptance of all classes."""
    if problem.cut:
        return partial(_add_cut, problem, layout, sampling)
    return partial(_add_receptance, class_shares(problem, layout, classes, sampling.max_order), sampling)


def _add_cut(
    problem: Problem, layout: PointLayout, sampling: AxialSampling, receptance: ComplexArray, system: SurfaceWave, wave: int
) -> None:
    """Add what one wavenumber contributes to the receptance of every pair where electrodes are cut, one force after the other."""
    carried, points, modes = layout.carried, layout.points, system.modes
    k, each = float(modes.wavenumber), receptance.reshape(carried.count, points.count, -1)
    felt = np.stack([carried.around(problem, modes, parity) for parity in (0, 1)])
    pressures = np.stack([points.pressed(problem, modes, parity) for parity in (0, 1)], axis=1)
    along = (
        np.multiply.outer(carried.along(k), points.along(k)) * np.cos(k * (carried.z[:, None] - points.z)) * (0.5 * sampling.weights[wave])
    )
    for force in range(points.count):
        moved = system.under_forces(int(points.surface[force]), pressures[force])
        for i in np.unique(carried.surface):
            here = np.flatnonzero(carried.surface == i)
            found = sum(shape[here] @ parity[i] for shape, parity in zip(felt, moved, strict=True))
            each[here, force] += along[here, force, None] * found


def _add_receptance(
    shares: dict[tuple[int, int], _ClassShares], sampling: AxialSampling, receptance: ComplexArray, system: SurfaceWave, wave: int
) -> None:
    """Add what one wavenumber contributes to the receptance of all classes."""
    for pressed in sorted({j for _, j in shares}):
        compliance = system.under_pressure(pressed)
        for (i, j), share in shares.items():
            if j == pressed:
                columns = np.ascontiguousarray(compliance[i]).view(np.float64)
                receptance[share.numbers] += (share.at(system.modes, sampling, wave) @ columns).view(np.complex128)
