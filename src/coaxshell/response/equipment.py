r"""Equipment that a shell feels: oscillators mounted on it one after the other, beside the shock spectrum of equipment that weighs nothing.

A mounted oscillator (mass m, natural frequency f = sqrt(k/m)/(2 pi) on a base at rest, Q = 1/(2 zeta)) pulls at the shell with
k z + c dz/dt. Near its own resonance it loads the shell most where the shell would move most, and takes from it what moves it: coupled
spectra dip there, the more so the heavier the equipment, and designs by the spectrum of the empty shell are too heavy (G. J. O'Hara,
Effect upon Shock Spectra of the Dynamic Reaction of Structures, NRL Report 5236, 1958).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber, PointAbsorber
from coaxshell.model.base import shown
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.oscillators import Kind
from coaxshell.numerics.progress import Progress
from coaxshell.response import arguments
from coaxshell.response.response import Response
from coaxshell.response.shock_spectrum import UNITS, frequencies_of, quality_of
from coaxshell.response.simulation import prepare, simulate
from coaxshell.solver.settings import Settings


def mounted_spectrum(
    system: SystemLike,
    shell: int | str,
    frequency: npt.ArrayLike,
    mass: float,
    angle: float = 0.0,
    *,
    z: float = 0.0,
    quality_factor: float = 10.0,
    kind: Kind = "pseudo-velocity",
    progress: Progress | None = None,
    **settings: Any,
) -> xr.Dataset:
    """Return the shock spectrum of equipment of some mass, mounted on a shell and felt by it, beside that of equipment without mass.

    One run for each frequency, in two dimensions on a structure that is solved once; the largest value while the run lasts counts.

    Parameters
    ----------
    system : System, str or Path
        Its own absorbers act beside.
    shell : int or str
    frequency : array_like
        Natural frequencies on a base at rest, Hz.
    mass : float
        Per metre of length, kg/m; in three dimensions of equipment at a point, kg.
    angle : float
        Where, degrees.
    z : float
        Where along the axis, m, in three dimensions.
    quality_factor : float
    kind : str
        "pseudo-velocity" (m/s), "absolute-acceleration" (m/s^2) or "relative-displacement" (m).
    progress : callable, optional
    **settings
        As for :func:`coaxshell.simulate`; ``stations`` is z alone.

    Returns
    -------
    Dataset
        ``mounted``, ``light`` (without mass: :meth:`coaxshell.Response.shock_spectrum`) and their ``ratio``, dims (frequency,).

    Raises
    ------
    InputError
        An argument is not allowed.
    """
    arguments.one_of("kind", kind, get_args(Kind))
    hertz, quality = frequencies_of(frequency), quality_of(quality_factor)
    assert hertz is not None
    hertz = np.atleast_1d(hertz)
    place = _Place(as_system(system), shell, float(arguments.angles(angle)), _position(z), settings)
    _require_mass(mass)
    runs = place.runs(progress)
    light = runs(None).shock_spectrum(place.number, place.angle, hertz, quality_factor=quality, kind=kind, during="primary")
    mounted = np.empty(hertz.size)
    for i, one in enumerate(hertz):
        oscillator = _Oscillator(mass, 2.0 * math.pi * one, quality)
        mounted[i] = oscillator.largest(runs(place.mounting(oscillator)), place, kind)
        if progress is not None:
            progress((i + 1) / hertz.size, "equipment")
    unloaded = light.to_numpy().reshape(hertz.size)
    attributes = {"units": UNITS[kind], "kind": kind, "quality_factor": quality, "mass": mass, "shell": place.number, "angle": angle}
    attributes |= {"z": place.z} if place.spatial else {}
    along = xr.Variable("frequency", hertz, {"units": "Hz", "long_name": "natural frequency on a base at rest"})
    values = {"mounted": mounted, "light": unloaded, "ratio": mounted / np.where(unloaded > 0.0, unloaded, np.nan)}
    units = {"mounted": UNITS[kind], "light": UNITS[kind], "ratio": "1"}
    return xr.Dataset({name: ("frequency", one, {"units": units[name]}) for name, one in values.items()}, {"frequency": along}, attributes)


def largest_of_mounted(response: Response, shell: int, hertz: float, mass: float, angle: float, quality: float, kind: Kind) -> float:
    """Return what one piece of equipment would feel in the system and at the settings of a run in two dimensions, SI: a run of its own."""
    place = _Place(response.system, shell, angle, 0.0, {"settings": response.settings})
    oscillator = _Oscillator(mass, 2.0 * math.pi * hertz, quality)
    return oscillator.largest(place.runs(None)(place.mounting(oscillator)), place, kind)


class _Oscillator(NamedTuple):
    """Equipment: mass (kg/m or kg), natural frequency (rad/s) and Q."""

    mass: float
    omega: float
    quality: float

    def largest(self, response: Response, place: _Place, kind: Kind) -> float:
        """Return the largest value of its motion relative to the shell, times omega, or of its acceleration, in a run."""
        force = response.absorber_force().to_numpy()[-1, place.side]
        if kind == "absolute-acceleration":
            return float(np.abs(force).max()) / self.mass
        times = np.asarray(response.time_seconds)
        stroke = float(np.abs(self._stroke(force, float(times[1] - times[0]))).max())
        return stroke if kind == "relative-displacement" else self.omega * stroke

    def _stroke(self, force: FloatArray, step: float) -> FloatArray:
        """Return z of k z + c z' = f, z(0) = 0, for a force linear between instants: (f - c f'/k)/k and what decays."""
        from scipy.signal import lfilter  # takes time to import

        spring, damper = self.mass * self.omega**2, self.mass * self.omega / self.quality
        kept = math.exp(-step * spring / damper)
        lag = damper / spring * np.diff(force) / step
        begin, end = (force[:-1] - lag) / spring, (force[1:] - lag) / spring
        return np.asarray(lfilter([1.0], [1.0, -kept], end - kept * begin))


class _Place:
    """Where equipment is mounted, and the runs of the system that it is mounted in."""

    def __init__(self, system: System, shell: int | str, angle: float, z: float, settings: dict[str, Any]) -> None:
        self.system, self.angle, self.z, self._settings = system, angle, z, dict(settings)
        asked = Settings.asked(system, {**settings, "stations": (z,)} if settings.get("dimensions", 2) == 3 else settings)
        self.spatial = asked.dimensions == 3
        count = len(system.shells)
        self.number = system.shell_index(shell)
        self.side = int(self.number == count - 1)  # of the gap that it is mounted in, or of the outer shell inside the only one
        if self.spatial:
            self._settings["stations"] = (z,)
        elif z != 0.0:
            raise InputError("z", f"{z:g} m has no meaning in two dimensions", "leave it out, or use dimensions=3")

    def mounting(self, one: _Oscillator) -> Absorber | PointAbsorber:
        """Return the equipment as an absorber that holds this shell alone."""
        common: dict[str, Any] = {
            "mass": one.mass,
            "linear_stiffness": one.mass * one.omega**2,
            "damping": one.mass * one.omega / one.quality,
            "angle": self.angle,
            "inner_shell": max(self.number - self.side, 0),
            "links": "outer" if self.side else "inner",
        }
        return PointAbsorber(**common, z=self.z) if self.spatial else Absorber(**common)

    def runs(self, progress: Progress | None) -> Callable[[Absorber | PointAbsorber | None], Response]:
        """Return what runs the system with one more absorber, or as it is; in two dimensions its structure is solved once."""
        if self.spatial:
            own = self.system.point_absorbers or self.system.absorber_list

            def spatial(more: Absorber | PointAbsorber | None) -> Response:
                system = self.system if more is None else self.system.replace(absorbers=[*own, more])
                return simulate(system, progress=progress, **self._settings)

            return spatial
        prepared = prepare(self.system, progress=progress, **self._settings)

        def plane(more: Absorber | PointAbsorber | None) -> Response:
            return prepared.simulate(None if more is None else [*self.system.absorber_list, more])

        return plane


def _require_mass(mass: object) -> None:
    if isinstance(mass, bool) or not isinstance(mass, int | float) or not 0.0 < mass < math.inf:
        raise InputError("mass", f"{shown(mass)} is not allowed", "give the mass per metre of length, above 0, in kg/m")


def _position(z: object) -> float:
    if isinstance(z, bool) or not isinstance(z, int | float) or not math.isfinite(z):
        raise InputError("z", f"{shown(z)} is not allowed", "give a position along the axis in m")
    return float(z)
