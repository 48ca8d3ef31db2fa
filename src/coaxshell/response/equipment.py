r"""Equipment that a shell feels: oscillators mounted on it one after the other, beside the shock spectrum of equipment that weighs nothing.

A mounted oscillator (mass m, natural frequency f = sqrt(k/m)/(2 pi) on a base at rest, Q = 1/(2 zeta)) pulls at the shell with
k z + c dz/dt. Near its own resonance it loads the shell most where the shell would move most, and takes from it what moves it: coupled
spectra dip there, the more so the heavier the equipment, and designs by the spectrum of the empty shell are too heavy (G. J. O'Hara,
Effect upon Shock Spectra of the Dynamic Reaction of Structures, NRL Report 5236, 1958).
"""

from __future__ import annotations

import math
from typing import Any, get_args

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber
from coaxshell.model.base import shown
from coaxshell.model.loading import SystemLike
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.oscillators import Kind
from coaxshell.numerics.progress import Progress
from coaxshell.response import arguments
from coaxshell.response.shock_spectrum import UNITS, frequencies_of, quality_of
from coaxshell.response.simulation import prepare


def mounted_spectrum(
    system: SystemLike,
    shell: int | str,
    frequency: npt.ArrayLike,
    mass: float,
    angle: float = 0.0,
    *,
    quality_factor: float = 10.0,
    kind: Kind = "pseudo-velocity",
    progress: Progress | None = None,
    **settings: Any,
) -> xr.Dataset:
    """Return the shock spectrum of equipment of some mass, mounted on a shell and felt by it, beside that of equipment without mass.

    One run for each frequency on a structure that is solved once; the largest value while the run lasts counts.

    Parameters
    ----------
    system : System, str or Path
        Of two shells or more, in two dimensions; its own absorbers act beside.
    shell : int or str
    frequency : array_like
        Natural frequencies on a base at rest, Hz.
    mass : float
        Per metre of length, kg/m.
    angle : float
        Where, degrees.
    quality_factor : float
    kind : str
        "pseudo-velocity" (m/s), "absolute-acceleration" (m/s^2) or "relative-displacement" (m).
    progress : callable, optional
    **settings
        As for :func:`coaxshell.simulate`.

    Returns
    -------
    Dataset
        ``mounted``, ``light`` (without mass: :meth:`coaxshell.Response.shock_spectrum`) and their ``ratio``, dims (frequency,).

    Raises
    ------
    InputError
        An argument is not allowed, or the system has one shell alone.
    """
    arguments.one_of("kind", kind, get_args(Kind))
    hertz, quality = frequencies_of(frequency), quality_of(quality_factor)
    if isinstance(mass, bool) or not isinstance(mass, int | float) or not 0.0 < mass < math.inf:
        raise InputError("mass", f"{shown(mass)} is not allowed", "give the mass per metre of length, above 0, in kg/m")
    if settings.get("dimensions", 2) != 2:
        raise InputError("dimensions", "3 is not known to mounted equipment", "use a PointAbsorber on one shell, or two dimensions")
    prepared = prepare(system, progress=progress, **settings)
    base, count = prepared.system, len(prepared.system.shells)
    if count < 2:
        raise InputError("shells", "equipment is mounted in a gap, and one shell has none", "give the system another shell")
    number = base.shell_index(shell)
    side = int(number == count - 1)  # of the gap that it is mounted in
    assert hertz is not None
    hertz = np.atleast_1d(hertz)
    light = prepared.simulate().shock_spectrum(number, angle, hertz, quality_factor=quality, kind=kind, during="primary").to_numpy()
    mounted = np.empty(hertz.size)
    for i, omega in enumerate(2.0 * math.pi * hertz):
        spring, damper = mass * omega**2, mass * omega / quality
        one = Absorber(
            mass=mass, linear_stiffness=spring, damping=damper, angle=angle, inner_shell=number - side, links="outer" if side else "inner"
        )
        response = prepared.simulate([*base.absorber_list, one])
        if kind == "absolute-acceleration":
            mounted[i] = float(np.abs(response.absorber_force()[-1, side]).max()) / mass
        else:
            stroke = float(np.abs(response.absorber_stroke()[-1, side]).max())
            mounted[i] = stroke if kind == "relative-displacement" else omega * stroke
        if progress is not None:
            progress((i + 1) / hertz.size, "equipment")
    attributes = {"units": UNITS[kind], "kind": kind, "quality_factor": quality, "mass": mass, "shell": number, "angle": angle}
    along = xr.Variable("frequency", hertz, {"units": "Hz", "long_name": "natural frequency on a base at rest"})
    values = {"mounted": mounted, "light": light, "ratio": mounted / np.where(light > 0.0, light, np.nan)}
    units = {"mounted": UNITS[kind], "light": UNITS[kind], "ratio": "1"}
    return xr.Dataset({name: ("frequency", one, {"units": units[name]}) for name, one in values.items()}, {"frequency": along}, attributes)
