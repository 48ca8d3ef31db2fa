"""Walls of solid layers in waves that run along the axis with a front: one complex wavenumber k = -i s sin(alpha) for each Laplace node.

No shapes serve them, because k depends on s; but stiffness is a polynomial in m and k, and so is all that a ceramic's potentials, kept
as unknowns beside the displacements, add to it:

    [K(m, k) + M s^2   Q'(m, k)] [x  ]   [f]
    [Q(m, k)          -G(m, k) ] [Phi] = [0],

each entry a sum over 1, m, m^2, k, k^2 and m k of real matrices that are made once a mesh (:class:`InclinedMesh`). It is solved for a unit
force on either face, at each order and node: what lies within a layer, I, is eliminated by its ends, B, and what is left ties the joints,

    S = A_JJ - sum over layers of A_IB' X,      X = A_II^-1 A_IB,      x_I = -X x_B.

Displacements are divided by the root of the mass, potentials by that of G(0, 0). Of a layer with losses C = C_0 + g(s) C_1: what is of C_1
has matrices of its own, which g(s) multiplies at each node; potentials have none.

Fronts that lead everything, sin(alpha) less than c_e over the fastest speed of any layer, make x causal
(:mod:`coaxshell.solver.axial.inclination`).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.lobatto import interpolation
from coaxshell.numerics.modes import Modes
from coaxshell.structure.elastic_basis import PotentialOfLayer, layer_powers, order_meshes, stiffness_powers
from coaxshell.structure.elastic_depth import DISPLACEMENTS, STRESSES, Shown
from coaxshell.structure.elastic_mesh import LayerMesh, WallMesh, strains
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.solid import SolidLayer

_DISPLACEMENTS = 3
SAMPLES = ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (0.0, 1.0), (1.0, 1.0), (0.0, 2.0))
"""Orders and wavenumbers that tell a polynomial of second degree in both."""
_MOST_DEGREE = 64
"""Of a layer with losses."""
_BYTES = 2**25
"""Matrices of several nodes that are solved together."""


class InclinedPlace(NamedTuple):
    """A quantity at a radius of a layer, by the layer's number."""

    what: Shown
    radius: float
    layer: int


