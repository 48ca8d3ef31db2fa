"""What a three-dimensional run returns: at each of its stations the modal histories of a section, with what happens along the axis."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.solver.axial.sampling import AxialSampling
from coaxshell.solver.scaling import Problem
from coaxshell.solver.settings import Settings
from coaxshell.solver.solution import AxialMotion, Estimates, ModalSolution
from coaxshell.structure.shell_model import FIELDS


class StationSpectra(NamedTuple):
    """Transforms of W and V at the stations of a run, (stations, shells, parities, M + 1, nodes), on its grid."""

    grid: LaplaceGrid
    normal: ComplexArray
    tangential: ComplexArray


@dataclass(frozen=True)
class SpatialSolution:
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
        Of :data:`coaxshell.structure.shell_model.FIELDS` and, "potential 0", ..., of the piezoelectric layers' open-circuit voltages; those
        that are not there are zero, as u at stations in the source's plane.
    estimates : Estimates
        Relative to the answer in the norm over the surface of all of an axial period.
    warnings : tuple of str
    timings : dict
    spectra : StationSpectra or None
        Transforms of the motion at the stations, as long as the run is in this process; not saved.
    """

    problem: Problem
    settings: Settings
    time: FloatArray
    sampling: AxialSampling
    fields: dict[str, FloatArray]
    estimates: Estimates
    warnings: tuple[str, ...] = ()
    timings: dict[str, float] = field(default_factory=dict)
    spectra: StationSpectra | None = field(default=None, compare=False, repr=False)

    @property
    def stations(self) -> FloatArray:
        """z of the stations, m, shape (stations,)."""
        return np.array(self.settings.stations)

    def at(self, station: int) -> ModalSolution:
        """Return what a station by its number does as if it were a run of its own."""
        found = self.fields
        zero = np.zeros(found["w"].shape[1:])
        of = {name: found[name][station] if name in found else zero for name in FIELDS}
        layers = sum(name.startswith("potential") for name in found)
        potentials = tuple(found[f"potential {number}"][station] for number in range(layers))
        motion = AxialMotion(of["u"], of["w_z"], of["w_zz"], of["v_z"], of["u_z"], potentials)
        return ModalSolution(
            self.problem, self.settings, self.time, of["w"], of["v"], self.estimates, self.warnings, self.timings, along=motion
        )
