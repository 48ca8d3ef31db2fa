"""Named metrics: what a study asks of every case, as ``inner.peak_stress``, ``interior.rms_pressure`` or a function of the user's.

A metric named in text is "PLACE.QUANTITY": a shell ("inner", "outer", "middle" of three, "shells[1]"; "shell" where there is one), a
fluid ("interior", "gap", "exterior", "fluids[1]"), "absorbers" or "system", and one of the quantities in the tables below, or what is read
at a frequency: the value of a shock spectrum, "PLACE.pseudo_velocity@500 Hz", of equipment that the shell feels, "PLACE.mounted_...", or
of an answer without time, "system.target_strength@500 Hz". A function of the user's takes a Response and returns a number; in a study file
it is written "file.py:function".
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from coaxshell.errors import InputError
from coaxshell.limits import EXPRESSION
from coaxshell.model.fluids import Vacuum
from coaxshell.model.layers import Shell
from coaxshell.model.naming import suggestion
from coaxshell.model.paths import parts
from coaxshell.model.places import region_name, region_number, region_place, shell_number, shell_phrase, shell_place, shell_words
from coaxshell.model.system import System
from coaxshell.response import Response
from coaxshell.response.quantities import Where, shell_metrics
from coaxshell.response.spatial_summary import SpatialSummary
from coaxshell.response.summary import Summary
from coaxshell.studies.reading import DesignReading, MetricSource, charges_of
from coaxshell.studies.spectrum_metrics import NAMES as SPECTRA
from coaxshell.studies.spectrum_metrics import MountedMetric, SpectrumMetric
from coaxshell.studies.steady_metrics import OF_SHELLS, OF_SYSTEMS, SteadyMetric, places_of
from coaxshell.studies.user_functions import UserCode, UserFunction, from_callable, from_text

MetricLike = str | Callable[[Response], float]
Metrics = Sequence[MetricLike] | Mapping[str, MetricLike]
ANYWHERE = UserCode()

_DIGITS = re.compile(r"[0-9]{1,9}")


class MetricEntry(NamedTuple):
    """A number of a reading: its unit, its meaning, the role of the layer that it needs ("" for none)."""

    units: str
    long_name: str
    needs: str = ""


_WHERE: dict[Where, str] = {"anywhere": "largest {} anywhere", "head": "largest {} at the head", "tail": "largest {} at the tail"}
_RMS = "RMS {} over surface and time"
_MORE_OF_A_SHELL = {
    "peak_actuator_voltage": MetricEntry("V", "largest actuator voltage asked for at any point", "actuator"),
    "peak_actuator_field": MetricEntry("V/m", "largest actuator field asked for at any point", "actuator"),
    "actuator_field_ratio": MetricEntry("1", "largest actuator field asked for at any point, over its limit", "actuator"),
    "segment_sensor_voltage": MetricEntry("V", "largest sensor voltage, mean over a segment", "sensor"),
    "segment_actuator_voltage": MetricEntry("V", "largest actuator voltage asked for, mean over a segment", "actuator"),
    "segment_actuator_field": MetricEntry("V/m", "largest actuator field asked for, mean over a segment", "actuator"),
    "segment_field_ratio": MetricEntry("1", "largest actuator field asked for, mean over a segment, over its limit", "actuator"),
    "strength_margin": MetricEntry("1", "least strength of a layer over its largest stress"),
    "stress_truncation": MetricEntry("1", "estimated share of the orders left out of the stress"),
    "mass": MetricEntry("kg/m", "mass"),
}


def shell_quantities(dimensions: int = 2) -> dict[str, MetricEntry]:
    """Return what can be asked of a shell: the quantities of the table at their places, and what is derived from voltages and layers."""
    found = {
        name: MetricEntry(quantity.unit, _WHERE.get(where, _RMS).format(quantity.noun), quantity.roles[-1] if quantity.roles else "")
        for name, (quantity, where) in shell_metrics(dimensions).items()
    }
    return {**found, **_MORE_OF_A_SHELL}


FLUID_QUANTITIES = {"rms_pressure": MetricEntry("Pa", "RMS pressure over area and time")}
ABSORBER_QUANTITIES = {
    "absorber_count": MetricEntry("1", "number of absorbers"),
    "absorber_mass": MetricEntry("kg/m", "mass added by the absorbers"),
    "absorber_spacing": MetricEntry("m", "smallest distance between neighbouring absorbers"),
    "absorber_displacement": MetricEntry("m", "largest displacement of an absorber's mass"),
    "absorber_force": MetricEntry("N/m", "largest force of an absorber on a shell"),
    "dissipated_energy": MetricEntry("J/m", "energy dissipated in the absorbers' dampers"),
}
SYSTEM_QUANTITIES = {
    "total_mass": MetricEntry("kg/m", "mass of all shells and absorbers"),
    "time_window_error": MetricEntry("1", "estimated error of the inverse transform"),
    "hull_shock_factor": MetricEntry("kg^(1/2)/m", "largest hull shock factor of the charges"),
    "keel_shock_factor": MetricEntry("kg^(1/2)/m", "largest keel shock factor of the charges"),
}
_OF_CHARGES = ("hull_shock_factor", "keel_shock_factor")
"""What systems whose source is an explosion have."""
WITHOUT_SHELL = {
    "absorbers": {
        "count": "absorber_count",
        "mass": "absorber_mass",
        "spacing": "absorber_spacing",
        "peak_displacement": "absorber_displacement",
        "peak_force": "absorber_force",
        "dissipated_energy": "dissipated_energy",
    },
    "system": {"mass": "total_mass", **{name: name for name in ("time_window_error", *_OF_CHARGES)}},
}
"""Quantities of the absorbers and of the system, by their names in text, and the properties of a reading that give them."""
_OF_POINTS = {"absorber_mass": "kg", "absorber_force": "N"}
"""Units of what point absorbers have otherwise than lines."""
_NOT_OF_POINTS = {
    "dissipated_energy": ("is not read of point absorbers", "leave it out, or use a function of the response"),
    "total_mass": ("masses at points and masses per metre do not add up", "use absorbers.mass (kg) and the mass of each shell (kg/m)"),
}
_PLANE_ALONE = (*FLUID_QUANTITIES, "dissipated_energy")
"""What is read in two dimensions alone."""


@dataclass(frozen=True)
class Metric:
    """One metric of a study, ready to be sent to another process.

    Attributes
    ----------
    name : str
        As the user wrote it, or the name given to a function.
    units, long_name : str
    place : str, int
        What it is read from: the number of a shell, a fluid, "absorbers", "system"; "" for a function of the user's.
    quantity : str
        Name of what :meth:`MetricSource.number` gives.
    function : UserFunction, optional
    """

    name: str
    units: str
    long_name: str
    place: str | int = ""
    quantity: str = ""
    function: UserFunction | None = None

    @property
    def of_design(self) -> bool:
        """Whether it is read from the system alone, without a run."""
        return self.function is None and hasattr(DesignReading, self.quantity)

    def __call__(self, reading: DesignReading) -> float:
        """Return its value; InputError if a function of the user's fails or gives no finite number."""
        if self.function is not None:
            assert isinstance(reading, MetricSource)
            return self.function(reading.response, self.name)
        value = reading.number(self.quantity, self.place)
        if not math.isfinite(value):
            raise InputError(self.name, f"{value!r} is not finite", "try a smaller time step")
        return value

    @property
    def identity(self) -> str:
        """What a hash should cover: two metrics of one identity give the same number."""
        return self.function.identity if self.function is not None else f"{self.place}.{self.quantity}"


