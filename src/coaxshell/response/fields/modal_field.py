"""Modal histories of the field at radii of one region, from the motion of its walls.

What drives a region is the transform of the modal slope dp/dr at its walls: a wall that moves inward by w makes (rho/rho_e) s^2 W, the
rigidly scattered wave minus the slope of the incident one at the outermost shell. Everything else about a region is its transfer from
the walls to radii inside it, order by order, for a block of radii at once.

Every field here is p = J_m A_m + E_m B_m with J_m = I_m(kr)/I_m(k r_b), r_b the outer wall, and E_m = K_m(kr)/K_m(k r_a), r_a the
inner wall; A and B hold the walls' slopes and do not depend on r. E_m follows from the recurrence of K_m, stable upward,

    E_{m+1} = (2m/(kr)) E_m/S_m(k r_a) + E_{m-1}/(S_m(k r_a) S_{m-1}(k r_a)),

without a division or a Bessel function but those of order 0 and 1; J_m from ratios, as I_m is stable downward only.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.special import ive, kve

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.operators import annulus_amplitudes
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.bessel_ratios import i_ratios
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.threads import WORKERS, map_on_threads
from coaxshell.response.fields.inversion import Inversion
from coaxshell.response.fields.request import Region
from coaxshell.solver.excitation import incident_on_surface
from coaxshell.solver.solved_spectra import SolvedSpectra

SCATTERED = {"radiated": ("radiated",), "diffracted": ("diffracted",), "scattered": ("radiated", "diffracted")}
SCATTERED["total"] = SCATTERED["scattered"]


@dataclass(frozen=True)
class WallSlopes:
    """Modal slopes at the inner and the outer wall of a region, each (parities, M + 1, nodes) or None where nothing drives it."""

    inner: ComplexArray | None
    outer: ComplexArray | None
    returned: ComplexArray | None = None
    """In the exterior, at its inner wall: of what the planes of the sea send back, regular around the shells."""


def wall_slopes(spectra: SolvedSpectra, grid: LaplaceGrid, region: Region, part: str) -> WallSlopes | None:
    """Return the slopes that make a part of the scattered field in a region; None if that part vanishes there."""
    radial = RadialBasis(spectra.modes, grid.nodes)

    def incident() -> ComplexArray:
        return incident_on_surface(spectra.problem, grid, radial, spectra.structure.returned)[1]

    inner, outer = (faces[..., : grid.nodes.size] for faces in spectra.face_motion)
    return region_slopes(region, part, inner, incident, radial, outer)


def region_slopes(
    region: Region,
    part: str,
    normal: ComplexArray,
    incident: Callable[[], ComplexArray],
    radial: RadialBasis,
    outer_faces: ComplexArray | None = None,
) -> WallSlopes | None:
    """Return the slopes at the walls of a region from the motion of all walls; None if the part vanishes there.

    Parameters
    ----------
    region : Region
    part : str
    normal : ndarray, shape (shells, parities, orders, nodes)
        W.
    incident : callable
        Gives the slope of the incident wave at the outermost surface, shape (1 or 2, orders, nodes).
    radial : RadialBasis
        Of the same orders and nodes.
    outer_faces : ndarray, optional
        W of the outer faces, where faces move differently and ``normal`` holds the inner ones.
    """
    beyond = normal if outer_faces is None else outer_faces
    parts = SCATTERED.get(part, ())
    if region.fluid is None or not parts or (parts == ("diffracted",) and not region.exterior):
        return None
    fluid, acceleration = region.fluid, region.fluid.density * radial.s * radial.s

    def radiated(shell: int, faces: ComplexArray) -> ComplexArray:
        return np.asarray(faces[shell] * acceleration * fluid.wall_motion_factor(shell, radial))

    inner: ComplexArray | None = None
    outer: ComplexArray | None = None
    if "radiated" in parts:
        if region.index > 0:
            inner = radiated(region.index - 1, beyond)
        if not region.exterior:
            outer = radiated(region.index, normal)
    if "diffracted" in parts and region.exterior:
        rigid = -incident()
        inner = rigid if inner is None else _sum_of_parities(inner, rigid)
    return WallSlopes(inner, outer)


def _sum_of_parities(one: ComplexArray, other: ComplexArray) -> ComplexArray:
    """Return the sum of two modal arrays of which either may lack the sines."""
    large, small = (one, other) if one.shape[0] >= other.shape[0] else (other, one)
    result = large.copy()
    result[: small.shape[0]] += small
    return result


Weight = FloatArray | ComplexArray

CENTRE = 1e-9
"""Least radius at which a disc is evaluated."""


class Transfer:
    """The field of one region in the Laplace domain, at one axial wavenumber.

    Parameters
    ----------
    region : Region
        Must hold a fluid.
    slopes : WallSlopes
    nodes : ndarray, shape (nodes,)
        Laplace variable.
    modes : Modes
        All orders up to a highest one.
    """

    def __init__(self, region: Region, slopes: WallSlopes, nodes: ComplexArray, modes: Modes) -> None:
        assert region.fluid is not None
        self.region, self.max_order, self.s = region, modes.max_order, nodes
        radial = RadialBasis(Modes.up_to(modes.max_order + 1, modes.wavenumber), nodes)  # one more: slopes need the next order
        self.kappa = radial.modes.kappa(region.fluid.slowness, nodes)
        self._inner = radial(region.fluid.slowness, region.inner) if region.index > 0 else None
        standing_from = region.inner if slopes.returned is not None else region.outer
        beyond = region.exterior and slopes.returned is None
        self._outer = None if beyond else radial(region.fluid.slowness, standing_from)
        self.standing, self.outgoing = self._amplitudes(slopes)
        driven = self.standing if self.standing is not None else self.outgoing
        assert driven is not None
        self.parities = driven.shape[0]

    def _amplitudes(self, slopes: WallSlopes) -> tuple[ComplexArray | None, ComplexArray | None]:
        """Return A and B, each (parities, M + 1, nodes) or None."""
        inner, outer, keep = self._inner, self._outer, slice(0, self.max_order + 1)
        if slopes.returned is not None:
            assert inner is not None
            assert slopes.inner is not None
            return slopes.returned * inner.disc[keep], slopes.inner * inner.exterior[keep]
        if inner is None or outer is None:
            standing = None if outer is None or slopes.outer is None else slopes.outer * outer.disc[keep]
            outgoing = None if inner is None or slopes.inner is None else slopes.inner * inner.exterior[keep]
            return standing, outgoing
        assert slopes.inner is not None
        assert slopes.outer is not None
        eps_i, eps_k, determinant = (x[keep] for x in annulus_amplitudes(inner, outer))
        return (
            (slopes.outer - eps_k * slopes.inner) * (outer.disc[keep] / determinant),
            (slopes.inner - eps_i * slopes.outer) * (inner.exterior[keep] / determinant),
        )

    def pressure(self, radii: FloatArray, weight: Weight) -> Iterator[tuple[int, ComplexArray]]:
        """Yield (m, weighted transforms of the pressure at all radii, shape (parities, radii, nodes)) for m = 0..M."""
        for m, parts in self._shapes(radii):
            yield m, _total([here * (amplitude[:, None, m] * weight) for amplitude, here, *_ in parts])

    def slope(self, radii: FloatArray, weight: Weight) -> Iterator[tuple[int, ComplexArray]]:
        """Yield (m, weighted transforms of dp/dr) as :meth:`pressure` does, from z f_m' = m f_m +- z f_{m+1} (DLMF 10.29.2)."""
        column = np.maximum(radii, CENTRE)[:, None]
        for m, parts in self._shapes(radii):
            yield (
                m,
                _total(
                    [(m / column * here + factor * higher) * (amplitude[:, None, m] * weight) for amplitude, here, higher, factor in parts]
                ),
            )

    def both(self, radii: FloatArray, *, slope: bool) -> Iterator[tuple[int, ComplexArray, ComplexArray | None]]:
        """Yield (m, transforms of the pressure, those of dp/dr if the *slope* is asked for), as :meth:`pressure` does, in one go."""
        column = np.maximum(radii, CENTRE)[:, None]
        for m, parts in self._shapes(radii):
            level = _total([here * amplitude[:, None, m] for amplitude, here, *_ in parts])
            if not slope:
                yield m, level, None
                continue
            steep = [factor * higher * amplitude[:, None, m] for amplitude, _, higher, factor in parts]
            yield m, level, _total([m / column * level, *steep])

    def _shapes(self, radii: FloatArray) -> Iterator[tuple[int, list[tuple[ComplexArray, ComplexArray, ComplexArray, ComplexArray]]]]:
        """Yield (m, [(A, J_m, I_{m+1}(kr)/I_m(k r_b), k), (B, E_m, E_{m+1}, -k K_{m+1}(k r_a)/K_m(k r_a))])."""
        radii = np.maximum(radii, CENTRE)
        standing = self._standing(radii) if self.standing is not None else None
        outgoing = self._outgoing(radii) if self.outgoing is not None else None
        for m in range(self.max_order + 1):
            parts = []
            if standing is not None and self.standing is not None:
                parts.append((self.standing, *next(standing)))
            if outgoing is not None and self.outgoing is not None:
                parts.append((self.outgoing, *next(outgoing)))
            yield m, parts

    def _standing(self, radii: FloatArray) -> Iterator[tuple[ComplexArray, ComplexArray, ComplexArray]]:
        assert self._outer is not None
        wall, count = self._outer, radii.size
        z = np.multiply.outer(radii, self.kappa)
        # The continuation beyond the wall (r > r_b) is as good: ratios only.
        ratios = i_ratios(self.max_order, z.ravel()).reshape(-1, count, self.kappa.size)
        here = ive(0, z) / ive(0, wall.argument) * np.exp(z.real - wall.argument.real)
        for m in range(self.max_order + 1):
            higher = here * ratios[m]
            yield here, higher, self.kappa
            here = higher / wall.i_ratios[m]

    def _outgoing(self, radii: FloatArray) -> Iterator[tuple[ComplexArray, ComplexArray, ComplexArray]]:
        assert self._inner is not None
        wall = self._inner
        inverse = 1.0 / wall.k_ratios
        z = np.multiply.outer(radii, self.kappa)
        order_zero, phase = 1.0 / kve(0, wall.argument), np.exp(wall.argument - z)
        here = kve(0, z) * order_zero * phase
        higher = kve(1, z) * order_zero * phase * inverse[0]
        per_radius = (2.0 / radii)[:, None]
        for m in range(self.max_order + 1):
            yield here, higher, -self.kappa * wall.k_ratios[m]
            step = inverse[m + 1]
            here, higher = higher, (per_radius * higher) * ((m + 1) / self.kappa * step) + here * (step * inverse[m])


