r"""Answers at a frequency under a point source: the sum over axial wavenumbers k (theory manual, section "Steady motion").

A spherical wave has all wavenumbers at one frequency. With F(k) what a wave of wavenumber k gives (:mod:`coaxshell.acoustics.sources`),

    p(z) = (2/pi) * integral from 0 to inf of F(k) cos(k (z - z_s)) dk.

F has the poles of waves that run along the walls without loss on the real axis, and a branch point at k = omega/c. The path of integration
passes them on the side from which damping would let it see them: k = t + i d tanh(t/2d), d > 0 for e^{i omega t}, since a wave that carries
energy away from the source and decays has its pole below the axis. A wave whose phase runs against its energy has it above: two paths, d
and d/2, tell whether one lies between them, and how well the sum is resolved.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.acoustics.sources import SphericalFrontGeometry, SphericalGeometry
from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.frequency.fields import region_of
from coaxshell.response.frequency.request import Asked
from coaxshell.response.frequency.steady import Tail
from coaxshell.solver.excitation import source_spectrum
from coaxshell.solver.scaling import Problem
from coaxshell.solver.steady import Frequencies, SteadySystem

DEEPEST = 1.0
"""d of the deeper path, in 1/a; at most 2/|z|, as cos kz grows with it."""
RISE = 0.5
"""Its slope where it leaves k = 0."""
UNRESOLVED = 1e-3
"""Difference of both paths, relative to the largest value, above which an answer warns."""
_PANEL, _NODES = 1.2, 12
"""Width of a panel over its distance from the axis, and its nodes (Gauss and Legendre)."""
_FIRST = 1e-4
"""First panel over the frequency, in 1/a, or over d: waves near their cut-off lie close to k = 0."""
_FADED = 32.0
"""(k - omega/c) times the distance from the surface to the source at the end of the path: e^-32."""
_FURTHEST = 400.0
"""Largest k a, of sources that touch the surface."""

Read = Callable[[SteadySystem, Asked, Tail], Any]


class Path(NamedTuple):
    """Wavenumbers (1/a) and what each counts in the integral of F dk."""

    wavenumbers: ComplexArray
    weights: ComplexArray


def path_of(omega: float, depth: float, rise: float, distance: float) -> Path:
    """Return the path k = t + i d tanh(rise t/d).

    Parameters
    ----------
    omega : float
        Radians per transit.
    depth, rise : float
        d, in 1/a, and the slope at k = 0.
    distance : float
        From the surface to the source, in a.
    """
    end = min(omega + _FADED / distance, omega + _FURTHEST)
    edges = [0.0, _FIRST * min(omega, depth)]
    while edges[-1] < end:
        edges.append(edges[-1] + _PANEL * max(edges[-1] - edges[-2], depth * np.tanh(rise * edges[-1] / depth)))
    nodes, weights = np.polynomial.legendre.leggauss(_NODES)
    start, half = np.array(edges[:-1])[:, None], 0.5 * np.diff(edges)[:, None]
    t = (start + half * (1.0 + nodes)).ravel()
    bend = np.tanh(rise * t / depth)
    return Path(t + 1j * depth * bend, (half * weights).ravel() * (1.0 + 1j * rise * (1.0 - bend**2)))


def of_point_source(problem: Problem, omega: FloatArray, orders: int, what: Asked, tail: Tail, read: Read) -> tuple[Any, float]:
    """Return values at angular frequencies (radians per transit), and the largest difference of both paths over the largest value.

    Parameters
    ----------
    problem : Problem
        Of three dimensions, its one source a point.
    omega : ndarray, shape (F,)
    orders : int
        Highest circumferential order.
    what : Asked
    tail : Tail
    read : callable
        Values of a quantity of a steady system at some nodes, (nodes, ...).

    Raises
    ------
    InputError
        The quantity is no amplitude that is linear in the motion at a place.
    """
    _require(problem, what)
    geometry, source = problem.sources[0], problem.system.sources[0]
    assert isinstance(geometry, SphericalFrontGeometry)
    away = (what.z - getattr(source, "z", 0.0)) / problem.scales.length
    scattered = replace(what, part="scattered") if what.quantity.kind == "field" else what
    found, apart = [], 0.0
    for one in omega:
        both, resolving = [], problem.resolving(float(one))
        for share in (1.0, 0.5):
            depth = share * min(DEEPEST, 2.0 / abs(away) if away else DEEPEST)
            path = path_of(float(one), depth, share * RISE, geometry.distance - geometry.head)
            grid = Frequencies.of(np.full(path.wavenumbers.size, float(one)))
            system = SteadySystem(resolving, grid, Modes.up_to(orders, path.wavenumbers))
            along = 2.0 / np.pi * path.weights * np.cos(path.wavenumbers * away)
            both.append(np.tensordot(along, read(system, scattered, tail), axes=1))
        found.append(both[1])
        apart = max(apart, float(np.abs(both[1] - both[0]).max(initial=0.0) / max(np.abs(both[1]).max(initial=0.0), 1e-300)))
    values = np.stack(found)
    if what.quantity.kind == "field" and what.part != "scattered":
        values = values + _incident(problem, omega, what, away)
    return values, apart


def _require(problem: Problem, what: Asked) -> None:
    """Raise InputError if a quantity is not read under a point source."""
    if len(problem.sources) > 1:
        raise InputError("source", "each point source has a sum of its own", "give the number of one, source=0")
    if what.quantity.kind not in ("shell", "field"):
        remedy = "ask for a motion, a stress, a voltage or a pressure, or use dimensions=2, or a plane wave"
        raise InputError("quantity", f"{what.quantity.name!r} is not read under a point source in three dimensions", remedy)


def _incident(problem: Problem, omega: FloatArray, what: Asked, away: float) -> ComplexArray:
    """Return the incident wave where it counts, outside, 0 elsewhere; shape as the values."""
    (geometry,), (source,) = problem.sources, problem.system.sources
    assert geometry.distance is not None
    s, radii, turn = Frequencies.of(omega).nodes, np.atleast_1d(what.radii), np.radians(np.atleast_1d(what.theta) - source.angle)
    slice_ = SphericalGeometry(geometry.distance, geometry.head)  # alike in every plane through the source's axis
    found = np.zeros((omega.size, radii.size, turn.size), np.complex128)
    for number, radius in enumerate(radii):
        if region_of(problem, float(radius)) == len(problem.shells):
            found[:, number] = slice_.free_spectrum(s, radius * np.cos(turn), np.hypot(radius * np.sin(turn), away)).T
    if what.per == "absolute":
        found *= source_spectrum(problem, source, s)[:, None, None] * (problem.scales.pressure * problem.scales.time)
    found = found if what.radii.ndim else found[:, 0]
    return found if what.theta.ndim else found[..., 0]


def remarks(apart: float) -> list[str]:
    """Return a warning if the two paths disagree."""
    if apart <= UNRESOLVED:
        return []
    return [
        f"k: the sum over axial wavenumbers changes by {100.0 * apart:.2g} % between two paths that pass the waves of the walls at "
        "different distances: a frequency is close to a wave's cut-off, or a wave carries its energy against its phase; simulate in three "
        "dimensions and take response.spectrum"
    ]
