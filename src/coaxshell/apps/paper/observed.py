"""What is kept of a run: histories at head and tail, the stress over the circle, peaks; small enough for hundreds of runs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.apps.paper.cases import head_of
from coaxshell.errors import InputError
from coaxshell.model import Shell
from coaxshell.numerics.arrays import FloatArray

if TYPE_CHECKING:
    from coaxshell.model import System
    from coaxshell.response import Response
    from coaxshell.response.peaks import Peak
    from coaxshell.response.summary import ShellSummary


SHELLS = ("inner", "outer")
SIDES = {"head": 0.0, "tail": 180.0}
"""Degrees from the head."""


@dataclass(frozen=True)
class StressPeaks:
    """All that is read of a shell where many runs are compared by their peaks, each as in :class:`coaxshell.response.summary.ShellSummary`.

    Attributes
    ----------
    stress_head, stress_tail, stress : Peak
        Design stress of the core at the head, at the tail and anywhere, Pa.
    stress_rms : float
        Its root mean square over the surface and the window, Pa.
    """

    stress_head: Peak
    stress_tail: Peak
    stress: Peak
    stress_rms: float


@dataclass(frozen=True)
class Observed:
    """What is kept of one run.

    Attributes
    ----------
    time : ndarray, shape (T,)
        Transits.
    transit_time : float
        Seconds in a transit.
    modes : int
        Highest order.
    shells : mapping of str to ShellSummary or StressPeaks
        Peaks and root mean squares of the "inner" and the "outer" shell, those that are elastic; of their stress alone if only peaks
        were kept.
    histories : mapping of (quantity, shell, side) to ndarray, shape (T,)
        "stress" (Pa) and "displacement" (m, inward) at "head" and "tail"; empty if only peaks were kept.
    circle : mapping of str to ndarray, shape (T,)
        Root mean square of the stress over a shell's surface at every instant, Pa; in three dimensions over its circle at the station.
    absorber : ndarray, shape (3, T)
        Displacement of the first absorber's mass, m, and its forces on the inner and the outer shell, N/m; (3, 0) without absorbers.
    warnings : tuple of str
    """

    time: FloatArray
    transit_time: float
    modes: int
    shells: Mapping[str, ShellSummary | StressPeaks]
    histories: Mapping[tuple[str, str, str], FloatArray] = field(default_factory=dict)
    circle: Mapping[str, FloatArray] = field(default_factory=dict)
    absorber: FloatArray = field(default_factory=lambda: np.empty((3, 0)))
    warnings: tuple[str, ...] = ()

    @property
    def summaries(self) -> dict[str, ShellSummary]:
        """The whole summaries among those of the shells: none if only peaks were kept."""
        return {name: found for name, found in self.shells.items() if not isinstance(found, StressPeaks)}

    def at(self, quantity: str, shell: str, side: str) -> FloatArray:
        """Return a history at a point; InputError if the shell is rigid and has none."""
        try:
            return self.histories[quantity, shell, side]
        except KeyError:
            raise InputError("shells", f"the {shell} shell is rigid and has no {quantity}", "give an elastic one") from None

    def stress(self, shell: str, side: str) -> FloatArray:
        """Return the hoop stress at a point, Pa, shape (T,)."""
        return self.at("stress", shell, side)

    def displacement(self, shell: str, side: str) -> FloatArray:
        """Return the inward displacement of a point, m, shape (T,)."""
        return self.at("displacement", shell, side)


def observe(response: Response, *, peaks_only: bool = False) -> Observed:
    """Return what is kept of a response, of one in three dimensions at its first station; with *peaks_only* those of the stress alone."""
    system = response.system
    names = {name: system.shell_index(name) for name in SHELLS if isinstance(system.shells[system.shell_index(name)], Shell)}
    if peaks_only:
        return _peaks(response, names)
    summary: Any = response.summary(segment="point")  # the paper's voltages are those at points
    if response.stations is not None:
        summary = summary.at(response.stations[0])
    elastic = system.shell_indices()
    return Observed(
        time=response.time,
        transit_time=float(summary.transit_time),
        modes=response.modes,
        shells={name: summary.shells[elastic.index(index)] for name, index in names.items()},
        histories=_histories(response, tuple(names)),
        circle={name: _over_circle(response, name) for name in names},
        absorber=_absorber(response, system),
        warnings=tuple(response.warnings),
    )


def _peaks(response: Response, shells: Mapping[str, int]) -> Observed:
    """Return the peaks of the stress of some shells: a tenth of the time that a whole summary takes."""
    from coaxshell.response.quantities import QUANTITIES
    from coaxshell.response.summary import largest_magnitudes

    motion = response.motions[0]
    whole = slice(0, response.time.size)
    peaks: dict[str, dict[str, Any]] = {
        name: largest_magnitudes(QUANTITIES["stress"], motion, index, whole) for name, index in shells.items()
    }
    return Observed(
        time=response.time,
        transit_time=float(motion.solution.problem.scales.time),
        modes=response.modes,
        shells={name: StressPeaks(**found) for name, found in peaks.items()},
        warnings=tuple(response.warnings),
    )


def _histories(response: Response, shells: tuple[str, ...]) -> dict[tuple[str, str, str], FloatArray]:
    head = head_of(response.system)
    found: dict[tuple[str, str, str], FloatArray] = {}
    for shell in shells:
        for quantity in ("stress", "displacement"):
            values = getattr(response, quantity)(shell, angle=[head + turn for turn in SIDES.values()], **_where(response))
            for k, side in enumerate(SIDES):
                found[quantity, shell, side] = np.asarray(values, dtype=np.float64)[:, k].copy()
    return found


def _over_circle(response: Response, shell: str) -> FloatArray:
    from coaxshell.response.synthesis import mean_square

    return np.sqrt(mean_square(np.asarray(response.modal(shell, "stress", **_where(response)), dtype=np.float64)))


def _where(response: Response) -> dict[str, float]:
    """Return the station that is read of a run in three dimensions, nothing in two."""
    return {} if response.stations is None else {"station": float(response.stations[0])}


def _absorber(response: Response, system: System) -> FloatArray:
    if not system.absorber_list:
        return np.empty((3, 0))
    force, moved = response.absorber_force(), response.absorber_displacement()
    if "station" in force.dims:
        force, moved = force.isel(station=0), moved.isel(station=0)
    return np.vstack([np.asarray(moved, dtype=np.float64)[:1], np.asarray(force, dtype=np.float64)[0]])
