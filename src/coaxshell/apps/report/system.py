"""The system and its loads: drawing, materials, fluids, sources."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from coaxshell.acoustics.pulse_histories import pulse_impulse
from coaxshell.apps.report.parts import Beside, Drawing, Section, Subject, Table, drawn
from coaxshell.model import Fluid, RigidShell, System, UnderwaterExplosion
from coaxshell.model.display import cross_section
from coaxshell.model.gains import saturates
from coaxshell.model.places import region_name, shell_name
from coaxshell.model.prefixes import engineering
from coaxshell.model.sources import Source

_LOAD_ROWS = ("source", "where", "peak", "falls to peak/e in", "impulse", "energy per area")


def described(subject: Subject) -> Section:
    """Return the section on the system: to scale, layer by layer, fluids, what is fitted."""
    system = subject.run.system
    scale = "Radii to scale, the source to the right (0°); walls are drawn thicker where the drawing says so."
    layers = Table(
        "Walls, from the inside out",
        ("shell", "layer", "material", "thickness", "density", "stiffness", "strength", "losses"),
        list(_layers(system)),
        3,
    )
    fluids = Table("Fluids", ("region", "fluid", "density", "sound speed"), list(_fluids(system)), 2)
    others = [] if len(subject.runs) == 1 else [f"Compared with {list(subject.runs)[1]}: {_differences(subject)}"]
    return Section("The system", [Beside(Drawing(cross_section(system), scale), [fluids, *_fitted(system), *others]), layers])


def _layers(system: System) -> Iterator[tuple[str, ...]]:
    for number, shell in enumerate(system.shells):
        name = f"{shell_name(number, len(system.shells))}, radius {engineering(shell.radius, 'm')}"
        if isinstance(shell, RigidShell):
            yield (name, "", "rigid", "", "", "", "", "")
            continue
        for layer in shell.layers:
            material = layer.material
            strength = engineering(material.strength, "Pa") if material.strength else "not given"
            row = (layer.role, material.name, engineering(layer.thickness, "m"), f"{material.density:g} kg/m³")
            yield (name, *row, _stiffness(material), strength, _losses(material))
            name = ""


def _stiffness(material: Any) -> str:
    match material.type:
        case "elastic":
            return f"E = {engineering(material.youngs_modulus, 'Pa')}, ν = {material.poisson_ratio:g}"
        case "viscoelastic":
            return f"E (slow) = {engineering(material.long_term_modulus, 'Pa')}, ν = {material.poisson_ratio:g}"
    return f"c22 = {engineering(material.c22, 'Pa')}, e32 = {material.e32:g} C/m²"


def _losses(material: Any) -> str:
    if material.type == "viscoelastic":
        return f"{len(material.prony)} relaxations"
    return f"η = {material.loss_factor:g}" if material.loss_factor else "none"


def _fluids(system: System) -> Iterator[tuple[str, ...]]:
    for number, fluid in enumerate(system.fluids):
        region = region_name(number, len(system.shells))
        if isinstance(fluid, Fluid):
            yield region, fluid.name or "a fluid", f"{fluid.density:g} kg/m³", f"{fluid.sound_speed:g} m/s"
        else:
            yield region, "vacuum", "", ""


def _fitted(system: System) -> Iterator[str]:
    absorbers = system.absorber_list or system.point_absorbers
    if absorbers:
        per = "kg" if system.point_absorbers else "kg/m"
        yield f"{len(absorbers)} absorbers, together {sum(one.mass for one in absorbers):.4g} {per}."
    if system.sea is not None:
        bottom = f", a rigid bottom {engineering(system.sea.bottom, 'm')} below it" if system.sea.bottom is not None else ""
        yield f"In the sea: the axis lies {engineering(system.sea.depth, 'm')} below the surface, which is at {system.sea.up:g}°{bottom}."
    if system.control is not None:
        shells = ", ".join(shell_name(i, len(system.shells)) for i in system.controlled_shells)
        yield f"Feedback on: {shells}; {'saturates at the field limit' if saturates(system) else 'without saturation'}."


def _differences(subject: Subject) -> str:
    """Return in words in which entries of their descriptions two systems differ, as far as it can be told in a line."""
    first, second = (dict(_entries(response.system.canonical())) for response in subject.runs.values())
    names = sorted({path.split(".")[0].split("[")[0] for path in {*first, *second} if first.get(path) != second.get(path)})
    return f"the descriptions differ in {', '.join(names)}." if names else "the descriptions are the same."


def _entries(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for key, one in value.items():
            yield from _entries(one, f"{path}.{key}" if path else str(key))
    elif isinstance(value, list | tuple):
        for number, one in enumerate(value):
            yield from _entries(one, f"{path}[{number}]")
    else:
        yield path, value


def loads(subject: Subject) -> Section:
    """Return the section on the loads: pressure and impulse of each source at its head point, and their measures."""
    from coaxshell.plotting.loads import figure_loads, load_histories

    response = subject.run
    system, duration = response.system, float(response.time_seconds[-1])
    told = f"Free-field pressure at the head point, as if nothing were in the water, over the {engineering(duration, 's')} of the run."
    alt = "; ".join(f"{_kind(source)}: peak {engineering(source.pulse.peak, 'Pa')}" for source in system.sources)
    picture = drawn(
        figure_loads(system, duration),
        "loads",
        f"Pressure and impulse against time at the head point. {alt}.",
        told,
        load_histories(system, duration),
    )
    rows = [_load(system, source, duration) for source in system.sources]
    return Section("Loads", [picture, Table("Sources, over the run", _LOAD_ROWS, rows, 2)])


def _kind(source: Source) -> str:
    return source.type.replace("-", " ")


def _load(system: System, source: Source, duration: float) -> tuple[str, ...]:
    distance = system.source_distance(source)
    where = "" if distance is None else f"{engineering(distance, 'm')} from the axis, "
    where += f"at {source.angle:g}°" + (f", later by {engineering(source.delay, 's')}" if source.delay else "")
    if isinstance(source, UnderwaterExplosion):
        where += f"; {engineering(1e3 * source.charge_mass, 'g')} of {source.explosive} at {engineering(source.stand_off, 'm')}"
        where += f", hull shock factor {source.hull_shock_factor:.3g} kg^½/m"
    time = np.linspace(0.0, max(duration - source.delay, 0.0), 20_001)
    from coaxshell.acoustics.pulse_histories import pulse_history

    pressure = pulse_history(source.pulse, time, 1.0, 1.0)
    fluid = system.exterior
    energy = float(np.trapezoid(pressure**2, time)) / (fluid.density * fluid.sound_speed)
    impulse = float(pulse_impulse(source.pulse, time[-1:], 1.0, 1.0)[0])
    fallen = _decay(time, pressure)
    return (
        _kind(source),
        where,
        engineering(source.pulse.peak, "Pa"),
        "not within the run" if fallen is None else engineering(fallen, "s"),
        engineering(impulse, "Pa s"),
        engineering(energy, "J/m²"),
    )


def _decay(time: np.ndarray, pressure: np.ndarray) -> float | None:
    """Return how long after its peak a pressure has fallen to peak/e, s; None if it has not."""
    at = int(np.abs(pressure).argmax())
    below = np.flatnonzero(np.abs(pressure[at:]) <= abs(pressure[at]) / np.e)
    return float(time[at + below[0]] - time[at]) if below.size and pressure[at] else None
