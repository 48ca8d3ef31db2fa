"""Absorbers in dimensionless form, their symmetry, and the projection between their forces and the modes.

Absorber n links two shells at theta_n, neighbours or not. On side j (0 the inner, 1 the outer shell) it exerts, positive inward,

    f = c dD/dt + k_l D + k_nl D^3,  D = q - w_j(theta_n);      m d2q/dt2 = -f_0 - f_1         (Eqs. 6, 7)

and a line force f at radius R is the modal pressure f cos(m theta_n)/(beta pi R), beta = 2 for m = 0, else 1 (sin of the sines).

One that holds a wall over an arc of length b, its footprint, spreads f evenly over it and moves with the mean of w there: both carry the
factor h_m = sin(x)/x, x = m b/2R. On a wall whose faces move differently it acts on the face that looks at the gap, at that radius.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.basis import Modes
from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber, linked_shells
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import ComplexArray, FloatArray, real_product
from coaxshell.solver.links.described import LinkElements, LinkScales, link_elements, shells_between
from coaxshell.solver.point_forces import patch
from coaxshell.solver.scaling import Problem, Scales

Array = npt.NDArray[Any]

_SAME_ANGLE = 1e-9
"""Degrees within which two angles count as one."""
_PAIR_BYTES = 64 * 1024 * 1024
"""Most bytes of what all pairs of points keep for their receptance."""


class Properties(NamedTuple):
    """Properties of absorbers, shape (N,): m/(rho_e a^2), c/(rho_e c_e a), k_l/(rho_e c_e^2), k_nl a^2/(rho_e c_e^2)."""

    mass: FloatArray
    damping: FloatArray
    linear: FloatArray
    cubic: FloatArray


def properties(absorbers: Sequence[Absorber], scales: Scales) -> Properties:
    """Return the dimensionless properties of absorbers given in SI per metre of length; InputError if one is beyond double precision."""
    length, pressure, velocity = scales.length, scales.pressure, scales.velocity
    given = [(one.mass, one.damping, one.linear_stiffness, one.cubic_stiffness) for one in absorbers]
    mass, damping, linear, cubic = np.array(given, dtype=np.float64).reshape(-1, 4).T.copy()
    with np.errstate(over="ignore"):  # told below
        mass = mass * velocity**2 / (pressure * length**2)
        damping = damping * velocity / (pressure * length)
        found = Properties(mass, damping, linear / pressure, cubic * length**2 / pressure)
    for name, column, values in zip(
        ("mass", "damping", "linear_stiffness", "cubic_stiffness"), zip(*given, strict=True), found, strict=False
    ):
        if not np.isfinite(values).all():
            raise InputError(f"absorbers.{name}", f"{max(column):.3g} is more than can be computed with", "give a smaller one")
    return found


@dataclass(frozen=True)
class AbsorberSet:
    """Absorbers of one system, dimensionless; mirror images are carried once where the motion is symmetric.

    Attributes
    ----------
    angle : ndarray, shape (N,)
        Degrees.
    mass, damping, linear, cubic : ndarray, shape (N,)
        As :class:`Properties`.
    shells : ndarray of int, shape (2, N)
        Between which they are counted, the inner ones first; -1 and 0 in a system of one shell.
    multiplicity : ndarray, shape (N,)
        2 for one that stands for itself and its mirror image, else 1.
    member : ndarray of int
        For every absorber of the description, the one here that stands for it.
    every_angle : ndarray
        Degrees, of all absorbers of the description.
    parities : int
        1 if only the cosines of the Fourier series are excited, else 2.
    surfaces : ndarray of int, shape (2, N)
        Numbers of the surfaces of the problem that they hold (:attr:`coaxshell.solver.scaling.Problem.surfaces`).
    footprint : ndarray, shape (2, N), or None
        Arcs of these that they hold, in units of a, 0 of a line; None where all are lines.
    elements : LinkElements or None
        What the links exert besides, and which there are; None where each absorber has two of c, k_l and k_nl alone.
    """

    angle: FloatArray
    mass: FloatArray
    damping: FloatArray
    linear: FloatArray
    cubic: FloatArray
    shells: npt.NDArray[np.int64]
    multiplicity: FloatArray
    member: npt.NDArray[np.int64]
    every_angle: FloatArray
    parities: int
    surfaces: npt.NDArray[np.int64]
    footprint: FloatArray | None = None
    elements: LinkElements | None = None

    @property
    def count(self) -> int:
        """Number N of the absorbers carried."""
        return int(self.angle.size)

    @cached_property
    def is_linear(self) -> bool:
        """Whether no absorber has cubic stiffness or a law that is not linear."""
        return not np.any(self.cubic) and (self.elements is None or self.elements.is_linear)

    def linear_part(self) -> AbsorberSet:
        """Return the absorbers without their cubic springs and laws that are not linear."""
        return replace(self, cubic=np.zeros_like(self.cubic), elements=None if self.elements is None else self.elements.linear())

    @cached_property
    def of_any_law(self) -> bool:
        """Whether a link has a law beyond cubic springs that is not linear, and so is marched by :mod:`coaxshell.solver.links`."""
        return self.elements is not None and not self.is_linear

    @property
    def held(self) -> FloatArray:
        """1 where a link holds a wall, 0 where there is none or a core, shape (2, N)."""
        return np.ones((2, self.count)) if self.elements is None else self.elements.held.reshape(2, -1).astype(np.float64)

    def shapes(self, modes: Modes) -> FloatArray:
        """Return cos(m theta_n) and, with two parities, sin(m theta_n): shape (parities, N, M + 1)."""
        if modes.key not in self._shapes:
            rows = [modes.projection(float(angle), parity)[:, 0] for parity in range(self.parities) for angle in self.angle]
            self._shapes[modes.key] = np.array(rows).reshape(self.parities, self.count, modes.count)
        return self._shapes[modes.key]

    @cached_property
    def held_alike(self) -> list[npt.NDArray[np.int64]]:
        """Numbers of the absorbers, those together that hold the same surfaces over the same arcs."""
        footprint = np.zeros((2, self.count)) if self.footprint is None else self.footprint
        _, kind = np.unique(np.concatenate([self.surfaces, footprint]), axis=1, return_inverse=True)
        return [np.flatnonzero(kind.ravel() == one) for one in range(int(kind.max(initial=-1)) + 1)]

    def means(self, problem: Problem, modes: Modes) -> FloatArray:
        """Return h_m, the mean of cos m(theta - theta_n) over the arcs that they hold, shape (2, N, M + 1); 1 of lines."""
        if self.footprint is None:
            return np.ones((2, self.count, modes.count))
        radius = np.array([one.radius for one in problem.surfaces])[self.surfaces]
        return patch(np.multiply.outer(self.footprint / (2.0 * radius), modes.orders))

    def of_every(self, force: FloatArray, displacement: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return forces (N, 2, T) and displacements (N, T) of every absorber of the description from those carried, (2N, T) and (N, T)."""
        sides = force.reshape(2, self.count, force.shape[-1]).swapaxes(0, 1)
        return sides[self.member], displacement[self.member]

    @cached_property
    def _shapes(self) -> dict[Hashable, FloatArray]:
        """Shapes made so far, by what tells their modes apart."""
        return {}