def _total(parts: list[ComplexArray]) -> ComplexArray:
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total


Quantity = Literal["pressure", "slope", "radial", "angular"]
"""Pressure, its radial slope, and the particle velocity outward and towards increasing angle; all dimensionless."""

_BLOCK = 16 * 1024
"""Radius-node pairs of one block: a quarter of a megabyte, of which a dozen share a cache."""


class ModalField:
    """The scattered field of one region as circumferential orders.

    Parameters
    ----------
    region : Region
        Must hold a fluid.
    transfer : Transfer
    grid : LaplaceGrid
        The band of nodes of the transfer.
    """

    def __init__(self, region: Region, transfer: Transfer, grid: LaplaceGrid) -> None:
        assert region.fluid is not None
        self.region, self.grid, self._transfer = region, grid, transfer
        self._density = region.fluid.density
        self.parities = transfer.parities

    def spectra(self, radii: FloatArray, quantity: Quantity, weight: FloatArray) -> Iterator[tuple[int, ComplexArray]]:
        """Yield (m, weighted transforms of a quantity at radii, (parities, radii, nodes)) for m = 0..M."""
        momentum = self._density * self.grid.nodes
        match quantity:
            case "pressure":
                yield from self._transfer.pressure(radii, weight)
            case "slope":
                yield from self._transfer.slope(radii, weight)
            case "radial":
                yield from self._transfer.slope(radii, -weight / momentum)
            case "angular":
                turning = 1.0 / np.maximum(radii, CENTRE)[:, None]
                for m, pressure in self._transfer.pressure(radii, weight / momentum):
                    pressure *= m * turning
                    sine = -pressure[1] if self.parities == 2 else np.zeros_like(pressure[0])
                    yield m, np.stack([sine, pressure[0]])  # coefficients of cos(m theta) and sin(m theta)

    def histories(
        self, radii: FloatArray, times: FloatArray, quantity: Quantity = "pressure", dtype: npt.DTypeLike = np.float64
    ) -> npt.NDArray[np.floating]:
        """Return a quantity at radii and times, shape (radii, parities, M + 1, times)."""
        inversion = Inversion(self.grid, times)
        parities = 2 if quantity == "angular" else self.parities
        result = np.empty((radii.size, parities, self._transfer.max_order + 1, times.size), dtype)
        width = max(1, min(-(-radii.size // WORKERS), _BLOCK // self.grid.nodes.size))

        def work(start: int) -> None:
            span = slice(start, start + width)
            for m, spectra in self.spectra(radii[span], quantity, inversion.weight):
                result[span, :, m] = inversion(spectra).swapaxes(0, 1)

        list(map_on_threads(work, range(0, radii.size, width)))
        return result


def modal_field(spectra: SolvedSpectra, grid: LaplaceGrid, region: Region, part: str, *, sent_back: bool = False) -> ModalField | None:
    """Return the field of a region; None where the part vanishes.

    With what the planes of the sea send back around the shells if that is asked for: it is one with the rest within the nearest of them.
    """
    slopes = wall_slopes(spectra, grid, region, part)
    if slopes is None:
        return None
    returned = spectra.structure.returned
    if sent_back and region.exterior and returned is not None and part in ("total", "scattered"):
        surface = RadialBasis(spectra.modes, grid.nodes)(1.0, spectra.problem.head)
        regular = returned[..., : grid.nodes.size] / (surface.disc - surface.exterior)
        assert slopes.inner is not None
        missing = slopes.inner.shape[0] - regular.shape[0]
        regular = np.concatenate([regular, np.zeros_like(slopes.inner[: max(0, missing)])])
        slopes = replace(slopes, returned=regular)
    return ModalField(region, Transfer(region, slopes, grid.nodes, spectra.modes), grid)
