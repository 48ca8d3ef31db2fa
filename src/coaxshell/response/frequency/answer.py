"""The one call from a system to its answer at given frequencies."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Unpack

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.basis import Modes
from coaxshell.acoustics.sources import PlaneGeometry, SphericalFrontGeometry
from coaxshell.errors import InputError, PhysicsWarning
from coaxshell.model.base import shown
from coaxshell.model.loading import SystemLike, as_system
from coaxshell.model.places import shell_name
from coaxshell.model.system import System
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.keywords import showing
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.scalars import plain
from coaxshell.response.frequency import along, fields, remarks, walls
from coaxshell.response.frequency.request import WIDTHS, Asked, SteadyOptions, asked, frequencies
from coaxshell.response.frequency.steady import Steady, Tail
from coaxshell.response.labels import angle_coordinate
from coaxshell.solver.axial.stability import require_stable_waves, up_to
from coaxshell.solver.dimensions import require_loops_alone, require_two_dimensions
from coaxshell.solver.excitation import SourceGroup, source_groups, source_parities
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.stability import require_stable
from coaxshell.solver.steady import DAMPED, Frequencies, SteadySystem
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.losses import USUAL_BAND, Band

_BLOCK = 2**17
"""Orders times frequencies that are solved together."""
_WATCHED = 5.0
"""Transits within which an unstable loop would show: those of a run at the default settings."""
MOST_MODES = 2000
FORCED_MODES = 150
"""Orders that absorbers and line forces get at least: their spectra of orders fall off slowly."""


@showing(SteadyOptions)
def frequency_response(
    system: SystemLike,
    frequency: npt.ArrayLike | str,
    quantity: str = "target_strength",
    *,
    modes: int | None = None,
    dimensions: int = 2,
    **options: Unpack[SteadyOptions],
) -> xr.DataArray:
    r"""Return what a system does at given frequencies, without any time step: amplitudes of e^{i omega t}, or levels.

    Parameters
    ----------
    system : System, str or Path
        A description, the name of a preset, or a scenario file, with feedback and linear absorbers; cubic ones are taken at small
        amplitudes, with a warning.
    frequency : float, str or list of them
        Hz, or text such as "2 kHz".
    quantity : str
        Of a shell: "displacement", "tangential_displacement", "shell_velocity", "shell_acceleration", "stress", "sensor_voltage", ...; of
        the fluids "pressure"; "absorber_displacement", "absorber_force"; of the echo of a plane wave "form_function",
        "target_strength", "scattering_width", "extinction_width", "absorption_width"; of the way in "transmission_loss",
        "insertion_loss"; under a line force "receptance", "mobility", "accelerance".
    modes : int, optional
        Highest circumferential order; what frequencies and sources ask for unless given.
    dimensions : int
        3 where plane waves are inclined to the cross-section, or of a point source, whose wavenumbers along the axis are added up
        (:mod:`coaxshell.response.frequency.along`): motions, stresses, voltages and pressures.
    shell, angle, component, depth
        Of a shell ("outer"), degrees, a stress ("hoop") or a direction of motion, m outward from the mid-surface.
    radius, part
        Of a pressure, in outermost radii a; "total", outside also "incident" or "scattered".
    z : float or str
        Position along the axis, m, in three dimensions; 0 unless given.
    region : str, optional
        Fluid within the shells over which a transmission loss takes its mean square; the axis unless given.
    force : (shell, degrees), optional
        A line force of 1 N/m, positive inward, drives the system in the place of its sources; a receptance has it where it is read.
    source : int, optional
        Number of the one that is meant, where there are several.
    per : str
        "incident": per pressure spectrum of the source at the head in free field; "absolute": with the sources' own spectra.
    length : float or str, optional
        Of a cylinder seen broadside, whose target strength is then that of a body (dB re 1 m^2).
    against : System, str or Path
        With which an insertion loss compares.

    Returns
    -------
    DataArray, first dim frequency
        Complex amplitudes, or levels in dB. ``attrs`` hold units, the orders, and warnings.

    Raises
    ------
    InputError
        An argument is not allowed, or the system cannot be solved so.
    """
    described = as_system(system)
    what = asked(described, quantity, options)
    solved = _solve(described, frequency, what, modes, dimensions)
    values, told = solved.values, solved.told
    if quantity == "insertion_loss":
        other = as_system(options["against"], "against")
        compared = _solve(other, frequency, asked(other, "transmission_loss", _of_other(options)), modes, dimensions)
        values = values - compared.values
        told = [*told, *(f"against: {line}" for line in compared.told if line not in told)]
    for line in told:
        warnings.warn(line, PhysicsWarning, stacklevel=2)
    return _labelled(described, what, solved, values, told)


def _of_other(options: SteadyOptions) -> SteadyOptions:
    kept: Any = {name: value for name, value in options.items() if name in ("region", "source")}
    found: SteadyOptions = kept
    return found


@dataclass(frozen=True)
class _Solved:
    """Values of a quantity with what they were solved with."""

    values: ComplexArray | FloatArray
    hertz: FloatArray
    orders: int
    told: list[str]


def _solve(system: System, frequency: Any, what: Asked, modes: int | None, dimensions: int) -> _Solved:
    """Return the values of a quantity, shape (F, ...), or (...) for a single frequency."""
    if dimensions not in (2, 3):
        raise InputError("dimensions", f"{shown(dimensions)} is not allowed", "must be one of 2, 3")
    if system.sea is not None and (system.sea.surface or system.sea.bottom is not None):
        raise InputError("sea", "an answer at a frequency is that of unbounded water", "leave the sea out, or give it surface = false")
    require_loops_alone(system, "an answer at a frequency", "leave {} out")
    if dimensions == 2:
        if what.z:
            raise InputError("z", f"{what.z:g} m has no meaning in two dimensions", "leave it out, or use dimensions=3")
        require_two_dimensions(system, Settings())
    elif system.point_absorbers:
        raise InputError(
            "absorbers", "absorbers at points scatter a wave into all wavenumbers along the axis", "leave them out, or use lines"
        )
    transit = system.reference_radius / system.exterior.sound_speed
    hertz = frequencies(frequency, transit)
    omega = 2.0 * math.pi * transit * np.atleast_1d(hertz)
    band = USUAL_BAND.with_frequency(float(omega.min())).with_frequency(float(omega.max()))
    problem = _directed(_problem(system, dimensions, band), what).resolving(float(omega.max()))
    orders = _orders(problem, what, float(omega.max()), modes)
    _require(problem, what)
    highest = _highest_along(problem, float(omega.max()))
    if highest:
        require_stable_waves(problem, up_to(orders, highest), _WATCHED)
    else:
        require_stable(problem, orders, _WATCHED)
    tail, told = Tail(), list[str]()
    if what.force is None and dimensions == 3 and any(isinstance(one, SphericalFrontGeometry) for one in problem.sources):
        values, apart = along.of_point_source(problem, omega, orders, what, tail, _read)
        told += along.remarks(apart)
    else:
        trace = 0.0 if what.force is not None else _trace(problem, dimensions)
        parts = []
        solid = trace != 0.0 and any(isinstance(wall, ElasticWall) for wall in problem.shells)
        for some in _blocks(omega, orders, 1 if solid else None):
            grid = Frequencies.of(some)
            # Shapes of solids are those of one real wavenumber, which that of a wave without damping is.
            along_axis = float(some[0]) * trace if solid else -1j * grid.nodes * trace
            parts.append(_read(SteadySystem(problem, grid, Modes.up_to(orders, along_axis if trace else 0.0)), what, tail))
        values = np.concatenate(parts)
        if trace and what.z:
            travelled = np.exp(-Frequencies.of(omega).nodes * (trace * what.z / problem.scales.length))
            values = values * travelled.reshape(-1, *[1] * (values.ndim - 1))
    told += remarks.remarks(problem, float(omega.max()), tail.share, orders, what)
    return _Solved(values if np.ndim(hertz) else np.asarray(values[0]), hertz, orders, told)


def _problem(system: System, dimensions: int, band: Band) -> Problem:
    """Return the problem of a system, also of solid walls under inclined waves: at a frequency their wavenumber is real."""
    if dimensions == 2 or not any(getattr(shell, "theory", "") == "elastic" for shell in system.shells):
        return dimensionless(system, dimensions, band=band)
    inclined = [getattr(source, "inclination", 0.0) for source in system.sources]
    flat = [source.replace(inclination=0.0) if turned else source for source, turned in zip(system.sources, inclined, strict=True)]
    problem = dimensionless(system.replace(source=flat if len(flat) > 1 else flat[0]), dimensions, band=band)
    pairs = zip(problem.sources, inclined, strict=True)
    sources = tuple(replace(one, inclination=turned) if isinstance(one, PlaneGeometry) else one for one, turned in pairs)
    return replace(problem, system=system, sources=sources)


def _directed(problem: Problem, what: Asked) -> Problem:
    """Return the problem with the source that is meant; an echo is that of a plane wave from its direction."""
    if what.source is None:
        return problem
    source, geometry = problem.system.sources[what.source], problem.sources[what.source]
    if what.quantity.kind == "target" and geometry.distance is not None:
        geometry = PlaneGeometry(head=problem.head)
    return replace(problem, system=problem.system.replace(source=source), sources=(geometry,))


def _highest_along(problem: Problem, omega: float) -> float:
    """Return the highest axial wavenumber of waves that travel: of the trace of inclined waves, of point sources along the axis itself."""
    if problem.dimensions == 2:
        return 0.0
    traces = (abs(one.trace_slowness) for one in problem.sources if isinstance(one, PlaneGeometry))
    points = any(isinstance(one, SphericalFrontGeometry) for one in problem.sources)
    return omega * max(*traces, float(points), 0.0)


def _trace(problem: Problem, dimensions: int) -> float:
    """Return sin(alpha) of the plane waves of three dimensions, alike for all; lines have 0."""
    if dimensions == 2:
        return 0.0
    found = set()
    for geometry in problem.sources:
        found.add(geometry.trace_slowness if isinstance(geometry, PlaneGeometry) else 0.0)
    if len(found) > 1:
        raise InputError("source", "the waves are inclined differently", "give the number of one, source=0")
    return found.pop()


def _orders(problem: Problem, what: Asked, highest: float, modes: int | None) -> int:
    """Return the highest order: what reaches the surface at the highest frequency, from sources that are near, and of forces."""
    if modes is not None:
        number = plain(modes)
        if isinstance(number, bool) or not isinstance(number, int) or not 1 <= number <= MOST_MODES:
            raise InputError("modes", f"{shown(modes)} is not allowed", f"give a whole number from 1 to {MOST_MODES}")
        return number
    reach = highest * problem.head
    found = reach + 7.0 * math.cbrt(reach) + 12.0
    for geometry in () if what.force is not None else problem.sources:
        if geometry.distance is not None:
            found = max(found, 25.0 / math.log(geometry.distance / problem.head))
    if what.force is not None or problem.system.absorber_list:
        found = max(found, reach + FORCED_MODES)
    return min(math.ceil(found), MOST_MODES)


def _blocks(omega: FloatArray, orders: int, width: int | None = None) -> list[FloatArray]:
    width = width or max(16, _BLOCK // (orders + 1))
    return [omega[start : start + width] for start in range(0, omega.size, width)]


def _require(problem: Problem, what: Asked) -> None:
    """Raise InputError if the walls lack what a quantity is read of."""
    if what.quantity.name == "stress":
        walls.component_of(problem, what.shell, what.component)
        walls.depth_of(problem, what.shell, what.depth)
    elif what.quantity.kind == "shell" and what.depth is not None and problem.shells[what.shell].faces_move_alike:
        raise InputError("depth", "a thin wall moves as its mid-surface does", 'leave it out, or use theory = "elastic"')
    elif what.quantity.name.endswith("_voltage"):
        walls.require(problem, what.shell, "control" if what.quantity.name.startswith("actuator") else "")
    elif what.quantity.kind == "absorbers" and not problem.system.absorber_list:
        raise InputError("quantity", f"{what.quantity.name!r} is asked of a system without absorbers", "give it some")
    elif what.quantity.name in WIDTHS and any(getattr(one, "inclination", 0.0) for one in problem.sources):
        raise InputError("quantity", f"{what.quantity.name!r} is that of a wave in the cross-section", "use inclination = 0")


def _read(system: SteadySystem, what: Asked, tail: Tail) -> ComplexArray | FloatArray:
    """Return the values of a quantity at a block of frequencies, (nodes, ...), SI."""
    problem, scales = system.problem, system.problem.scales
    if what.force is not None:
        motion, drive = system.under_force(what.force), scales.line_force
        groups: list[SourceGroup] = []
    else:
        groups = source_groups(problem, system.grid.nodes)
        if what.per == "incident":
            ones = np.ones(system.grid.nodes.size, np.complex128)
            groups = [SourceGroup(group.geometry, [(source, ones) for source, _ in group.members]) for group in groups]
        motion = system.under_sources(groups, source_parities(problem))
        drive = scales.pressure if what.per == "incident" else 1.0 / scales.time
    steady = Steady(system, motion, tail)
    if what.quantity.kind == "target":
        return _echo(steady, what)
    if what.quantity.kind == "through":
        return _level_within(steady, what)
    if what.quantity.kind == "field":
        return _field(steady, what, groups) * (scales.pressure / drive)
    return _OF_WALLS[what.quantity.name](steady, what) / drive


def _field(steady: Steady, what: Asked, groups: list[SourceGroup]) -> ComplexArray:
    radii, incident = np.atleast_1d(what.radii), None
    if groups and what.part != "scattered":
        total: ComplexArray | float = 0.0
        for group in groups:
            for source, spectrum in group.members:
                geometry = fields.steady_geometry(group.geometry)
                total = total + spectrum * fields.free_field(steady, geometry, source.angle, radii, what.theta)
        incident = np.asarray(total)
    found = fields.pressure_at(steady, radii, what.theta, what.part, incident)
    found = found if what.radii.ndim else found[:, 0]
    return found if what.theta.ndim else found[..., 0]


def _echo(steady: Steady, what: Asked) -> ComplexArray | FloatArray:
    """Return what is told of the scattered wave far away."""
    scales, problem = steady.problem.scales, steady.problem
    if what.quantity.name in WIDTHS:
        scattered, lost = fields.widths(steady, problem.system.sources[0].angle + 180.0)
        return {"scattering_width": scattered, "extinction_width": lost, "absorption_width": lost - scattered}[what.quantity.name]
    f = _at(what, fields.form_function(steady, what.theta))
    if what.quantity.name == "form_function":
        return f
    level = 0.5 * scales.length * problem.head * np.abs(f) ** 2  # r |p_s/p_i|^2, m
    if what.length is not None:
        wavenumber = steady.s.imag / scales.length
        level *= what.length**2 * (wavenumber if level.ndim == 1 else wavenumber[:, None]) / (2.0 * np.pi)
    return np.asarray(10.0 * np.log10(np.maximum(level, 1e-300)))


def _level_within(steady: Steady, what: Asked) -> FloatArray:
    """Return by how much the incident wave on the axis is louder than what has come in, dB."""
    (geometry,), (source,) = steady.problem.sources, steady.problem.system.sources
    free = fields.free_field(steady, fields.steady_geometry(geometry), source.angle, np.zeros(1), np.zeros(1))[0, 0]
    within = np.abs(fields.on_axis(steady)) ** 2 if what.region is None else fields.mean_square(steady, what.region)
    return np.asarray(10.0 * np.log10(np.abs(free) ** 2 / np.maximum(within, 1e-300)))


def _at(what: Asked, values: ComplexArray) -> ComplexArray:
    """Return values at angles, (nodes, A), without that dimension for a single one."""
    return values if what.theta.ndim else values[:, 0]


def _moved(steady: Steady, what: Asked) -> ComplexArray:
    depth = None if what.depth is None else walls.depth_of(steady.problem, what.shell, what.depth)
    component = what.component
    return _at(what, walls.displacement(steady, what.shell, what.theta, component, what.quantity.rate, depth))


def _stressed(steady: Steady, what: Asked) -> ComplexArray:
    depth = walls.depth_of(steady.problem, what.shell, what.depth)
    return _at(what, walls.stress(steady, what.shell, what.theta, what.component, depth))


_OF_WALLS: dict[str, Callable[[Steady, Asked], ComplexArray]] = {
    **{f"{side}{name}": _moved for side in ("", "tangential_") for name in ("displacement", "shell_velocity", "shell_acceleration")},
    **dict.fromkeys(("receptance", "mobility", "accelerance"), _moved),
    "stress": _stressed,
    "sensor_voltage": lambda steady, what: _at(what, walls.sensor_voltage(steady, what.shell, what.theta)),
    "actuator_voltage": lambda steady, what: _at(what, walls.actuator_voltage(steady, what.shell, what.theta)),
    "absorber_displacement": lambda steady, _: walls.link_displacement(steady),
    "absorber_force": lambda steady, _: walls.link_force(steady),
}


def _labelled(system: System, what: Asked, solved: _Solved, values: ComplexArray | FloatArray, told: list[str]) -> xr.DataArray:
    """Return values with names, units and coordinates."""
    quantity, count = what.quantity, len(system.shells)
    attributes = {"units": "Hz", "long_name": "frequency"}
    coords: dict[str, Any] = {"frequency": xr.Variable("frequency" if solved.hertz.ndim else (), solved.hertz, attributes)}
    dims = ["frequency"] if solved.hertz.ndim else []
    if quantity.kind == "field":
        coords["radius"] = xr.Variable("radius" if what.radii.ndim else (), what.radii, {"units": "a", "long_name": "radius"})
        dims += ["radius"] if what.radii.ndim else []
    if quantity.kind in ("shell", "field", "point") or quantity.name in ("form_function", "target_strength"):
        coords["angle"] = angle_coordinate(what.theta)
        dims += ["angle"] if what.theta.ndim else []
    if quantity.kind == "absorbers":
        dims.append("absorber")
        coords["absorber_angle"] = xr.Variable("absorber", [one.angle for one in system.absorber_list], {"units": "degree"})
        if quantity.name == "absorber_force":
            dims.append("side")
            coords["side"] = ["inner", "outer"]
    attrs: dict[str, Any] = {"units": remarks.unit_of(what), "long_name": remarks.words_of(what), "modes": solved.orders}
    attrs |= {"time_dependence": "exp(i omega t)", "damping_ratio": DAMPED, "system": system.name}
    if quantity.kind in ("shell", "point"):
        attrs |= {"shell": what.shell, "shell_name": shell_name(what.shell, count)}
    if quantity.sign:
        attrs["sign"] = quantity.sign
    if told:
        attrs["warnings"] = "\n".join(told)
    return xr.DataArray(values, dims=dims, coords=coords, name=quantity.name, attrs=attrs)