def metrics_of(asked: Metrics, system: System, code: UserCode = ANYWHERE) -> tuple[Metric, ...]:
    """Return the metrics of a study, checked against its base system.

    Parameters
    ----------
    asked : sequence, or mapping of name to metric
        Texts, and functions of a Response.
    system : System
    code : UserCode
        Where the files of "file.py:function" lie; the current folder unless given.

    Raises
    ------
    InputError
        None given, one unknown (with the nearest that exists), one that this system does not have, or two of one name.
    """
    if isinstance(asked, str) or callable(asked):
        asked = [asked]
    named: list[tuple[str | None, Any]] = list(asked.items()) if isinstance(asked, Mapping) else [(None, item) for item in asked]
    if not named:
        raise InputError("metrics", "the list is empty", "name at least one, such as inner.peak_stress")
    found: dict[str, Metric] = {}
    for number, (name, item) in enumerate(named):
        where = f"metrics[{number}]" if name is None else f"metrics.{name}"
        metric = _metric(item, name, system, where, code)
        if metric.name in found:
            raise InputError(where, f"{metric.name!r} is asked for twice", "give each metric once, or names of their own")
        found[metric.name] = metric
    return tuple(found.values())


def require_readable(metrics: Sequence[Metric], dimensions: int) -> None:
    """Raise InputError for a metric that is not read from runs of so many dimensions."""
    for metric in metrics:
        if metric.function is not None:
            continue
        if metric.quantity in shell_metrics() and metric.quantity not in shell_metrics(dimensions):
            raise InputError(metric.name, "is read at stations of a run in three dimensions", "use dimensions=3, or leave it out")
        at_frequency = SteadyMetric.read(metric.quantity) or MountedMetric.read(metric.quantity)
        if dimensions == 3 and (metric.quantity in _PLANE_ALONE or at_frequency is not None):
            raise InputError(metric.name, "is not read in three dimensions", "use dimensions=2, or a function of the response")