def absorber_set(problem: Problem, absorbers: tuple[Absorber, ...], excited: int) -> AbsorberSet:
    """Return the dimensionless absorbers; where the sources excite one parity and the layout is symmetric, one of each mirrored pair."""
    one_parity = excited == 1 and not _dead_segments(problem)
    places = [_places(a) for a in absorbers] if one_parity else []
    symmetric = one_parity and sorted(repr(place) for place, _ in places) == sorted(repr(mirror) for _, mirror in places)
    carried: list[Absorber] = []
    multiplicity: list[float] = []
    found: dict[tuple[object, ...], int] = {}
    member = []
    for number, absorber in enumerate(absorbers):
        key, mirror = places[number] if symmetric else ((len(carried),),) * 2
        if mirror != key and mirror in found:
            index = found.pop(mirror)  # each one here answers for one mirror image
            multiplicity[index] = 2.0
        else:
            index = len(carried)
            carried.append(absorber)
            multiplicity.append(1.0)
            found[key] = index
        member.append(index)
    held = [[_surface(problem, a, side) for a in carried] for side in (0, 1)]
    return AbsorberSet(
        angle=np.array([a.angle for a in carried], dtype=np.float64),
        **properties(carried, problem.scales)._asdict(),
        shells=np.array([shells_between(a, len(problem.shells)) for a in carried], dtype=np.int64).reshape(-1, 2).T.copy(),
        multiplicity=np.array(multiplicity),
        member=np.array(member, dtype=np.int64),
        every_angle=np.array([a.angle for a in absorbers], dtype=np.float64),
        parities=1 if symmetric else 2,
        surfaces=np.array(held, dtype=np.int64).reshape(2, len(carried)),
        footprint=_footprints(problem, carried),
        elements=link_elements(carried, [wall.moves for wall in problem.shells], _link_scales(problem.scales)),
    )


