"""The one call for a gradient: one run forwards and one backwards, whatever the number of variables."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Unpack

import numpy as np

from coaxshell._version import __version__
from coaxshell.errors import InputError
from coaxshell.model.base import shown
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.shells import Shell
from coaxshell.model.system import System
from coaxshell.numerics.identity import numerics
from coaxshell.numerics.keywords import showing
from coaxshell.numerics.progress import Progress
from coaxshell.numerics.scalars import plain
from coaxshell.response import simulate
from coaxshell.solver.dimensions import require_loops_alone
from coaxshell.solver.settings import Settings, SettingsKeywords
from coaxshell.studies.gradients.readings import has_gradient
from coaxshell.studies.gradients.sensitivity import MetricSensitivity
from coaxshell.studies.metrics import Metric, metrics_of
from coaxshell.studies.varied_fields import Field, field_of

if TYPE_CHECKING:
    import xarray as xr

POWER = 32.0
"""Power of the mean that stands for a largest magnitude, unless another one is asked for."""
LEAST_POWER, MOST_POWER = 2.0, 1000.0
_EVERY = "absorbers[*]."


@showing(SettingsKeywords, Settings)
def gradient(
    system: SystemLike,
    *,
    metric: str,
    variables: Sequence[str] | str,
    smooth: float | None = POWER,
    progress: Progress | None = None,
    **keywords: Unpack[SettingsKeywords],
) -> xr.Dataset:
    """Return a metric of a run and its gradient by any number of fields, from one run forwards and one backwards.

    It is the derivative of what :func:`simulate` computes at this resolution, to rounding, not a difference of two runs.

    Parameters
    ----------
    system : System, str or Path
        A description, the name of a preset or the path of a scenario file.
    metric : str
        As for :func:`sweep`: an RMS or a peak of stress, displacement or voltage of a shell ("inner.rms_stress", "inner.peak_stress",
        "outer.actuator_field_ratio"), or a mass or distance ("absorbers.mass", "absorbers.spacing").
    variables : list of str
        Dotted paths of what may change: "absorbers[0].mass", "absorbers[*].angle" for every absorber, "control.derivative",
        "shells[0].layers[1].thickness", "shells[0].radius", "source.distance".
    smooth : float or None
        Power p of means <abs(q)^p>^(1/p) over circle and time which stands for peaks, at least 2; None for the peak itself, whose gradient
        jumps where another angle or instant takes its place.
    duration, time_step, modes, tolerance, refinement, engine
        As those of :func:`simulate`; the duration in transits is held where radii change.
    progress : callable, optional

    Returns
    -------
    xarray.Dataset
        ``value``, ``peak`` (the exact largest magnitude beside a mean) and ``gradient`` by ``variable``, per SI unit of each (per degree of
        angles), with the coordinates ``at``, its present value, and ``per``, its unit.

    Raises
    ------
    InputError
        If the metric or a variable has no gradient, actuators saturate, or the run is not one of the spectral engine in two dimensions.
    """
    system = as_system(system)
    settings = Settings.asked(system, keywords)
    asked = _metric(metric, system)
    fields = fields_of(system, variables)
    power = power_of(smooth)
    require_gradient(system, settings)
    response = None if asked.of_design else simulate(system, settings=settings, progress=progress)
    run = MetricSensitivity(system, asked, power, response)
    return _labelled(run, asked, fields, settings)


def _metric(metric: str, system: System) -> Metric:
    if not isinstance(metric, str):
        raise InputError("metric", f"{shown(metric)} has no gradient", 'give a name such as "inner.rms_stress"')
    asked = metrics_of([metric], system)[0]
    if not has_gradient(asked):
        remedy = "use the RMS or the peak of stress, displacement or voltage of a shell, such as inner.rms_stress, or a mass"
        raise InputError("metric", f"{asked.name!r} has no gradient", remedy)
    return asked


def power_of(smooth: float | None) -> float | None:
    """Return the power of a mean that stands for a peak; InputError if it is not one."""
    power = plain(smooth)
    if power is None:
        return None
    if isinstance(power, bool) or not isinstance(power, int | float) or not LEAST_POWER <= power <= MOST_POWER:
        raise InputError("smooth", f"{shown(smooth)} is not allowed", f"give a power from {LEAST_POWER:g} to {MOST_POWER:g}, or None")
    return float(power)


def require_gradient(system: System, settings: Settings) -> None:
    """Refuse runs that have no gradient: InputError."""
    if system.sea is not None and (system.sea.surface or system.sea.bottom is not None):
        solid = [i for i, shell in enumerate(system.shells) if isinstance(shell, Shell) and shell.theory == "elastic"]
        if solid:
            remedy = f'leave the sea out, or use shells[{solid[0]}].theory = "thin"'
            raise InputError("sea", "what surface and bottom reflect is not run backwards beside elastic walls", remedy)
    if settings.engine != "spectral":
        raise InputError("engine", f"{settings.engine!r} has no gradient", 'use engine="spectral"')
    if settings.dimensions != 2:
        raise InputError("dimensions", "a run in three dimensions has no gradient yet", "use dimensions=2")
    require_loops_alone(system, "the run backwards", "leave {} out")


def fields_of(system: System, variables: Sequence[str] | str) -> list[Field]:
    """Return the fields of some paths, ``absorbers[*].NAME`` written out; InputError if there are none, or one varies by steps."""
    paths = [variables] if isinstance(variables, str) else list(variables)
    if not paths or not all(isinstance(path, str) for path in paths):
        raise InputError("variables", f"{shown(variables)} is not a list of paths", 'give at least one, as in ["absorbers[0].mass"]')
    found: list[Field] = []
    for path in paths:
        if path.strip().startswith(_EVERY):
            name = path.strip().removeprefix(_EVERY)
            if not isinstance(system.absorbers, tuple):
                listed = system.replace(absorbers=system.absorber_list)
                raise InputError(
                    f"variables.{path}", "the absorbers are a ring, described once", f"write the {len(listed.absorber_list)} out in a list"
                )
            found += [_field(system, f"absorbers[{i}].{name}") for i in range(len(system.absorbers))]
        else:
            found.append(_field(system, path))
    return found


def _field(system: System, path: str) -> Field:
    try:
        field = field_of(system, path)
    except InputError as error:
        raise InputError(f"variables.{error.where or path}", error.problem, error.remedy) from None
    if field.quantity is None or not isinstance(field.present, int | float) or not math.isfinite(field.present):
        raise InputError(f"variables.{path}", "is not a number that varies continuously", "give one such as absorbers[0].mass")
    return field


def _labelled(run: MetricSensitivity, metric: Metric, fields: list[Field], settings: Settings) -> xr.Dataset:
    import xarray as xr

    slopes = np.array([run.of(field.path) for field in fields], dtype=np.float64)
    dims, told = ("variable",), {"units": metric.units, "long_name": metric.long_name}
    coordinates = {
        "variable": xr.Variable(dims, np.array([field.path for field in fields], dtype=object)),
        "at": xr.Variable(
            dims, np.array([float(field.present) for field in fields]), {"long_name": "present value, SI; angles in degrees"}
        ),
        "per": xr.Variable(dims, np.array([field.units for field in fields], dtype=object), {"long_name": "unit of the variable"}),
    }
    data = {
        "value": xr.Variable((), run.value, told),
        "peak": xr.Variable((), run.peak, {**told, "long_name": f"{metric.long_name}, exact"}),
        "gradient": xr.Variable(dims, slopes, {"units": f"{metric.units} per unit of the variable", "long_name": f"d({metric.name})"}),
    }
    attributes = {
        "title": f"gradient of {metric.name} of {run.system.name or 'a system'}",
        "source": f"coaxshell {__version__}",
        "numerics": numerics(),
        "metric": metric.name,
        "units_of_gradient": [f"{metric.units}/({field.units})" for field in fields],
        "modes": settings.modes,
    }
    return xr.Dataset(data, coordinates, attributes)
