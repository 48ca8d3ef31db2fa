"""Eigenbasis of a wall of solid layers in vacuo, one for each mode, from which every answer to loads on its faces is a sum.

With K(m, k) and the diagonal mass M of the points, both real and independent of s, K x = omega^2 M x gives real shapes, x'M x = 1, and

    (K + M s^2)^-1 = sum over shapes of x x'/(omega^2 + s^2).

K = A'A is never formed: its rows A are the strains at the points times sqrt(weight) L', C = L L', and the potentials of piezoelectric
layers with grounded faces, statically condensed. Shapes and frequencies are the right singular vectors and the singular values of
A M^(-1/2): eigenvalues of K would lose the low ones of thin walls (1 mm, m = 2: omega^2 = -5.5 instead of 17.75).

Orders that need about the same degrees share a mesh; beyond a run's own orders samples of few high ones are asked for.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.numerics.cache import ByteBoundedCache
from coaxshell.numerics.modes import Modes
from coaxshell.structure.elastic_mesh import LayerMesh, WallMesh, degrees, strains, wall_mesh
from coaxshell.structure.solid import AXIAL, HOOP, PLANE, RADIAL, RADIAL_AXIAL, RADIAL_HOOP, STRAINS, SolidLayer

_LOW = 1e-2
"""Of the largest, below which eigenvalues are mended."""
STEP = 4
"""Degrees that orders of one mesh may differ by."""


@dataclass(frozen=True, eq=False)
class OrdersBasis:
    """Shapes of some consecutive orders, which share a mesh.

    Attributes
    ----------
    members : slice
        Their places among the orders of the modes.
    orders : ndarray, shape (orders,)
    wavenumber : float
        k.
    mesh : WallMesh
    squares : ndarray, shape (orders, shapes)
        omega^2, ascending; exactly 0 of rigid motions.
    shapes : ndarray, shape (orders, shapes, 2 or 3, points)
        u_r, u_theta and, where there is an axial wavenumber, u_z.
    """

    members: slice
    orders: FloatArray
    wavenumber: float
    mesh: WallMesh
    squares: FloatArray
    shapes: FloatArray

    @property
    def faces(self) -> FloatArray:
        """u_r of the inner and of the outer face, shape (orders, 2, shapes)."""
        return np.stack([self.shapes[:, :, 0, 0], self.shapes[:, :, 0, -1]], axis=1)

    @cached_property
    def ceramics(self) -> dict[LayerMesh, PotentialOfLayer]:
        """The potential of each piezoelectric layer."""
        ceramics = (part for part in self.mesh.layers if part.layer.coupling is not None)
        return {part: PotentialOfLayer(part, self.orders, self.wavenumber) for part in ceramics}

    @cached_property
    def potentials(self) -> dict[LayerMesh, FloatArray]:
        """Phi at the points of each piezoelectric layer per displacement there (:class:`PotentialOfLayer`)."""
        return {part: potential.values for part, potential in self.ceramics.items()}

    @cached_property
    def electric_rows(self) -> list[FloatArray]:
        """Rows of the potentials of each layer per unit of each shape, (orders, rows, shapes); no rows of a layer without."""
        none = np.zeros((self.orders.size, 0, self.squares.shape[1]))
        return [
            np.einsum("micp,mncp->min", self.ceramics[layer].rows, self.shapes[..., layer.nodes]) if layer in self.ceramics else none
            for layer in self.mesh.layers
        ]


def some_of(whole: Sequence[OrdersBasis], orders: FloatArray) -> tuple[OrdersBasis, ...]:
    """Return the shapes of some ascending orders of those of a basis."""
    found, start = [], 0
    for part in whole:
        own = np.isin(part.orders, orders)
        members = slice(start, start + int(np.count_nonzero(own)))
        if members.stop > start:
            found.append(OrdersBasis(members, part.orders[own], part.wavenumber, part.mesh, part.squares[own], part.shapes[own]))
        start = members.stop
    return tuple(found)


def displacements(wavenumber: float) -> int:
    """Return how many displacements take part: two where nothing changes along the axis, where u_z goes by itself, else three."""
    return 2 if wavenumber == 0.0 else 3


def involved(wavenumber: float) -> tuple[int, ...]:
    """Return the strains that take part."""
    return PLANE if wavenumber == 0.0 else tuple(range(STRAINS))


def rigid_motions(order: float, wavenumber: float) -> int:
    """Return how many motions of a mode strain nothing: rotation and translation of the section, of orders 0 and 1 at k = 0."""
    return int(wavenumber == 0.0 and order in (0.0, 1.0))


def elastic_basis(
    layers: Sequence[SolidLayer], modes: Modes, frequency: float, meshed_as: Sequence[SolidLayer] | None = None
) -> tuple[OrdersBasis, ...]:
    """Return the shapes of all orders of some modes; those of the plane problem are kept, and nobody may change them.

    Parameters
    ----------
    layers : sequence of SolidLayer
        Dimensionless.
    modes : Modes
        Of a real wavenumber.
    frequency : float
        Up to which waves are resolved, radians per transit.
    meshed_as : sequence of SolidLayer, optional
        Layers nearby whose number of points these take: it jumps as layers change.
    """
    assert isinstance(modes.wavenumber, (int, float))
    wavenumber = float(modes.wavenumber)

    def made() -> tuple[OrdersBasis, ...]:
        meshes = order_meshes(tuple(layers), modes.orders, wavenumber, frequency, meshed_as)
        return tuple(orders_basis(mesh, members, modes.orders[members], wavenumber) for members, mesh in meshes)

    if wavenumber != 0.0 or meshed_as is not None:  # one of thousands, or of a difference
        return made()
    return _known.get_or_make((tuple(layers), modes.orders.tobytes(), frequency), made)


def order_meshes(
    layers: tuple[SolidLayer, ...],
    orders: FloatArray,
    wavenumber: float,
    frequency: float,
    meshed_as: Sequence[SolidLayer] | None = None,
    most: int | None = None,
) -> list[tuple[slice, WallMesh]]:
    """Return the meshes of some orders at an axial wavenumber, and the places of the orders that share each.

    Layers with losses have no higher degree than *most*: waves that are shorter die within them.
    """
    needed = np.stack([degrees(layer, orders, wavenumber, frequency) for layer in meshed_as or layers], axis=1)
    if most is not None:
        needed = np.minimum(needed, [needed.max() if layer.factor is None else most for layer in layers])
    steps = np.ceil(needed / STEP).astype(int)
    edges = [0, *(1 + np.flatnonzero(np.any(np.diff(steps, axis=0), axis=1))), orders.size]
    members = [slice(int(start), int(stop)) for start, stop in pairwise(edges)]
    return [(some, _mesh(layers, tuple(int(p) for p in needed[some].max(axis=0)))) for some in members]


def stiffness_powers(mesh: WallMesh) -> FloatArray:
    """Return K of (u_r, u_theta, u_z) without potentials by 1, m, m^2, k, k^2 and m k, (6, n, n), over the roots of the mass."""
    return _linear_rows(mesh)[1]


def layer_powers(mesh: WallMesh, part: LayerMesh, matrix: FloatArray) -> FloatArray:
    """Return the same of one layer and some C alone, (6, 3 (p + 1), 3 (p + 1)), over the roots of the mass at its points."""
    local = [strains(np.array([m]), k, part.radius, part.derivative, np.eye(part.radius.size))[0] for m, k in ((0, 0), (1, 0), (0, 1))]
    each = [local[0], local[1] - local[0], local[2] - local[0]]
    flat = [(one * np.sqrt(part.weights)[:, None, None]).reshape(len(matrix), len(part.radius), -1) for one in each]
    products = [[np.einsum("iqa,ij,jqb->ab", a, matrix, b, optimize=True) for b in flat] for a in flat]
    (ff, fa, fl), (af, aa, al), (lf, la, ll) = products
    root = np.tile(np.sqrt(mesh.mass[part.nodes]), len(flat))
    return np.asarray(np.stack([ff, fa + af, aa, fl + lf, ll, al + la]) / np.multiply.outer(root, root), dtype=np.float64)


def plane_bytes(layers: tuple[SolidLayer, ...], orders: FloatArray, frequency: float) -> int:
    """Return the bytes that the shapes of a plane problem take, with what is made of them where they outlast a run."""
    meshes = [(mesh, members.stop - members.start) for members, mesh in order_meshes(layers, orders, 0.0, frequency)]
    kept = sum(_bytes(*one) for one in meshes)
    return kept if kept <= _known.most else sum(8 * count * (displacements(0.0) * mesh.radius.size) ** 2 for mesh, count in meshes)


def _own_bytes(parts: tuple[OrdersBasis, ...]) -> int:
    return sum(_bytes(part.mesh, part.orders.size) for part in parts)


def _bytes(mesh: WallMesh, orders: int) -> int:
    """Return the bytes of the shapes of so many orders, and of the rows and potentials of ceramics that may be made of them."""
    size = displacements(0.0) * mesh.radius.size
    points = [part.radius.size for part in mesh.layers if part.layer.coupling is not None]
    return 8 * orders * (size**2 + sum(5 * p * p + p * size for p in points))


_known: ByteBoundedCache[tuple[OrdersBasis, ...]] = ByteBoundedCache(2**26, _own_bytes)
"""Of the plane problem: runs of one wall under other sources, absorbers or gains share its shapes, as do the stages of one run."""

_mesh = lru_cache(maxsize=64)(wall_mesh)
"""Many waves share a mesh, and what is made of it."""


def orders_basis(mesh: WallMesh, members: slice, orders: FloatArray, wavenumber: float) -> OrdersBasis:
    """Return the shapes of some orders on a mesh; ``members`` are their places among the orders of the modes."""
    if wavenumber != 0.0:
        return _along_the_axis(mesh, members, orders, wavenumber)
    root = np.sqrt(mesh.mass)
    rows = strain_rows(mesh, orders, wavenumber) / root
    stacked = rows.reshape(*rows.shape[:2], -1)
    with one_blas_thread():  # many small matrices
        _, values, vectors = np.linalg.svd(np.linalg.qr(stacked, mode="r"))
    values, vectors = values[:, ::-1], vectors[:, ::-1]
    for row, order in zip(values, orders, strict=True):
        row[: rigid_motions(float(order), wavenumber)] = 0.0
    shapes = vectors.reshape(*vectors.shape[:2], *rows.shape[2:]) / root
    return OrdersBasis(members, orders, wavenumber, mesh, values**2, shapes)


def _along_the_axis(mesh: WallMesh, members: slice, orders: FloatArray, wavenumber: float) -> OrdersBasis:
    """Return the shapes of many waves at less than half the cost: the eigenvalues of A'A, of which the low ones are then mended.

    They, and the shapes beside, err by the rounding of the largest: shapes as a whole span what they should to 1e-12. The singular values
    of A on the low shapes alone give both to all digits.
    """
    rows, products = _linear_rows(mesh)
    stacked = rows[0] + orders[:, None, None] * rows[1] + wavenumber * rows[2]
    root, ones = np.sqrt(mesh.mass), np.ones_like(orders)
    powers = np.stack([ones, orders, orders**2, wavenumber * ones, wavenumber**2 * ones, wavenumber * orders], axis=1)
    ceramics = {part: PotentialOfLayer(part, orders, wavenumber) for part in mesh.layers if part.layer.coupling is not None}
    with one_blas_thread():  # many small matrices
        stiffness = (powers @ products.reshape(len(products), -1)).reshape(orders.size, *products.shape[1:])
        for part, potential in ceramics.items():
            electric = (_widened(potential.rows, part, mesh) / root).reshape(*potential.rows.shape[:2], -1)
            stiffness += np.swapaxes(electric, 1, 2) @ electric
            stacked = np.concatenate([stacked, electric], axis=1)
        squares, vectors = np.linalg.eigh(stiffness)
        low = int(np.count_nonzero(squares < _LOW * squares[:, -1:], axis=1).max())
        if low:
            _, values, turned = np.linalg.svd(stacked @ vectors[..., :low], full_matrices=False)
            squares[:, :low] = values[:, ::-1] ** 2
            vectors[..., :low] = vectors[..., :low] @ np.swapaxes(turned[:, ::-1], 1, 2)
    shapes = np.swapaxes(vectors, 1, 2).reshape(orders.size, -1, displacements(wavenumber), mesh.radius.size) / root
    found = OrdersBasis(members, orders, wavenumber, mesh, squares, shapes)
    vars(found)["ceramics"] = ceramics  # which it would make again
    vars(found)["potentials"] = {part: potential.values for part, potential in ceramics.items()}
    return found


@lru_cache(maxsize=64)
def _linear_rows(mesh: WallMesh) -> tuple[FloatArray, FloatArray]:
    """Return the rows A of a mesh without potentials, and A'A, by powers of m and k; per root of the mass as :func:`orders_basis` has them.

    Strains are linear in both: (3, rows, n) of 1, m and k, and (6, n, n) of 1, m, m^2, k, k^2 and m k, n displacements at points.
    """
    found, root = [], np.sqrt(mesh.mass)
    for part in mesh.layers:
        local = [strains(np.array([m]), k, part.radius, part.derivative, np.eye(part.radius.size)) for m, k in ((0, 0), (1, 0), (0, 1))]
        each = np.concatenate([local[0], local[1] - local[0], local[2] - local[0]])
        scaled = np.einsum("ij,mjqcp->miqcp", np.linalg.cholesky(part.layer.matrix).T, each) * np.sqrt(part.weights)[:, None, None]
        wide = _widened(scaled.reshape(3, -1, *scaled.shape[3:]), part, mesh) / root
        found.append(wide.reshape(*wide.shape[:2], -1))
    fixed, around, along = rows = np.concatenate(found, axis=1)
    pairs = ((fixed, fixed), (fixed, around), (around, around), (fixed, along), (along, along), (around, along))
    return rows, np.stack([a.T @ b if a is b else a.T @ b + b.T @ a for a, b in pairs])


def _widened(rows: FloatArray, part: LayerMesh, mesh: WallMesh) -> FloatArray:
    """Return rows of the points of a layer, (..., displacements, points), as rows of all points."""
    wide = np.zeros((*rows.shape[:-1], mesh.radius.size))
    wide[..., part.nodes] = rows
    return wide


def strain_rows(mesh: WallMesh, orders: FloatArray, wavenumber: float) -> FloatArray:
    """Return the rows A of K = A'A, shape (orders, rows, displacements, points)."""
    taking, count, rows = list(involved(wavenumber)), displacements(wavenumber), []
    for part in mesh.layers:
        local = layer_strains(part, orders, wavenumber)
        root = np.linalg.cholesky(part.layer.matrix[np.ix_(taking, taking)]).T
        scaled = np.einsum("ij,mjqcp->miqcp", root, local[:, taking]) * np.sqrt(part.weights)[:, None, None]
        found = [scaled.reshape(orders.size, -1, *scaled.shape[3:])]
        if part.layer.coupling is not None:
            found.append(PotentialOfLayer(part, orders, wavenumber).rows)
        for each in found:
            wide = np.zeros((*each.shape[:2], count, mesh.radius.size))
            wide[..., part.nodes] = each
            rows.append(wide)
    return np.concatenate(rows, axis=1)