def _dead_segments(problem: Problem) -> bool:
    """Return whether segments of electrodes are dead, which excite both parities."""
    cut = (wall.electrode_segments for wall in problem.shells if wall.gains is not None)
    return any(segments is not None and segments.dead for segments in cut)


def _footprints(problem: Problem, absorbers: Sequence[Absorber]) -> FloatArray | None:
    """Return the arcs that absorbers hold, (2, N), in a: unless given the thickness of walls with two faces, no arc of others."""
    found = np.zeros((2, len(absorbers)))
    for n, one in enumerate(absorbers):
        for side in (0, 1):
            shell = problem.surfaces[_surface(problem, one, side)].shell
            wall, described = problem.shells[shell], problem.system.shells[shell]
            if one.footprint is not None:
                found[side, n] = one.footprint / problem.scales.length
            elif not wall.faces_move_alike and isinstance(described, Shell):
                found[side, n] = described.thickness / problem.scales.length
    return found if found.any() else None


def _surface(problem: Problem, one: Absorber, side: int) -> int:
    """Return the number of the surface that a link of an absorber holds; in a system of one shell that shell's, for both."""
    shell = shells_between(one, len(problem.shells))
    return problem.surface_facing(shell[side], 1 - side) if shell[0] >= 0 else 0


def _link_scales(scales: Scales) -> LinkScales:
    return LinkScales(scales.length, scales.pressure * scales.length, scales.time)


def _places(absorber: Absorber) -> tuple[tuple[object, ...], tuple[object, ...]]:
    """Return what makes an absorber, and its mirror image, equal to another one: rounded angle and all properties."""
    apart = absorber.model_dump(exclude={"angle", "outer_shell"}).values()
    same = (linked_shells(absorber), *(repr(value) if isinstance(value, dict) else value for value in apart))
    whole = round(360.0 / _SAME_ANGLE)
    own, mirror = (round(angle / _SAME_ANGLE) % whole for angle in (absorber.angle, -absorber.angle))
    return (own, *same), (mirror, *same)