def without_shell(system: System) -> dict[str, dict[str, MetricEntry]]:
    """Return what can be asked of the absorbers and of a system, by place and name; units of point absorbers are those of points."""
    entries = {**ABSORBER_QUANTITIES, **SYSTEM_QUANTITIES}
    if not charges_of(system):
        entries = {key: entry for key, entry in entries.items() if key not in _OF_CHARGES}
    if system.point_absorbers:
        entries = {key: entry for key, entry in entries.items() if key not in _NOT_OF_POINTS}
        entries |= {key: entries[key]._replace(units=units) for key, units in _OF_POINTS.items()}
    return {place: {name: entries[key] for name, key in names.items() if key in entries} for place, names in WITHOUT_SHELL.items()}


def metric_names(system: System, dimensions: int = 2) -> list[str]:
    """Return the names of all metrics that a system has in so many dimensions."""
    count = len(system.shells)
    names: list[str] = []
    for i, wall in enumerate(system.shells):
        place = shell_place(i, count)
        names += [
            f"{place}.{key}"
            for key, entry in shell_quantities(dimensions).items()
            if _lacks(wall, entry) is None and _has_margin(wall, key)
        ]
    if dimensions == 2:
        names += [f"{region_place(i, count)}.rms_pressure" for i, fluid in enumerate(system.fluids) if not isinstance(fluid, Vacuum)]
    more = [(place, name) for place, names_there in without_shell(system).items() for name in names_there]
    return names + [f"{place}.{name}" for place, name in more if dimensions == 2 or WITHOUT_SHELL[place][name] not in _PLANE_ALONE]


_OF_SUMMARY = {
    "sensor_voltage": "segment_sensor_voltage",
    "actuator_voltage": "segment_actuator_voltage",
    "stress_truncation": "stress_truncation",
}
"""What a summary of a shell shows, by its key, that is a metric of another name."""