def layer_strains(part: LayerMesh, orders: FloatArray, wavenumber: float, taking: int | None = None) -> FloatArray:
    """Return the strains at the points of a layer, shape (orders, 6, points, displacements, points).

    ``taking`` is how many displacements take part, unless told all that do at the wavenumber.
    """
    local = strains(orders, wavenumber, part.radius, part.derivative, np.eye(part.radius.size))
    return local[:, :, :, : displacements(wavenumber) if taking is None else taking]


class PotentialOfLayer:
    """The potential of a piezoelectric layer between grounded faces under displacements at its points.

    Stationary enthalpy, with E = (-Phi', (m/r) Phi, k Phi), gives G Phi = Q u at the points between the faces,

        G = int mu33 Phi'^2 + (mu22 (m/r)^2 + mu11 k^2) Phi^2,      Q = int Phi' (e33 eps_r + e32 eps_theta + e31 eps_z)
                                                                        - Phi e15 ((m/r) gamma_r_theta + k gamma_rz),

    and adds Q'G^-1 Q to K.

    Attributes
    ----------
    rows : ndarray, shape (orders, p - 1, displacements, points)
        L^-1 Q, G = L L'.
    root : ndarray, shape (orders, p - 1, p - 1)
        L.
    """

    def __init__(self, part: LayerMesh, orders: FloatArray, wavenumber: float, taking: int | None = None) -> None:
        layer, local = part.layer, layer_strains(part, orders, wavenumber, taking)
        assert layer.coupling is not None
        assert layer.permittivity is not None
        e, mu, weights, inside = np.array(layer.coupling), layer.permittivity, part.weights, slice(1, -1)
        slope = part.derivative[:, inside]
        per_radius = orders[:, None] / part.radius
        along = weights * (mu[1] * per_radius**2 + mu[2] * wavenumber**2)
        electric = np.einsum("qi,q,qj->ij", slope, mu[0] * weights, slope) + np.zeros((orders.size, 1, 1))
        places = np.arange(part.radius.size - 2)
        electric[:, places, places] += along[:, inside]
        radial = np.einsum("j,mjqcp->mqcp", e[0, [RADIAL, HOOP, AXIAL]], local[:, [RADIAL, HOOP, AXIAL]])
        around = per_radius[:, :, None, None] * e[1, RADIAL_HOOP] * local[:, RADIAL_HOOP]
        around = around + wavenumber * e[2, RADIAL_AXIAL] * local[:, RADIAL_AXIAL]
        charge = -(weights[:, None, None] * around)[:, inside]
        flat = charge.reshape(*charge.shape[:2], -1)
        flat += (slope * weights[:, None]).T @ radial.reshape(*radial.shape[:2], -1)
        self.root: FloatArray = np.linalg.cholesky(electric)
        self.rows: FloatArray = np.linalg.solve(self.root, flat).reshape(charge.shape)

    @property
    def per_row(self) -> FloatArray:
        """Return Phi at the points of the layer per unit of each row, L'^-1, shape (orders, points, p - 1)."""
        inverse = np.linalg.inv(np.swapaxes(self.root, 1, 2))
        return np.pad(inverse, ((0, 0), (1, 1), (0, 0)))

    @property
    def values(self) -> FloatArray:
        """Return Phi at the points of the layer per displacement there, shape (orders, points, displacements, points)."""
        flat = self.rows.reshape(*self.rows.shape[:2], -1)
        inner = np.linalg.solve(np.swapaxes(self.root, 1, 2), flat).reshape(self.rows.shape)
        return np.pad(inner, ((0, 0), (1, 1), (0, 0), (0, 0)))