def admittance(absorbers: AbsorberSet, s: ComplexArray) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return (own, other, mass) per absorber and node, shape (nodes, N): Y = [[own, other], [other, own]], q = mass (w_0 + w_1)."""
    z = absorbers.damping * s[:, None] + absorbers.linear
    dynamic = absorbers.mass * s[:, None] ** 2 + 2.0 * z
    share = z / dynamic
    return z - z * share, -z * share, share


class SideAdmittance(NamedTuple):
    """Y = [[inner, other], [other, outer]] of every absorber and node, and q = inner_share w_0 + outer_share w_1; (nodes, N) each."""

    inner: ComplexArray
    outer: ComplexArray
    other: ComplexArray
    inner_share: ComplexArray
    outer_share: ComplexArray

    def mass_displacement(self, inner: Array, outer: Array) -> ComplexArray:
        """Return q of the displacements of both walls, (nodes, N)."""
        if self.inner_share is self.outer_share:
            return np.asarray(self.inner_share * (inner + outer))
        return np.asarray(self.inner_share * inner + self.outer_share * outer)


def link_impedance(absorbers: AbsorberSet, s: ComplexArray) -> ComplexArray:
    """Return the linear force per stretch of every link, shape (nodes, 2N)."""
    common = np.tile(absorbers.damping * s[:, None] + absorbers.linear, 2)
    return common if absorbers.elements is None else common * absorbers.elements.present + absorbers.elements.impedance(s)


def side_admittance(absorbers: AbsorberSet, s: ComplexArray) -> SideAdmittance:
    """Return the admittance of linear absorbers whose links may differ: with z_0 and z_1 of the two and d = m s^2 + z_0 + z_1,

    q = (z_0 w_0 + z_1 w_1)/d,  f_j = z_j (q - w_j).
    """
    if absorbers.elements is None:
        own, other, share = admittance(absorbers, s)
        return SideAdmittance(own, own, other, share, share)
    z = link_impedance(absorbers, s)
    inner, outer = z[:, : absorbers.count], z[:, absorbers.count :]
    dynamic = absorbers.mass * s[:, None] ** 2 + inner + outer
    shares = inner / dynamic, outer / dynamic
    return SideAdmittance(inner - inner * shares[0], outer - outer * shares[1], -inner * shares[1], *shares)


def point_law(absorbers: AbsorberSet, nodes: ComplexArray) -> ComplexArray:
    """Return Y of linear absorbers at Laplace nodes, f = -Y w, shape (nodes, 2N, 2N), inner sides first."""
    count, index = absorbers.count, np.arange(absorbers.count)
    sides = side_admittance(absorbers, nodes)
    law = np.zeros((nodes.size, 2 * count, 2 * count), np.complex128)
    for a in (0, 1):
        law[:, a * count + index, a * count + index] = sides[a]
        law[:, a * count + index, (1 - a) * count + index] = sides.other
    return law


class InterfacePoints:
    """The 2N places at which absorbers hold surfaces of walls, and the maps between them and the modes.

    Points are ordered by side, then absorber: 0..N-1 on the inner shells, N..2N-1 on the outer ones.
    """

    def __init__(self, problem: Problem, absorbers: AbsorberSet, modes: Modes) -> None:
        self.surface = absorbers.surfaces.ravel()
        self._groups = [(i, np.flatnonzero(self.surface == i)) for i in range(len(problem.surfaces))]
        self._rows = [_span(points) for _, points in self._groups]
        shapes = absorbers.shapes(modes)
        self._evaluate = [np.ascontiguousarray(shapes[:, points % max(absorbers.count, 1)]) for _, points in self._groups]
        shares = problem.point_force_shares(absorbers, modes)
        self._project = [
            np.ascontiguousarray(shares[:, points % max(absorbers.count, 1)] / problem.surfaces[i].radius) for i, points in self._groups
        ]
        if absorbers.footprint is not None:
            means = absorbers.means(problem, modes).reshape(self.surface.size, modes.count)
            for (_, points), evaluate, project in zip(self._groups, self._evaluate, self._project, strict=True):
                evaluate *= means[points]
                project *= means[points]
        if absorbers.elements is not None:  # what a core holds does not move, and nobody feels the force on it
            held = absorbers.elements.held
            for parts in (self._evaluate, self._project):
                parts[:] = [part * held[points][:, None] for part, (_, points) in zip(parts, self._groups, strict=True)]
        self.count, self.surfaces = self.surface.size, len(problem.surfaces)
        self.parities, self.modes = shapes.shape[0], modes.count
        self._pair_shares: dict[tuple[int, int], FloatArray] = {}

    def evaluate(self, modal: Array) -> Array:
        """Return the value at every point of modal amplitudes (surfaces, parities, M + 1[, T]): shape (points[, T])."""
        values = np.empty((self.count, *modal.shape[3:]), modal.dtype)
        for (i, _), rows, shape in zip(self._groups, self._rows, self._evaluate, strict=True):
            total = real_product(shape[0], modal[i, 0])
            total += 0.0  # no zero has a sign, as of any sum
            if min(self.parities, modal.shape[1]) == 2:
                total += real_product(shape[1], modal[i, 1])
            values[rows] = total
        return values

    def project(self, forces: Array, orders: npt.NDArray[np.int64] | None = None) -> Array:
        """Return the modal pressures (surfaces, parities, M + 1[, T]) of line forces (points[, T]); of some orders if given."""
        modes = self.modes if orders is None else orders.size
        modal = np.zeros((len(self._groups), self.parities, modes, *forces.shape[1:]), forces.dtype)
        for (i, points), shape in zip(self._groups, self._project, strict=True):
            if points.size:
                for h in range(self.parities):
                    chosen = shape[h] if orders is None else shape[h][:, orders]
                    modal[i, h] = real_product(chosen.T, forces[points])
        return modal

    def evaluate_transposed(self, values: Array) -> Array:
        """Return the transpose of :meth:`evaluate`: amplitudes (shells, parities, M + 1[, T]) of values at the points (points[, T])."""
        return self._spread(values, self._evaluate)

    def project_transposed(self, modal: Array) -> Array:
        """Return the transpose of :meth:`project`: values at the points (points[, T]) of amplitudes (shells, parities, M + 1[, T])."""
        values = np.empty((self.count, *modal.shape[3:]), modal.dtype)
        for (i, _), rows, shape in zip(self._groups, self._rows, self._project, strict=True):
            values[rows] = sum(one @ modal[i, h] for h, one in enumerate(shape))
        return values

    def _spread(self, values: Array, shapes: list[FloatArray]) -> Array:
        modal = np.zeros((self.surfaces, self.parities, self.modes, *values.shape[1:]), values.dtype)
        for (i, _), rows, shape in zip(self._groups, self._rows, shapes, strict=True):
            for h, one in enumerate(shape):
                modal[i, h] = one.T @ values[rows]
        return modal

    def on_surface(self, i: int) -> npt.NDArray[np.int64]:
        """Return the numbers of the points on a surface, ascending."""
        return self._groups[i][1]

    def maps_of(self, i: int) -> tuple[FloatArray, FloatArray]:
        """Return what evaluates modes at the points on a surface, and what projects forces there, orders of both parities in one row each.

        Both have the shape (points there, parities * (M + 1)).
        """
        return np.concatenate(list(self._evaluate[i]), axis=1), np.concatenate(list(self._project[i]), axis=1)

    def shares_of_pairs(self, i: int, j: int) -> FloatArray:
        """Return the share of each order in the kernel of each point of a surface to each of another, (points * points, M + 1)."""
        return np.asarray(np.einsum("ham,hbm->abm", self._evaluate[i], self._project[j]).reshape(-1, self.modes))

    def between(self, kernels: Array) -> Array:
        """Return the kernels from forces at the points to motion at the points, shape (points, points, T).

        ``kernels`` are those of the modes, shape (surfaces, surfaces, M + 1, T), real or complex.
        """
        found = np.zeros((self.count, self.count, kernels.shape[-1]), kernels.dtype)
        for i, rows in self._groups:
            for j, columns in self._groups:
                if rows.size and columns.size:
                    shares = sum(e[:, None] * p for e, p in zip(self._evaluate[i], self._project[j], strict=True))
                    parts = np.ascontiguousarray(kernels[i, j]).view(np.float64)  # a real product for complex ones too
                    found[np.ix_(rows, columns)] = (shares @ parts).view(kernels.dtype)
        return found

    def immediate(self, present: FloatArray) -> FloatArray:
        """Return the velocities at the points per force there within the same step, shape (..., points, points).

        ``present`` holds the kernels' weights at lag 0, shape (surfaces, surfaces, ..., M + 1): of one problem or of many.
        """
        matrix = np.zeros((*present.shape[2:-1], self.count, self.count))
        for i, rows in self._groups:
            for j, columns in self._groups:
                shapes = zip(self._evaluate[i], self._project[j], strict=True)
                matrix[..., rows[:, None], columns] = sum((e * present[i, j][..., None, :]) @ p.T for e, p in shapes)
        return matrix

    def receptance(self, compliance: ComplexArray) -> ComplexArray:
        """Return the displacements at the points per unit force at the points, shape (nodes, points, points).

        ``compliance`` is C_ij, shape (surfaces, surfaces, M + 1, nodes).
        """
        nodes = compliance.shape[-1]
        matrix = np.zeros((nodes, self.count, self.count), np.complex128)
        for (i, rows), span in zip(self._groups, self._rows, strict=True):
            for (j, columns), beside in zip(self._groups, self._rows, strict=True):
                if rows.size and columns.size:
                    whole = isinstance(span, slice) and isinstance(beside, slice)
                    place = (slice(None), span, beside) if whole else (slice(None), rows[:, None], columns)
                    matrix[place] = self._of_pairs(i, j, compliance[i, j]) if self._few else self._of_points(i, j, compliance[i, j])
        return matrix

    @property
    def _few(self) -> bool:
        """Whether the shares of all pairs of points in all orders are small enough to be kept."""
        return 8 * self.count**2 * self.modes <= _PAIR_BYTES

    def _of_pairs(self, i: int, j: int, compliance: ComplexArray) -> ComplexArray:
        """Return the receptance of one surface to forces on another, (nodes, points, points): one real product for all pairs and nodes."""
        if (i, j) not in self._pair_shares:
            self._pair_shares[i, j] = self.shares_of_pairs(i, j)
        product = real_product(self._pair_shares[i, j], compliance)
        return np.asarray(product.T.reshape(-1, self._evaluate[i].shape[1], self._project[j].shape[1]))

    def _of_points(self, i: int, j: int, compliance: ComplexArray) -> ComplexArray:
        """Return that receptance by one real product a node, which keeps nothing of the pairs."""
        evaluate, project = self.maps_of(i)[0], self.maps_of(j)[1]
        spectra = np.tile(compliance, (self.parities, 1)).T[:, :, None] * np.ascontiguousarray(project.T)
        return np.asarray((evaluate @ spectra.view(np.float64)).view(np.complex128))


def _span(numbers: npt.NDArray[np.int64]) -> slice | npt.NDArray[np.int64]:
    """Return ascending numbers as a slice where none is missing between them: arrays are read and written faster by it."""
    whole = numbers.size > 0 and int(numbers[-1] - numbers[0]) == numbers.size - 1
    return slice(int(numbers[0]), int(numbers[-1]) + 1) if whole else numbers


class PointsAlone:
    """Interface points whose kernels and motion are those of the points themselves: each is a surface of its own that has one mode.

    What needs the motion of the points alone is marched so, with :meth:`InterfacePoints.between` as kernels.
    """

    def __init__(self, absorbers: AbsorberSet) -> None:
        self.count = self.surfaces = 2 * absorbers.count
        self.parities = self.modes = 1
        self._held = None if absorbers.elements is None else absorbers.elements.held.astype(np.float64)

    def evaluate(self, modal: Array) -> Array:
        """Return motion (points, 1, 1[, T]) as (points[, T])."""
        return modal[:, 0, 0] if self._held is None else modal[:, 0, 0] * self._held.reshape(-1, *[1] * (modal.ndim - 3))

    def project(self, forces: Array) -> Array:
        """Return forces (points[, T]) as (points, 1, 1[, T])."""
        pressing = forces if self._held is None else forces * self._held.reshape(-1, *[1] * (forces.ndim - 1))
        return pressing[:, None, None]

    def immediate(self, present: FloatArray) -> FloatArray:
        """Return the kernels' weights (points, points, 1) as (points, points)."""
        weights = present[..., 0]
        return weights if self._held is None else np.asarray(self._held[:, None] * weights * self._held)