def summary_metrics(summary: Summary | SpatialSummary, system: System) -> dict[str, float]:
    """Return the metrics that a summary of a whole run holds, by their names, as :class:`MetricSource` would read them; SI."""
    count = len(system.shells)
    plain = summary.to_dict()
    shells = plain["largest"] if "largest" in plain else plain["shells"]
    keys = {
        name: quantity.key(where) for name, (quantity, where) in shell_metrics().items() if quantity.gain is None or not quantity.largest
    }
    found: dict[str, float] = {}
    for shell in shells:
        number = shell_number(shell["name"], count)
        assert number is not None  # the summary has it from the same words
        values = {name: shell.get(key) for name, key in keys.items()} | {name: shell.get(key) for key, name in _OF_SUMMARY.items()}
        values["strength_margin"] = (shell.get("wall_stress") or {}).get("margin")
        numbers = {name: value["value"] if isinstance(value, Mapping) else value for name, value in values.items()}
        found |= {f"{shell_place(number, count)}.{name}": value for name, value in numbers.items() if value is not None}
    absorbers = {"absorbers.peak_displacement": plain["absorber_displacement"], "absorbers.peak_force": plain["absorber_force"]}
    return found | {name: value for name, value in absorbers.items() if value is not None}


def _metric(asked: Any, name: str | None, system: System, where: str, code: UserCode) -> Metric:
    if isinstance(asked, Metric):
        return asked
    if callable(asked):
        return _of_function(from_callable(asked, where, name), name)
    if not isinstance(asked, str):
        raise InputError(where, f"{asked!r} is not a metric", "give a name such as inner.peak_stress, or a function of a Response")
    EXPRESSION.check(len(asked), where)
    text = asked.strip()
    if ":" in text:
        return _of_function(from_text(text, where, code), name)
    text, at, frequency = text.partition("@")
    label = name or (f"{text}@{frequency}" if at else text)
    listing, item, quantity = _split(text)
    if at:
        return _at_frequency(label, item, quantity, frequency, system, where)
    if isinstance(item, str) and quantity in WITHOUT_SHELL.get(item, {}):
        attribute = WITHOUT_SHELL[item][quantity]
        if system.point_absorbers and attribute in _NOT_OF_POINTS:
            raise InputError(where, f"{text!r}: {_NOT_OF_POINTS[attribute][0]}", _NOT_OF_POINTS[attribute][1])
        if attribute in _OF_CHARGES and not charges_of(system):
            raise InputError(where, f"{text!r}: no source is a charge", "use an underwater-explosion, or leave it out")
        entry = without_shell(system)[item][quantity]
        return Metric(label, entry.units, entry.long_name, item, attribute)
    if listing == "fluids" or (quantity in FLUID_QUANTITIES and item in ("interior", "gap", "exterior")):
        return _of_fluid(text, label, item, quantity, system, where)
    shell = _shell(item, system)
    if shell is None or quantity not in shell_quantities(3):
        raise InputError(where, f"{text!r} is not a known metric", suggestion(text, metric_names(system)))
    entry = shell_quantities(3)[quantity]
    lack = _lacks(system.shells[shell], entry)
    if lack is not None:
        raise InputError(where, f"{text!r} needs a shell that {lack}", suggestion(text, metric_names(system)))
    return Metric(label, entry.units, f"{entry.long_name}, {shell_phrase(shell, len(system.shells))}", shell, quantity)


def _split(text: str) -> tuple[str, str | int, str]:
    """Return list, item and quantity of a name: "shells[1].mass" gives "shells", 1, "mass"; "inner.mass" gives "", "inner", "mass"."""
    *place, quantity = parts(text) or [""]
    listing = place.pop(0) if len(place) == 2 and place[0] in ("shells", "fluids") else ""
    item = ".".join(place)
    return listing, int(item) if listing and _DIGITS.fullmatch(item) else item, quantity


def _shell(item: str | int, system: System) -> int | None:
    count = len(system.shells)
    words = {**shell_words(count), **({"shell": 0} if count == 1 else {})}
    number = item if isinstance(item, int) else words.get(item)
    return number if number is not None and number < count else None


