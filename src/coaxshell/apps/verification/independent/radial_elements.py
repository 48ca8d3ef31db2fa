"""The independent solver: assemble all orders, integrate by Gauss's method of two stages, read displacement and stress.

At an axial wavenumber it gives the amplitudes of one wave along the axis, under true spherical waves from the plane z = 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from coaxshell.apps.verification.independent.assembly import Assembly
from coaxshell.apps.verification.independent.incident import incident
from coaxshell.apps.verification.independent.late import Late
from coaxshell.apps.verification.independent.links import Links, Places, shape
from coaxshell.apps.verification.independent.sphere import incident_sphere
from coaxshell.model.absorbers import Absorber
from coaxshell.model.parts import laws_of
from coaxshell.model.sources import Source
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray

ELEMENT = 0.125
"""Longest radial element, in a."""

_ROOT = np.sqrt(3.0)
_A = np.array([[1 / 4, 1 / 4 - _ROOT / 6], [1 / 4 + _ROOT / 6, 1 / 4]])
_NODES, _SQUARE = _A.sum(1), _A @ _A


def _layout(absorbers: Sequence[Absorber], sign: int) -> list[tuple[float, str]]:
    """Return places and properties of absorbers, or of their mirror images about theta = 0."""
    return sorted((round(sign * x.angle % 360, 9) % 360, repr(x.replace(angle=0))) for x in absorbers)


class RadialElements:
    """A system of elastic shells at orders 0..modes, integrated over ``duration`` transits.

    Parameters
    ----------
    system : System
    modes : int
    duration : float
        In transits; the exterior is cut where nothing returns within it.
    angles : int
        Number of angles in [0, 180) degrees at which a saturating controller's voltage is taken.
    element : float
        Longest radial element, in a.
    wavenumber : float, optional
        Axial wavenumber k in 1/a: sources are true spherical waves, and what they make is integrated over z > 0 times cos kz (sin kz
        for the axial motion), in units of a. Without it, the plane problem.
    """

    def __init__(
        self,
        system: System,
        modes: int,
        duration: float,
        angles: int = 0,
        element: float = ELEMENT,
        wavenumber: float | None = None,
    ) -> None:
        self.system, self.modes, self.wavenumber = system, modes, wavenumber
        self.assembly = Assembly.of(system, duration, element, wavenumber or 0.0)
        absorbers = system.absorber_list
        even = not any(law.dead for law in laws_of(system))
        symmetric = even and all(s.angle == 0 for s in system.sources) and _layout(absorbers, 1) == _layout(absorbers, -1)
        self.blocks = [(0, m) for m in range(modes + 1)] + ([] if symmetric else [(1, m) for m in range(1, modes + 1)])
        parts = [self.assembly.block(m) for _, m in self.blocks]
        sizes = np.concatenate([[0], np.cumsum([part.mass.shape[0] for part in parts])]).astype(int)
        masses = np.array([x.mass for x in absorbers]) / (system.exterior.density * self.assembly.length**2)
        loose = np.zeros((masses.size, masses.size))
        self._m = sp.block_diag([*(sp.csr_matrix(p.mass) for p in parts), sp.csr_matrix(np.diag(masses))], format="csc")
        self._c = sp.block_diag([*(sp.csr_matrix(p.damping) for p in parts), sp.csr_matrix(loose)], format="csc")
        self._k = sp.block_diag([*(sp.csr_matrix(p.stiffness) for p in parts), sp.csr_matrix(loose)], format="csc")
        self._late = Late.of(self.assembly, parts, int(self._m.shape[0]), self.blocks) if self.assembly.rational else None
        self._exterior = parts[0].exterior_point
        self._starts = sizes[:-1]
        places = Places(self.blocks, self._starts.tolist(), int(sizes[-1]), int(self._m.shape[0]), len(self.assembly.walls))
        self._links = Links(self.assembly, places, angles)
        if self._links.inertance.any():
            links, count = self._links, self._links.inertance.size
            self._m = self._m - sp.csc_matrix(links.apply[:, :count] @ (links.inertance[:, None] * links.read[:count]))
        self.time: npt.NDArray[Any] = np.zeros(1)
        self.v = self.w = self.u = np.zeros((len(self.assembly.walls), len(self.blocks), 1))

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return int(self._m.shape[0])

    def load(self, time: FloatArray) -> tuple[FloatArray, npt.NDArray[np.intp]]:
        """Return g(t) and its rows, per angle: incident pressure on the outer shell, minus its normal velocity into the scattered wave."""
        n, g = len(self.assembly.walls), np.zeros((2, len(self.blocks), len(time)))
        for source, distance in zip(self.system.sources, self.system.source_distances, strict=True):
            late = np.asarray(time) - source.delay / self.assembly.transit
            waves = self._incident(source, distance, late)
            for row, (parity, m) in enumerate(self.blocks):
                turn = shape(parity, m, np.radians(source.angle))
                for k, wave in enumerate(waves):
                    g[k, row] += turn * wave[m] * self.assembly.head
        return g.reshape(-1, len(time)), np.concatenate([self._starts + 2 * n - 1, self._starts + self._exterior])

    def _incident(self, source: Source, distance: float | None, time: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return modal pressure and radial velocity of a source about its own axis, each of shape (orders, T).

        Lengths and times are handed on in units of the outermost surface's radius, so that it is r = 1.
        """
        head = self.assembly.head
        units, time = (self.assembly.transit * head, self.assembly.pressure), time / head
        far = None if distance is None else distance / self.assembly.length / head
        if source.geometry == "line" or (far is None and self.wavenumber is not None):
            raise NotImplementedError(f"the independent solver has no {source.geometry} source here")
        orders = range(self.modes + 1)
        if far is None or self.wavenumber is None:
            return incident(source.pulse, far, orders, time, *units)
        pressure, velocity = incident_sphere(source.pulse, far, head * self.wavenumber, orders, time, *units)
        return head * pressure, head * velocity  # integrals along z, in a

    def solve(self, time_step: float, steps: int) -> Self:
        """Integrate by Gauss's method of two stages (order 4) and keep V, W, U of every block: ``v``, ``w``, ``u`` (shells, blocks, T)."""
        h, n = time_step, len(self.assembly.walls)
        matrix = sp.kron(np.eye(2), self._m) + h * sp.kron(_A, self._c) + h**2 * sp.kron(_SQUARE, self._k)
        factor = splu(sp.csc_matrix(matrix))
        interface = _Interface(self._links, factor, h) if self._links.count else None
        x, v = np.zeros(self.size), np.zeros(self.size)
        self.time = h * np.arange(steps + 1)
        self.v, self.w, self.u = np.zeros((3, n, len(self.blocks), steps + 1))
        past = None if self._late is None else self._late.beginning(h, steps)
        load, active = self.load((h * (np.arange(steps)[:, None] + _NODES)).ravel())
        for step in range(steps):
            right = np.zeros((2, self.size))
            right[:, active] = load[:, 2 * step : 2 * step + 2].T
            right -= (self._c @ v + self._k @ x) + h * _NODES[:, None] * (self._k @ v)
            if past is not None:
                right += past.load(step)
            acceleration = factor.solve(right.ravel())
            if interface is not None:
                acceleration = acceleration + interface.correction(x, v, acceleration)
            stages = acceleration.reshape(2, -1)
            x = x + h * v + h**2 * 0.5 * (_A.sum(0) @ stages)
            v = v + h * 0.5 * stages.sum(0)
            if past is not None:
                past.keep(step + 1, x, v)
            for i in range(n):
                for kept, place in zip((self.v, self.w, self.u), self.assembly.displacements(i), strict=True):
                    kept[i, :, step + 1] = x[self._starts + place]
        return self

    def displacement(self, shell: int, degrees: float) -> FloatArray:
        """Return w in m at one angle, positive inward, shape (T,)."""
        result: FloatArray = self.assembly.length * self._shapes(degrees) @ self.w[shell]
        return result

    def stress(self, shell: int, degrees: float) -> FloatArray:
        """Return the design stress of the core in Pa at one angle (Eq. 22), shape (T,)."""
        orders = np.array([m for _, m in self.blocks])[:, None]
        wall = self.assembly.walls[shell]
        strain = self._shapes(degrees) @ (orders * self.v[shell] - self.w[shell])
        result: FloatArray = wall.core / wall.radius * self.assembly.length * strain
        return result

    def _shapes(self, degrees: float) -> FloatArray:
        return np.array([shape(parity, m, np.radians(degrees)) for parity, m in self.blocks])


