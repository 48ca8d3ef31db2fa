"""What a three-dimensional run returns: at each of its stations the modal histories of a section, with what happens along the axis."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.axial.forces import WallForces
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.electrode_patterns import segments_of
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import AxialMotion, Estimates, JudgedLate, ModalSolution, is_whole
from coaxshell.solver.voltage_response import controlled
from coaxshell.structure.control_law import ControlGains
from coaxshell.structure.shell_model import FIELDS, SOLID_STRESSES

LINES = ("line_displacement", "line_force")
"""Histories of line absorbers at the stations."""


class StationSpectra(NamedTuple):
    """Transforms of W and V at the stations of a run, (stations, shells, parities, M + 1, nodes), on its grid."""

    grid: LaplaceGrid
    normal: ComplexArray
    tangential: ComplexArray


@dataclass(frozen=True)
class SpatialSolution(JudgedLate):
    """Modal histories at the stations of a three-dimensional run; all arrays dimensionless (lengths in a, times in a/c_e).

    Attributes
    ----------
    problem : Problem
    settings : Settings
        With ``modes``, ``axial_modes`` and ``axial_period`` resolved to numbers.
    time : ndarray, shape (T,)
    sampling : AxialSampling
        The axial wavenumbers that were added up.
    fields : dict of str to ndarray, shape (stations, shells, parities, M + 1, T)
        Of :data:`coaxshell.structure.shell_model.FIELDS` and, "potential 0", ..., of the piezoelectric layers' open-circuit voltages, after
        which of walls under control by electrodes or a law other than PD come what the law reads and what it gives; those that are not
        there are zero, as u at stations in the source's plane. "potential_rate 0", ... are the derivatives of these voltages by time, where
        a law is a sum of both.
    estimates : Estimates
        Relative to the answer in the norm over the surface of all of an axial period.
    warnings : tuple of str
        Both may be made when first read (:meth:`judge_when_read`).
    timings : dict
    absorber_displacement : ndarray, shape (absorbers, T), or None
        q of the point absorbers.
    absorber_force : ndarray, shape (absorbers, 2, T), or None
        Forces on the inner [0] and outer [1] of the shells they link, positive inward, in units of rho_e c_e^2 a^2.
    line_displacement : ndarray, shape (stations, absorbers, T), or None
        q of the line absorbers.
    line_force : ndarray, shape (stations, absorbers, 2, T), or None
        Forces per length on the inner [0] and outer [1] of the shells they link, positive inward, in units of rho_e c_e^2 a.
    spectra : StationSpectra or None
        Transforms of the motion at the stations, where they are no more than half a gigabyte. A copy sent to another process (pickle)
        has none, as after :meth:`coaxshell.response.spatial.SpatialResponse.without_transforms`.
    forces : list of WallForces
        Transforms of the forces of the absorbers, one or none: those of the run, or, of one from a file, once they are solved again.
        Shared by the solutions of one run.
    """

    problem: Problem
    settings: Settings
    time: FloatArray
    sampling: AxialSampling
    fields: dict[str, FloatArray]
    estimates: Estimates
    warnings: tuple[str, ...] = field(default_factory=tuple)
    timings: dict[str, float] = field(default_factory=dict)
    absorber_displacement: FloatArray | None = None
    absorber_force: FloatArray | None = None
    line_displacement: FloatArray | None = None
    line_force: FloatArray | None = None
    spectra: StationSpectra | None = field(default=None, compare=False, repr=False)
    forces: list[WallForces] = field(default_factory=list, compare=False, repr=False)

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy takes over: all but the transforms, the largest part of it."""
        return {**self._judged(), "spectra": None, "forces": []}

    @property
    def stations(self) -> FloatArray:
        """z of the stations, m, shape (stations,)."""
        return np.array(self.settings.stations)

    @property
    def whole(self) -> bool:
        """Whether the histories have every instant of the run."""
        return is_whole(self.time, self.settings)

    def some(self, stations: Sequence[int]) -> SpatialSolution:
        """Return the solution of the run with some of its stations alone, by number."""
        chosen = list(stations)
        settings = replace(self.settings, stations=tuple(self.settings.stations[i] for i in chosen))
        spectra = self.spectra
        if spectra is not None:
            spectra = StationSpectra(spectra.grid, spectra.normal[chosen], spectra.tangential[chosen])
        fields = {name: values[chosen] for name, values in self.fields.items()}
        q, f = (None if x is None else x[chosen] for x in (self.line_displacement, self.line_force))
        return replace(self, settings=settings, fields=fields, spectra=spectra, line_displacement=q, line_force=f)

    def at(self, station: int) -> ModalSolution:
        """Return what a station by its number does as if it were a run of its own."""
        found = self.fields
        zero = np.zeros(found["w"].shape[1:])
        of = {name: found[name][station] if name in found else zero for name in FIELDS}
        layers = range(sum(name.startswith("potential ") for name in found))
        potentials, rates = (
            tuple(found[f"{name} {number}"][station] for number in layers if f"{name} {number}" in found)
            for name in ("potential", "potential_rate")
        )
        given = control_voltage(self.problem, potentials, rates)
        stresses = {name: of[name] for name in SOLID_STRESSES if self.problem.two_faced}
        belts, z = self.problem.belts, self.stations[station] / self.problem.scales.length
        dead = () if belts is None else belts.dead_at(float(z))
        motion = AxialMotion(of["u"], of["w_z"], of["w_zz"], of["v_z"], of["u_z"], potentials, rates, stresses, dead)
        judged = "estimates" in vars(self)
        one = ModalSolution(
            self.problem,
            self.settings,
            self.time,
            of["w"],
            of["v"],
            self.estimates if judged else Estimates.unknown(len(self.problem.shells)),
            self.warnings if judged else (),
            self.timings,
            control_voltage=given,
            along=motion,
            segment_voltage=None if given is None else on_segments(self.problem, given, motion.dead),
        )
        if not judged:
            one.judge_as(self)
        return one


def on_segments(problem: Problem, given: FloatArray, dead: tuple[int, ...] = ()) -> FloatArray | None:
    """Return the voltages of the segments of all shells, (shells, N, T), from those in orders, 0 of *dead* ones; None of whole ones."""
    cut = segments_of(problem, controlled(problem))
    if not cut:
        return None
    found = np.zeros((len(problem.shells), cut[0].count, given.shape[-1]))
    for segments, i in zip(cut, controlled(problem), strict=True):
        found[i] = segments.values(given[i])
        found[i, [*segments.dead, *dead]] = 0.0
    return found


def control_voltage(problem: Problem, potentials: Sequence[FloatArray], rates: Sequence[FloatArray]) -> FloatArray | None:
    """Return the voltage that the law of each shell asks for, V, (shells, ...), 0 of shells without; None where no wall shows it.

    Parameters
    ----------
    problem : Problem
    potentials, rates : sequence of ndarray, shape (shells, ...)
        The voltages that walls show, and their derivatives by time where some law is a sum of both.
    """
    if not any(wall.shows_control for wall in problem.shells):
        return None
    found = np.zeros_like(potentials[0])
    for i, wall in enumerate(problem.shells):
        if wall.shows_control:
            found[i] = potentials[wall.shown_potentials - 1][i]
        elif isinstance(wall.gains, ControlGains):
            number = wall.layer_number("sensor")
            if number is not None:
                found[i] = wall.gains.proportional * potentials[number][i] + wall.gains.derivative * rates[number][i]
    return found