def _lacks(wall: object, entry: MetricEntry) -> str | None:
    if not isinstance(wall, Shell):
        return "is not rigid"
    return f"has a layer with the role {entry.needs!r}" if entry.needs and getattr(wall, entry.needs) is None else None


def _has_margin(wall: object, quantity: str) -> bool:
    """Return whether a quantity is no margin, or a layer of the wall has the strength that it is told against."""
    return quantity != "strength_margin" or (isinstance(wall, Shell) and any(layer.material.strength is not None for layer in wall.layers))


def _at_frequency(label: str, item: str | int, quantity: str, text: str, system: System, where: str) -> Metric:
    """Return what is read at a frequency: of a shock spectrum, of mounted equipment, or of an answer without time."""
    steady = SteadyMetric.of(quantity, text, where)
    if steady is not None:
        return _of_steady(label, item, steady, system, where)
    spectrum = SpectrumMetric.of(quantity, text, where) or MountedMetric.of(quantity, text, where)
    shell = _shell(item, system)
    if shell is None or spectrum is None:
        raise InputError(where, f"{label!r} is not a known metric", _allowed_at_frequencies(system))
    _require_moving(label, shell, system, where)
    return Metric(label, spectrum.units, f"{spectrum.long_name}, {shell_phrase(shell, len(system.shells))}", shell, spectrum.quantity)


def _of_steady(label: str, item: str | int, steady: SteadyMetric, system: System, where: str) -> Metric:
    if len(system.sources) > 1:
        raise InputError(
            where, f"{label!r} is told per pressure of one source, and there are {len(system.sources)}", "use a function of the response"
        )
    places, count = places_of(steady), len(system.shells)
    if "system" in places and item == "system":
        return Metric(label, steady.units, steady.long_name, "system", steady.quantity)
    if "shell" in places and (shell := _shell(item, system)) is not None:
        _require_moving(label, shell, system, where, *(["sensor", "actuator"] if steady.name.endswith("_voltage") else []))
        return Metric(label, steady.units, f"{steady.long_name}, {shell_phrase(shell, count)}", shell, steady.quantity)
    number = item if isinstance(item, int) else region_number(item, count)
    if "fluid" in places and number is not None and number < count and not isinstance(system.fluids[number], Vacuum):
        return Metric(label, steady.units, f"{steady.long_name}, {region_name(number, count)}", number, steady.quantity)
    raise InputError(where, f"{label!r} is not a known metric", _allowed_at_frequencies(system))


def _allowed_at_frequencies(system: System) -> str:
    shells = f"{shell_place(0, len(system.shells))} or another shell with {', '.join(SPECTRA)}"
    steady = f"with {', '.join(OF_SHELLS)}; or system with {', '.join(OF_SYSTEMS)}"
    return f"give {shells} and a frequency, as in outer.pseudo_velocity@500 Hz; {steady}"


def _require_moving(label: str, shell: int, system: System, where: str, *needs: str) -> None:
    for need in ("", *needs):
        lack = _lacks(system.shells[shell], MetricEntry("", "", need))
        if lack is not None:
            raise InputError(where, f"{label!r} needs a shell that {lack}", suggestion(label, metric_names(system)))


def _of_fluid(text: str, label: str, item: str | int, quantity: str, system: System, where: str) -> Metric:
    count = len(system.shells)
    number = item if isinstance(item, int) else region_number(item, count)
    if number is None or number > count or quantity not in FLUID_QUANTITIES or isinstance(system.fluids[number], Vacuum):
        raise InputError(where, f"{text!r} is not a metric of this system", suggestion(text, metric_names(system)))
    entry = FLUID_QUANTITIES[quantity]
    return Metric(label, entry.units, f"{entry.long_name}, {region_name(number, count)}", number, quantity)


def _of_function(function: UserFunction, name: str | None) -> Metric:
    return Metric(name or function.name, function.units, function.long_name, function=function)
