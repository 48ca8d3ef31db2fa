"""The sources of a system as dimensionless loads on the outermost shell."""

from __future__ import annotations

from collections.abc import Iterable
from threading import Lock

import numpy as np

from coaxshell.acoustics.basis import Modes, RadialBasis
from coaxshell.acoustics.pulse_transforms import pulse_transform
from coaxshell.acoustics.sources import SourceGeometry, SurfaceLoad
from coaxshell.model.sources import Source
from coaxshell.numerics.arrays import ComplexArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.scaling import Problem
from coaxshell.solver.shared_parts import SharedParts


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
    wave : SourceGeometry
    grid : LaplaceGrid
    modes : Modes
    shared : SharedParts, optional
        Where loads are found, or left for the next one.
    """

    def __init__(self, wave: SourceGeometry, grid: LaplaceGrid, modes: Modes, shared: SharedParts | None) -> None:
        self._wave, self._grid, self._modes, self._shared = wave, grid, modes, shared
        self._lock = Lock()
        self._load: SurfaceLoad | None = None

    def __call__(self, basis: RadialBasis, nodes: slice) -> ComplexArray:
        """Return L_m at a slice of the grid's nodes, shape (orders, nodes)."""
        if self._shared is None:
            return self._made(basis, nodes)
        key = ("load", self._wave, self._grid, self._modes.key, (nodes.start, nodes.stop, nodes.step))
        load: ComplexArray = self._shared.get_or_make(key, lambda: self._made(basis, nodes))
        return load

    def _made(self, basis: RadialBasis, nodes: slice) -> ComplexArray:
        with self._lock:
            if self._load is None:
                self._load = self._wave.prepare(self._grid, self._modes)
        return self._load(basis, nodes)


class SurfaceLoads:
    """The modal loads of all sources on the outermost shell, prepared for some modes on a Laplace grid.

    A source at angle theta_s loads cos(m theta) with cos(m theta_s) and sin(m theta) with sin(m theta_s) of its own series.
    Sources that share a geometry share its modal load.
    """

    def __init__(self, problem: Problem, grid: LaplaceGrid, modes: Modes, shared: SharedParts | None = None) -> None:
        self.parities = source_parities(problem.system.sources)
        self._problem, self._modes = problem, modes
        self._groups = [
            (UnitLoad(wave, grid, modes, shared), [(source, source_spectrum(problem, source, grid.nodes)) for source in sources])
            for wave, sources in _geometries(problem).items()
        ]

    def __call__(self, basis: RadialBasis, nodes: slice) -> list[ComplexArray]:
        """Return the load of the cosine parity, and of the sine parity if any source needs it, at a slice of the grid's nodes."""
        units = ((unit(basis, nodes), [(source, x[nodes]) for source, x in sources]) for unit, sources in self._groups)
        return _superposed(self._problem, self._modes, units)


def incident_on_surface(problem: Problem, grid: LaplaceGrid, basis: RadialBasis) -> tuple[ComplexArray, ComplexArray]:
    """Return the modal pressure and slope dp/dr at r = 1 of all incident waves, each (1 or 2, M + 1, nodes).

    *basis* holds the modes at all nodes of the grid.
    """
    groups = [
        (wave.incident(grid, basis), [(source, source_spectrum(problem, source, grid.nodes)) for source in sources])
        for wave, sources in _geometries(problem).items()
    ]
    pressure, slope = (
        np.stack(_superposed(problem, basis.modes, ((parts[which], sources) for parts, sources in groups))) for which in (0, 1)
    )
    return pressure, slope


def _geometries(problem: Problem) -> dict[SourceGeometry, list[Source]]:
    """Return the sources of each geometry."""
    groups: dict[SourceGeometry, list[Source]] = {}
    for source, geometry in zip(problem.system.sources, problem.sources, strict=True):
        groups.setdefault(geometry, []).append(source)
    return groups


def _superposed(
    problem: Problem, modes: Modes, units: Iterable[tuple[ComplexArray, list[tuple[Source, ComplexArray]]]]
) -> list[ComplexArray]:
    """Return the cosines, and the sines if any source needs them, of what all make.

    *units* are what a unit pulse of each geometry makes, and the sources of that geometry with the transforms of their pulses.
    """
    totals: list[ComplexArray | float] = [0.0] * source_parities(problem.system.sources)
    for unit, sources in units:
        for parity, total in enumerate(totals):
            weights = sum(modes.projection(source.angle, parity) * spectrum for source, spectrum in sources)
            totals[parity] = total + unit * weights
    return [np.asarray(total, dtype=np.complex128) for total in totals]