class _Interface:
    """The forces of the links at both stages of a step, by Newton's method on the few of them."""

    def __init__(self, links: Links, factor: object, h: float) -> None:
        self._links, self._h, count = links, h, links.count
        solve = factor.solve  # type: ignore[attr-defined]
        self._reach = solve(np.kron(np.eye(2), links.apply))
        stacked = (links.read @ self._reach.reshape(2, links.read.shape[1], -1)).reshape(2, -1)
        self._to_y = (h**2 * _SQUARE @ stacked).reshape(2 * count, 2 * count)
        self._to_dy = (h * _A @ stacked).reshape(2 * count, 2 * count)
        self._force = np.zeros(2 * count)

    def correction(self, x: FloatArray, v: FloatArray, acceleration: FloatArray) -> FloatArray:
        """Return what the links add to the accelerations of both stages."""
        h, read = self._h, self._links.read
        seen = (read @ acceleration.reshape(2, -1).T).T
        y0 = ((read @ x) + h * _NODES[:, None] * (read @ v) + h**2 * _SQUARE @ seen).ravel()
        dy0 = ((read @ v) + h * _A @ seen).ravel()
        for _ in range(60):
            f, by, bd = self._links.law(y0 + self._to_y @ self._force, dy0 + self._to_dy @ self._force)
            jacobian = np.eye(f.size) - by[:, None] * self._to_y - bd[:, None] * self._to_dy
            change = np.linalg.solve(jacobian, self._force - f)
            self._force = self._force - change
            if np.abs(change).max() <= 1e-12 * max(np.abs(self._force).max(), 1e-300):
                result: FloatArray = self._reach @ self._force
                return result
        raise RuntimeError("the interface forces did not converge")