class InclinedMesh:
    """The equations of a wall on one mesh, by powers of m and k.

    Attributes
    ----------
    mesh : WallMesh
    powers : ndarray, shape (6, N, N)
        Of 1, m, m^2, k, k^2 and m k.
    inertia : ndarray, shape (N,)
        1 of displacements, 0 of potentials.
    root : ndarray, shape (displacements,)
        The roots of the mass, by which displacements are divided.
    """

    def __init__(self, mesh: WallMesh) -> None:
        self.mesh = mesh
        self.root = np.tile(np.sqrt(mesh.mass), _DISPLACEMENTS)
        count = self.root.size
        self._ceramics = {part: _Electric(part) for part in mesh.layers if part.layer.coupling is not None}
        total = count + sum(one.size for one in self._ceramics.values())
        self.powers = np.zeros((6, total, total))
        self._relaxing: dict[LayerMesh, FloatArray] = {}
        if all(part.layer.factor is None for part in mesh.layers):
            self.powers[:, :count, :count] = stiffness_powers(mesh)
        else:
            self._add_layers()
        self.inertia = np.where(np.arange(total) < count, 1.0, 0.0)
        self._place: dict[LayerMesh, slice] = {}
        start = count
        for part, one in self._ceramics.items():
            own = self._place[part] = slice(start, start + one.size)
            columns = self.columns(part)
            coupling = one.coupling / self.root[columns]
            self.powers[:, own, columns] += coupling
            self.powers[:, columns, own] += np.swapaxes(coupling, 1, 2)
            self.powers[:, own, own] -= one.permittivity
            start = own.stop

        self.joints, self.layers = self._parts()
        self._between = self.powers[np.ix_(range(6), self.joints, self.joints)]

    def _add_layers(self) -> None:
        """Add up the stiffness of all layers that no factor weighs, and put down what one does."""
        for part in self.mesh.layers:
            columns, (kept, relaxing) = self.columns(part), part.layer.kept_and_relaxing
            self.powers[np.ix_(range(6), columns, columns)] += layer_powers(self.mesh, part, kept)
            if part.layer.factor is not None:
                wide = self._relaxing[part] = np.zeros_like(self.powers)
                wide[np.ix_(range(6), columns, columns)] = layer_powers(self.mesh, part, relaxing)

    def _parts(self) -> tuple[list[int], list[_Within]]:
        """Return the places of the displacements of all joints, and what lies within each layer."""
        points = self.mesh.radius.size
        ends = [self.mesh.layers[0].nodes.start, *(part.nodes.stop - 1 for part in self.mesh.layers)]
        joints = [which * points + end for which in range(_DISPLACEMENTS) for end in ends]
        found = []
        for part in self.mesh.layers:
            columns, edges = self.columns(part), (part.nodes.start, part.nodes.stop - 1)
            held = [place for place in columns if place % points in edges]
            potentials = self._place.get(part, slice(0, 0))
            inner = [*(place for place in columns if place not in held), *range(potentials.start, potentials.stop)]
            own, across = (self.powers[np.ix_(range(6), inner, some)] for some in (inner, held))
            relaxing = None
            if part in self._relaxing and part.layer.factor is not None:
                every = self._relaxing[part]
                relaxing = _Relaxing(
                    part.layer.factor, *(every[np.ix_(range(6), *some)] for some in ((inner, inner), (inner, held), (held, held)))
                )
            found.append(_Within(inner, [joints.index(place) for place in held], own, across, self.inertia[inner], relaxing))
        return joints, found

    def columns(self, part: LayerMesh) -> list[int]:
        """Return the places of the displacements at the points of a layer."""
        points = range(part.nodes.start, part.nodes.stop)
        return [which * self.mesh.radius.size + point for which in range(_DISPLACEMENTS) for point in points]

    def rows(self, place: InclinedPlace) -> FloatArray:
        """Return a quantity per unit of each unknown, by 1, m and k, shape (2, 3, N): the second under the factor of the place's layer."""
        part = self.mesh.layers[place.layer]
        inside = 2.0 * (place.radius - part.layer.inner) / part.layer.thickness - 1.0
        at = interpolation(part.degree, min(max(inside, -1.0), 1.0))
        found, columns = np.zeros((2, 3, self.inertia.size)), self.columns(part)
        if place.what in DISPLACEMENTS:
            which, sign = DISPLACEMENTS[place.what]
            values = np.zeros((_DISPLACEMENTS, at.size))
            values[which] = sign * at
            found[0, 0, columns] = values.ravel() / self.root[columns]
            return found
        if place.what == "potential":
            found[0, 0, self._place[part]] = self._ceramics[part].values(at)
            return found
        component, slope = STRESSES[place.what], at @ part.derivative
        local = [strains(np.array([m]), k, np.array([place.radius]), slope[None], at[None])[0, :, 0] for m, k in ((0, 0), (1, 0), (0, 1))]
        each = np.stack([local[0], local[1] - local[0], local[2] - local[0]])
        moduli = np.stack(part.layer.kept_and_relaxing)[:, component]
        found[..., columns] = np.einsum("gj,ajcp->gacp", moduli, each).reshape(2, 3, -1) / self.root[columns]
        if part in self._ceramics:
            e, one = np.array(part.layer.coupling)[:, component], self._ceramics[part]
            field = np.stack([e[0] * one.values(slope), -e[1] / place.radius * one.values(at), -e[2] * one.values(at)])
            found[0, :, self._place[part]] = field
        return found

    def solve(self, order: float, wavenumber: ComplexArray, s: ComplexArray, rows: FloatArray, layers: Sequence[int]) -> ComplexArray:
        """Return quantities per unit force along r on the inner and on the outer face of one order, shape (quantities, 2, nodes).

        Parameters
        ----------
        order : float
        wavenumber, s : ndarray, shape (nodes,)
        rows : ndarray, shape (quantities, 2, 3, N)
            Of :meth:`rows`.
        layers : sequence of int
            The layer of each quantity.
        """
        found = np.empty((len(rows), 2, s.size), np.complex128)
        for start in range(0, s.size, step := self.nodes_together):
            some = slice(start, start + step)
            answer, _ = self.assembled(order, wavenumber[some], s[some]).moving().solve(self.forces_on_faces)
            found[..., some] = self.shown(order, wavenumber[some], s[some], answer, rows, layers)
        return found

    @property
    def nodes_together(self) -> int:
        """How many nodes are solved together."""
        return int(max(1, _BYTES // (16 * self.inertia.size**2)))

    @property
    def forces_on_faces(self) -> FloatArray:
        """A unit force along r on the inner and on the outer face, over the roots of the mass, shape (N, 2)."""
        forces, places = np.zeros((self.inertia.size, 2)), [0, self.mesh.radius.size - 1]
        forces[places, [0, 1]] = 1.0 / self.root[places]
        return forces

    def of_potential(self, part: LayerMesh, at: FloatArray, order: float, k: ComplexArray) -> ComplexArray:
        """Return a sum over the points of a ceramic of its potential under displacements alone, per unit of each, (nodes, 3 (p + 1))."""
        rows = self.powers[:, self._place[part]]
        electric, charge = (at_powers(one, order, k) for one in (rows[..., self._place[part]], rows[..., self.columns(part)]))
        values = np.broadcast_to(self._ceramics[part].values(at)[:, None], (*electric.shape[:2], 1))
        return np.asarray(-np.einsum("ni,nik->nk", np.linalg.solve(electric, values)[..., 0], charge))

    def shown(
        self, order: float, k: ComplexArray, s: ComplexArray, answer: ComplexArray, rows: FloatArray, layers: Sequence[int]
    ) -> ComplexArray:
        """Return quantities of answers (nodes, N, loads), shape (quantities, loads, nodes); *rows* and *layers* as of :meth:`solve`."""
        flat = rows[:, 0].reshape(-1, self.inertia.size)
        each = np.moveaxis((flat @ answer).reshape(k.size, len(rows), 3, answer.shape[-1]), 0, -1)
        found = each[:, 0] + order * each[:, 1] + k * each[:, 2]
        for i in (i for i in range(len(rows)) if rows[i, 1].any()):
            factor = self.mesh.layers[layers[i]].layer.factor
            assert factor is not None
            fixed, around, along = np.moveaxis(rows[i, 1] @ answer, 0, -1)
            found[i] += factor.at(s) * (fixed + order * around + k * along)
        return np.asarray(found)

    def assembled(self, order: float, k: ComplexArray, s: ComplexArray) -> Assembled:
        """Return the equations of an order without inertia at some nodes: :attr:`nodes_together` at most."""
        between, within = at_powers(self._between, order, k), []
        for one in self.layers:
            own, across = at_powers(one.own, order, k), at_powers(one.across, order, k)
            if one.relaxing is not None:
                g = one.relaxing.factor.at(s)[:, None, None]
                own += g * at_powers(one.relaxing.own, order, k)
                across += g * at_powers(one.relaxing.across, order, k)
                between[:, np.array(one.ends)[:, None], one.ends] += g * at_powers(one.relaxing.between, order, k)
            within.append((own, across))
        return Assembled(self, between, within, s)


class Assembled:
    """The equations of a wall at an order and some nodes, what lies within layers apart from the joints.

    Parameters
    ----------
    equations : InclinedMesh
    between : ndarray, shape (nodes, joints, joints)
    within : list of (ndarray, ndarray)
        A_II and A_IB of each layer.
    s : ndarray, shape (nodes,)
    """

    def __init__(
        self, equations: InclinedMesh, between: ComplexArray, within: list[tuple[ComplexArray, ComplexArray]], s: ComplexArray
    ) -> None:
        self._equations, self._between, self._within, self._s = equations, between, within, s

    def moving(self, *, again: bool = False) -> Assembled:
        """Return them with inertia: in place, unless those without it are needed *again*."""
        equations, square = self._equations, self._s**2
        between = self._between.copy() if again else self._between
        within = [(own.copy() if again else own, across) for own, across in self._within]
        _add_inertia(between, square, equations.inertia[equations.joints])
        for one, (own, _) in zip(equations.layers, within, strict=True):
            _add_inertia(own, square, one.inertia)
        return Assembled(equations, between, within, self._s)

    def solve(
        self, loads: FloatArray | ComplexArray, border: ComplexArray | None = None, corner: ComplexArray | None = None
    ) -> tuple[ComplexArray, ComplexArray]:
        """Return x and y of [A, b; b', c] [x; y] = [f; 0], shapes (nodes, N, loads) and (nodes, borders, loads).

        Parameters
        ----------
        loads : ndarray, shape (N, loads) or (nodes, N, loads)
            f.
        border, corner : ndarray, shape (nodes, N, borders) and (nodes, borders, borders), optional
            b and c.
        """
        equations, count = self._equations, self._s.size
        joints, ends = equations.joints, len(equations.joints)
        borders = 0 if border is None else border.shape[-1]
        given = np.broadcast_to(loads, (count, *loads.shape[-2:]))
        right = given if border is None else np.concatenate([border, given], axis=-1)
        matrix = np.zeros((count, ends + borders, ends + borders), np.complex128)
        matrix[:, :ends, :ends] = self._between
        held = np.zeros((count, ends + borders, given.shape[-1]), np.complex128)
        held[:, :ends] = given[:, joints]
        if border is not None and corner is not None:
            matrix[:, :ends, ends:] = border[:, joints]
            matrix[:, ends:, :ends] = np.swapaxes(border[:, joints], 1, 2)
            matrix[:, ends:, ends:] = corner
        solved = []
        for one, (own, across) in zip(equations.layers, self._within, strict=True):
            places = [*one.ends, *range(ends, ends + borders)]
            inner = right[:, one.inner]
            loaded = borders > 0 or bool(inner.any())
            x = np.linalg.solve(own, np.concatenate([across, inner], axis=-1) if loaded else across)
            tied = across if border is None else np.concatenate([across, inner[..., :borders]], axis=-1)
            less = np.swapaxes(tied, 1, 2) @ x
            matrix[:, np.array(places)[:, None], places] -= less[..., : len(places)]
            if loaded:
                held[:, places] -= less[..., len(places) :]
            solved.append((one.inner, places, x))
        joined: ComplexArray = np.linalg.solve(matrix, held).astype(np.complex128, copy=False)
        answer: ComplexArray = np.empty((count, equations.inertia.size, given.shape[-1]), np.complex128)
        answer[:, joints] = joined[:, :ends]
        for places_within, places, x in solved:
            answer[:, places_within] = -(x[..., : len(places)] @ joined[:, places])
            if x.shape[-1] > len(places):
                answer[:, places_within] += x[..., len(places) :]
        return answer, joined[:, ends:]


class _Relaxing(NamedTuple):
    """A_II, A_IB and A_BB of a layer that its factor weighs, by powers."""

    factor: Relaxation
    own: FloatArray
    across: FloatArray
    between: FloatArray


class _Within(NamedTuple):
    """What lies within a layer: its places among the unknowns, its ends among the joints, A_II and A_IB by powers, and what has inertia."""

    inner: list[int]
    ends: list[int]
    own: FloatArray
    across: FloatArray
    inertia: FloatArray
    relaxing: _Relaxing | None


def at_powers(powers: FloatArray, order: float, k: ComplexArray) -> ComplexArray:
    """Return a matrix at an order and wavenumbers, shape (nodes, rows, columns), from its powers."""
    fixed = powers[0] + order * powers[1] + order**2 * powers[2]
    linear, along = powers[3] + order * powers[5], k[:, None, None]
    return np.asarray(fixed + along * linear + (along * along) * powers[4])


def _add_inertia(matrix: ComplexArray, square: ComplexArray, inertia: FloatArray) -> None:
    places = np.arange(inertia.size)
    matrix[:, places, places] += square[:, None] * inertia


class _Electric:
    """The potential of a piezoelectric layer between grounded faces as unknowns: Q and G by powers of m and k, over the root of G(0, 0).

    Attributes
    ----------
    coupling : ndarray, shape (6, p - 1, 3 (p + 1))
    permittivity : ndarray, shape (6, p - 1, p - 1)
    size : int
        p - 1.
    """

    def __init__(self, part: LayerMesh) -> None:
        coupling, permittivity = {}, {}
        for m, k in SAMPLES:
            potential = PotentialOfLayer(part, np.array([m]), k, _DISPLACEMENTS)
            root = potential.root[0]
            coupling[m, k] = root @ potential.rows[0].reshape(len(root), -1)
            permittivity[m, k] = root @ root.T
        self._root = np.linalg.cholesky(permittivity[0.0, 0.0])
        self.size = len(self._root)
        self.coupling = np.linalg.solve(self._root, powers_of(coupling))
        self.permittivity = np.linalg.solve(self._root, np.swapaxes(np.linalg.solve(self._root, powers_of(permittivity)), 1, 2))

    def values(self, at: FloatArray) -> FloatArray:
        """Return a sum over the points of the layer of the potential there, per unit of each unknown, shape (p - 1,)."""
        return np.asarray(np.linalg.solve(self._root, at[1:-1]))


def powers_of(sampled: dict[tuple[float, float], FloatArray]) -> FloatArray:
    """Return the polynomial in m and k through its values at (m, k) of :data:`SAMPLES`: of 1, m, m^2, k, k^2 and m k."""
    f = sampled
    fixed = f[0.0, 0.0]
    around2, along2 = 0.5 * (f[2.0, 0.0] - 2.0 * f[1.0, 0.0] + fixed), 0.5 * (f[0.0, 2.0] - 2.0 * f[0.0, 1.0] + fixed)
    around, along = f[1.0, 0.0] - fixed - around2, f[0.0, 1.0] - fixed - along2
    both = f[1.0, 1.0] - fixed - around - around2 - along - along2
    return np.stack([fixed, around, around2, along, along2, both])


meshed_equations = lru_cache(maxsize=64)(InclinedMesh)


def inclined_meshes(layers: Sequence[SolidLayer], modes: Modes, s: ComplexArray, frequency: float) -> Iterator[tuple[slice, InclinedMesh]]:
    """Yield the places of the orders that share a mesh, and its equations: parameters as of :func:`inclined_port`."""
    k = np.broadcast_to(np.asarray(modes.wavenumber, np.complex128), s.shape)
    shortest = frequency * float(np.max(np.abs(k) / np.abs(s)))
    for members, mesh in order_meshes(tuple(layers), modes.orders, shortest, frequency, most=_MOST_DEGREE):
        yield members, meshed_equations(mesh)


def wall_faces(layers: Sequence[SolidLayer]) -> list[InclinedPlace]:
    """Return the inward displacements of both faces of a wall."""
    return [InclinedPlace("normal", layers[0].inner, 0), InclinedPlace("normal", layers[-1].outer, len(layers) - 1)]


def inclined_port(
    layers: Sequence[SolidLayer], modes: Modes, s: ComplexArray, frequency: float, places: Sequence[InclinedPlace]
) -> tuple[tuple[ComplexArray, ComplexArray, ComplexArray], ComplexArray]:
    """Return the receptances H_ii, H_io and H_oo of the faces of a wall, and what places show per -1 on either, (places, 2, orders, nodes).

    An inward load q at r is a force -r q.

    Parameters
    ----------
    layers : sequence of SolidLayer
        Dimensionless.
    modes : Modes
        Of one wavenumber for each node.
    s : ndarray, shape (nodes,)
    frequency : float
        Up to which waves are resolved, radians per transit.
    places : sequence of InclinedPlace
    """
    k, every = np.broadcast_to(np.asarray(modes.wavenumber, np.complex128), s.shape), [*wall_faces(layers), *places]
    found = np.empty((len(every), 2, modes.count, s.size), np.complex128)
    with one_blas_thread():  # many small matrices
        for members, equations in inclined_meshes(layers, modes, s, frequency):
            rows = np.stack([equations.rows(place) for place in every])
            for order in range(members.start, members.stop):
                found[:, :, order] = equations.solve(float(modes.orders[order]), k, s, rows, [place.layer for place in every])
    found *= -1.0
    return (found[0, 0], found[0, 1], found[1, 1]), found[2:]
