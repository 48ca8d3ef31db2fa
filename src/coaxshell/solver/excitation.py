"""The sources of a system as dimensionless loads on the outermost shell."""

from __future__ import annotations

from collections.abc import Iterable
from threading import Lock

import numpy as np

from coaxshell.acoustics.incident import IncidentWave, SurfaceLoad
from coaxshell.acoustics.incident_parts import incident_parts
from coaxshell.acoustics.operators import RadialFunctions
from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.model.sources import Source
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts


def incident_wave(problem: Problem, source: Source) -> IncidentWave:
    """Return the geometry of a source in units of the reference radius."""
    return problem.ingredients.source_geometry(problem, source)


def source_spectrum(problem: Problem, source: Source, s: ComplexArray) -> ComplexArray:
    """Return the transform of the source's pulse, delayed by its delay, at the head in free field."""
    scales = problem.scales
    spectrum = pulse_transform(source.pulse, s, scales.time, scales.pressure)
    return spectrum * np.exp(-s * (source.delay / scales.time)) if source.delay else spectrum


def source_parities(sources: Iterable[Source]) -> int:
    """Return how many parities the sources excite: 1, cosines alone, where all lie on the axis theta = 0, 180 degrees; else 2."""
    return 2 if any(source.angle % 180.0 != 0.0 for source in sources) else 1


class UnitLoad:
    """The modal load of a unit pulse of one geometry; its projections are made when first needed.

    Parameters
    ----------
    wave : IncidentWave
    grid : LaplaceGrid
    orders : ndarray
    shared : SharedParts, optional
        Where loads are found, or left for the next one.
    """

    def __init__(self, wave: IncidentWave, grid: LaplaceGrid, orders: FloatArray, shared: SharedParts | None) -> None:
        self._wave, self._grid, self._orders, self._shared = wave, grid, orders, shared
        self._lock = Lock()
        self._load: SurfaceLoad | None = None

    def __call__(self, surface: RadialFunctions, nodes: slice) -> ComplexArray:
        """Return L_m at a slice of the grid's nodes, shape (orders, nodes)."""
        if self._shared is None:
            return self._made(surface, nodes)
        key = ("load", self._wave, self._grid, self._orders.tobytes(), (nodes.start, nodes.stop, nodes.step))
        load: ComplexArray = self._shared.get_or_make(key, lambda: self._made(surface, nodes))
        return load

    def _made(self, surface: RadialFunctions, nodes: slice) -> ComplexArray:
        with self._lock:
            if self._load is None:
                self._load = self._wave.prepare(self._grid, self._orders)
        return self._load(surface, nodes)


class SurfaceLoads:
    """The modal loads of all sources on the outermost shell, prepared for some orders on a Laplace grid.

    A source at angle theta_s loads cos(m theta) with cos(m theta_s) and sin(m theta) with sin(m theta_s) of its own series.
    Sources that share a geometry share its modal load.
    """

    def __init__(self, problem: Problem, grid: LaplaceGrid, orders: FloatArray, shared: SharedParts | None = None) -> None:
        self.parities = source_parities(problem.system.sources)
        self._problem, self._orders = problem, orders
        self._groups = [
            (UnitLoad(wave, grid, orders, shared), [(source, source_spectrum(problem, source, grid.nodes)) for source in sources])
            for wave, sources in _geometries(problem).items()
        ]

    def __call__(self, surface: RadialFunctions, nodes: slice) -> list[ComplexArray]:
        """Return the load of the cosines, and of the sines if any source needs them, at a slice of the grid's nodes."""
        units = ((unit(surface, nodes), [(source, x[nodes]) for source, x in sources]) for unit, sources in self._groups)
        return _superposed(self._problem, self._orders, units)


def incident_on_surface(problem: Problem, grid: LaplaceGrid, surface: RadialFunctions) -> tuple[ComplexArray, ComplexArray]:
    """Return the modal pressure and slope dp/dr at r = 1 of all incident waves, each (1 or 2, M + 1, nodes).

    *surface* holds the exterior fluid's functions there, at all orders and the nodes of the grid.
    """
    orders = surface.orders
    groups = [
        (incident_parts(wave, grid, orders, surface), [(source, source_spectrum(problem, source, grid.nodes)) for source in sources])
        for wave, sources in _geometries(problem).items()
    ]
    pressure, slope = (np.stack(_superposed(problem, orders, ((parts[which], sources) for parts, sources in groups))) for which in (0, 1))
    return pressure, slope


def _geometries(problem: Problem) -> dict[IncidentWave, list[Source]]:
    """Return the sources of each geometry."""
    groups: dict[IncidentWave, list[Source]] = {}
    for source in problem.system.sources:
        groups.setdefault(incident_wave(problem, source), []).append(source)
    return groups


def _superposed(
    problem: Problem, orders: FloatArray, units: Iterable[tuple[ComplexArray, list[tuple[Source, ComplexArray]]]]
) -> list[ComplexArray]:
    """Return the cosines, and the sines if any source needs them, of what all make.

    *units* are what a unit pulse of each geometry makes, and the sources of that geometry with the transforms of their pulses.
    """
    totals: list[ComplexArray | float] = [0.0] * source_parities(problem.system.sources)
    for unit, sources in units:
        for parity, total in enumerate(totals):
            weights = sum(projection(orders, source.angle, parity) * spectrum for source, spectrum in sources)
            totals[parity] = total + unit * weights
    return [np.asarray(total, dtype=np.complex128) for total in totals]


def projection(orders: FloatArray, angle: float, parity: int) -> FloatArray:
    """Return cos(m angle) or sin(m angle) as a column, exact at multiples of 90 degrees: symmetric systems stay symmetric."""
    turns = np.mod(orders * angle, 360.0)[:, None]
    exact = {0.0: (1.0, 0.0), 90.0: (0.0, 1.0), 180.0: (-1.0, 0.0), 270.0: (0.0, -1.0)}
    value = np.cos(np.radians(turns)) if parity == 0 else np.sin(np.radians(turns))
    for multiple, pair in exact.items():
        value = np.where(turns == multiple, pair[parity], value)
    return value
