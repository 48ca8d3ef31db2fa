"""What one request may ask for: above it, a clear answer instead of a machine that is brought to its knees."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from coaxshell.errors import InputError
from coaxshell.limits import (
    STUDIO_ABSORBERS,
    STUDIO_BODY,
    STUDIO_DESIGNS,
    STUDIO_LAYERS,
    STUDIO_NESTING,
    STUDIO_PROJECT,
    STUDIO_SAMPLES,
    STUDIO_SHELLS,
    STUDIO_SOURCES,
    STUDIO_STATIONS,
    STUDIO_UPLOAD,
)
from coaxshell.model import AbsorberRing, Sampled, Shell, System
from coaxshell.model.base import shown
from coaxshell.model.naming import suggestion
from coaxshell.numerics.cost import Cost
from coaxshell.numerics.memory import words_of
from coaxshell.solver.cost import run_cost
from coaxshell.solver.settings import AXIAL, Settings
from coaxshell.solver.solvable import require_solvable

BODY_BYTES, UPLOAD_BYTES, NESTING = STUDIO_BODY.value, STUDIO_UPLOAD.value, STUDIO_NESTING.value
SHELLS, LAYERS, ABSORBERS = STUDIO_SHELLS.value, STUDIO_LAYERS.value, STUDIO_ABSORBERS.value
DESIGNS, PROJECT_BYTES = STUDIO_DESIGNS.value, STUDIO_PROJECT.value
SOURCES, SAMPLES, STATIONS = STUDIO_SOURCES.value, STUDIO_SAMPLES.value, STUDIO_STATIONS.value
PREVIEW, FULL = Settings(time_step=4e-3, modes=60), Settings()
PREVIEW_SPATIAL, FULL_SPATIAL = Settings(time_step=1e-2, modes=24, dimensions=3), Settings(time_step=4e-3, modes=60, dimensions=3)
"""In three dimensions, where the bare double shell at one station takes about 1.5 and 12 s of a processor.

The preview's 24 orders and axial wavenumbers leave 1.2 % of the bare stress against 48, 4 % of the hybrid system's against 40
(relative RMS of the worse shell; peaks 0.7 %).
"""
ENTRIES = ("duration", "time_step", "modes", "refinement", "dimensions", "stations", "axial_modes", "axial_period")
"""Entries of a resolution that a page may choose; the engine is the spectral one, and there are no orders to be found by a tolerance."""
PREVIEW_MODES, PREVIEW_STEPS = 100, 2_500
MODES, STEPS, REFINEMENT = 300, 20_000, 8
MODE_STEPS = 3_000_000
"""Orders times steps times refinement."""
LIVE_COST, FULL_COST = Cost(600e6, 60.0), Cost(2.5e9, 900.0)
"""Memory and time of one run, with all that they depend on: shells, absorbers, orders, steps, samples."""

FIELD_VALUES, FRAME_VALUES, FIELD_BYTES = 30_000_000, 8_000_000, 500_000_000
HEAD_SECONDS, BODY_SECONDS = 20.0, 120.0
"""How long the head of a request, and its body, may take to come."""
LIVE_WAITING, JOBS_WAITING, JOBS_OF_CLIENT, JOBS_KEPT, STREAMS = 120, 24, 6, 64, 200
SWEPT, CASES = 4, 400
VARIED, COORDINATES, CONSTRAINTS = 8, 64, 12
"""Variables of an optimisation as written, and one by one when each absorber has its own; limits on metrics."""
EVALUATIONS, POPULATION = 2_000, 400
LINKED_SAMPLES, RECORD_BYTES = 200, 100_000_000
"""Samples up to which a link holds a record itself, and bytes of the longer ones that are kept for links."""
TABS = 100
"""Tabs of a browser that share a stream of events."""
TEXT = 200
"""Letters of a value, a constraint or a title."""
RUN_BYTES, CURVE_BYTES, SLOTS = 60_000_000, 100_000_000, 4_000
"""Bytes of the runs that the server knows, and of the curves that it keeps; pages and places that it remembers."""
REST_SECONDS, REST_GROWTH, WORKER_BYTES = 120.0, 1.15, 1_500_000_000
"""After how long without work memory is given back, by workers that have grown so much; bytes from which on one is renewed at once."""
SILENT_SECONDS, DROPPED_SECONDS = 180.0, 15.0
"""How long a task may go without reporting progress, and how long it may go on once nobody wants it."""
GONE_SECONDS = 10.0
"""How long a page may be without its stream of events before what only it would have shown is stopped."""


def table() -> dict[str, int]:
    """Return the limits that a page needs to know."""
    return {
        "shells": SHELLS,
        "layers": LAYERS,
        "absorbers": ABSORBERS,
        "sources": SOURCES,
        "stations": STATIONS,
        "samples": SAMPLES,
        "designs": DESIGNS,
        "modes": MODES,
        "steps": STEPS,
        "refinement": REFINEMENT,
        "mode_steps": MODE_STEPS,
        "swept": SWEPT,
        "cases": CASES,
        "varied": VARIED,
        "coordinates": COORDINATES,
        "constraints": CONSTRAINTS,
        "evaluations": EVALUATIONS,
        "population": POPULATION,
        "preview_modes": PREVIEW_MODES,
        "preview_steps": PREVIEW_STEPS,
        "body_bytes": BODY_BYTES,
        "upload_bytes": UPLOAD_BYTES,
        "project_bytes": PROJECT_BYTES,
    }


def check_raw(data: Mapping[str, Any]) -> None:
    """Raise InputError for a description that is too large to be read, or that names a file of this machine."""
    for name, most in (("absorbers", ABSORBERS), ("shells", SHELLS), ("source", SOURCES)):
        value = data.get(name)
        if isinstance(value, list) and len(value) > most:
            raise _above(name, len(value), most, name)
    source = data.get("source")
    for index, item in enumerate(source if isinstance(source, list) else [source]):
        pulse = item.get("pulse") if isinstance(item, dict) else None
        where = f"source[{index}].pulse" if isinstance(source, list) else "source.pulse"
        if isinstance(pulse, dict) and "file" in pulse:
            raise InputError(f"{where}.file", "is not read here", "give the samples themselves, as time and pressure")


def check_system(system: System) -> None:
    """Raise InputError for a system larger than the studio solves."""
    if len(system.shells) > SHELLS:
        raise _above("shells", len(system.shells), SHELLS, "shells")
    for index, shell in enumerate(system.shells):
        if isinstance(shell, Shell) and len(shell.layers) > LAYERS:
            raise _above(f"shells[{index}].layers", len(shell.layers), LAYERS, "layers")
    ring = isinstance(system.absorbers, AbsorberRing)  # counted, not written out: that would take the memory which is not granted
    if len(system.absorbers) > ABSORBERS:
        raise _above("absorbers.count" if ring else "absorbers", len(system.absorbers), ABSORBERS, "absorbers")
    if len(system.sources) > SOURCES:
        raise _above("source", len(system.sources), SOURCES, "sources")
    for index, source in enumerate(system.sources):
        if isinstance(source.pulse, Sampled) and len(source.pulse.time) > SAMPLES:
            path = f"source[{index}]" if isinstance(system.source, tuple) else "source"
            raise _above(f"{path}.pulse.time", len(source.pulse.time), SAMPLES, "samples")


def check_cost(system: System, settings: Settings, *, live: bool) -> None:
    """Raise InputError for a run that takes more memory or time than one request may, whatever it is that makes it large.

    Also for one that has no solution in the dimensions asked for.
    """
    require_solvable(system, settings)
    cost, most = run_cost(system, settings), LIVE_COST if live else FULL_COST
    if cost.memory > most.memory or cost.seconds > most.seconds:
        found = f"a run of this system at this resolution takes about {words_of(cost.memory)} and {cost.duration}"
        fewer = "orders, stations or shells" if settings.dimensions == 3 else "orders, absorbers or shells"
        remedy = f"at most {words_of(most.memory)} and {most.duration} here: fewer {fewer}, or a coarser time step"
        raise InputError("resolution", found, remedy)


def require_plane(settings: Settings, what: str, remedy: str) -> None:
    """Raise InputError for a run in three dimensions where the studio shows two alone."""
    if settings.dimensions == 3:
        raise InputError("run", f"is of three dimensions, of which the studio does not show {what}", remedy)


def require_small(cost: Cost, what: str) -> None:
    """Raise InputError for what is made of a run and takes more memory or time than one request may."""
    if cost.memory > FULL_COST.memory or cost.seconds > FULL_COST.seconds:
        remedy = f"at most {words_of(FULL_COST.memory)} and {FULL_COST.duration} here: fewer orders, or a coarser time step"
        raise InputError("run", f"{what} takes about {words_of(cost.memory)} and {cost.duration}", remedy)


def cost_of(system: System, settings: Settings) -> dict[str, Any]:
    """Return what a run is estimated to cost, as plain data: seconds within a factor of 3, bytes of memory."""
    cost = run_cost(system, settings)
    return {"seconds": cost.seconds, "duration": cost.duration, "memory": cost.memory}


def choices_of(system: System, settings: Settings) -> dict[str, Any]:
    """Return what full resolution would cost in other dimensions, and with another theory of each wall; null where it has no solution.

    Of a run in other dimensions the duration stays; the rest is as usual there.
    """
    other = replace(FULL if settings.dimensions == 3 else FULL_SPATIAL, duration=settings.duration)
    turned = {"thin": "elastic", "elastic": "thin"}
    theories = [
        _cost_if_solvable(system, settings, {f"shells[{index}].theory": turned[shell.theory]}) if isinstance(shell, Shell) else None
        for index, shell in enumerate(system.shells)
    ]
    return {"dimensions": _cost_if_solvable(system, other, {}), "theories": theories}


def _cost_if_solvable(system: System, settings: Settings, changes: Mapping[str, Any]) -> dict[str, Any] | None:
    try:
        changed = system.with_overrides(changes)
        require_solvable(changed, settings)
        return cost_of(changed, settings)
    except InputError:
        return None


def check_values(where: str, values: object) -> None:
    """Raise InputError for values of a study that are neither numbers nor short texts: a table could name a file of this machine."""
    for number, value in enumerate(values if isinstance(values, list) else ()):
        if not isinstance(value, int | float | str) or (isinstance(value, str) and (len(value) > TEXT or not value.isprintable())):
            raise InputError(f"{where}[{number}]", f"{shown(value)} is not taken here", "give numbers, or texts such as '6 mm'")


def check_path(where: str, path: str) -> None:
    """Raise InputError for the path of a field that nobody would type."""
    if len(path) > TEXT or not path.isprintable():
        raise InputError(where, f"{shown(path)} is not a path", "write it as source.peak_pressure or shells[0].radius")


def check_counts(where: str, largest: float) -> None:
    """Raise InputError for a study that goes to larger counts than the studio solves."""
    if largest > ABSORBERS:
        raise InputError(where, f"{largest:,.15g} is too many here", f"at most {ABSORBERS}")


def settings_of(given: object, *, live: bool, system: System | None = None) -> Settings:
    """Return the settings of a resolution, ``"preview"``, ``"full"`` or a table; InputError if it is not allowed or too fine.

    Times may be texts such as "3 ms" where the *system* is given, whose transits they become.
    """
    if given in ("preview", "full"):
        given = PREVIEW if given == "preview" else FULL
    elif not isinstance(given, dict):
        raise InputError("resolution", f"{shown(given)} is not allowed", "must be 'preview', 'full' or a table")
    for name in given if isinstance(given, dict) else ():
        if name not in ENTRIES:
            raise InputError(f"resolution.{name}", "is not an entry of a resolution", suggestion(name, ENTRIES))
    spatial = isinstance(given, dict) and str(given.get("dimensions")) == "3"
    settings = Settings.of(system, given, base=PREVIEW_SPATIAL if spatial else PREVIEW, where="resolution")
    modes, steps = settings.modes, settings.steps * settings.refinement
    if modes == "auto":
        raise InputError("resolution.modes", "'auto' is not allowed", f"give a whole number from 1 to {MODES}")
    most_modes, most_steps = (PREVIEW_MODES, PREVIEW_STEPS) if live else (MODES, STEPS)
    if modes > most_modes:
        raise _above("resolution.modes", modes, most_modes, "orders")
    if steps > most_steps:
        asked = f"{steps:,} time steps of {settings.time_step / settings.refinement:.3g} over {settings.duration:g} are too many here"
        least = settings.duration * settings.refinement / most_steps
        raise InputError("resolution.time_step", asked, f"at most {most_steps:,}: a step of {least:.3g} or more, or a shorter duration")
    if settings.refinement > REFINEMENT:
        raise _above("resolution.refinement", settings.refinement, REFINEMENT, "steps a step")
    if len(settings.stations) > STATIONS:
        raise _above("resolution.stations", len(settings.stations), STATIONS, "stations")
    if modes * steps > MODE_STEPS:
        raise _above("resolution", modes * steps, MODE_STEPS, "orders times steps")
    return settings


def table_of(settings: Settings) -> dict[str, Any]:
    """Return of the settings what a page may choose, by name, as :meth:`Settings.arguments`."""
    return {name: value for name, value in settings.arguments().items() if name in ENTRIES}


def wrong_with(given: object, system: System | None) -> list[InputError]:
    """Return all that is wrong with a resolution at which a run may be asked for; nothing with none."""
    found: list[InputError] = []
    left = dict(given) if isinstance(given, dict) else given
    if system is None and isinstance(left, dict):  # what a text is in transits cannot be told yet
        left = {name: value for name, value in left.items() if not isinstance(value, str)}
    while left is not None and len(found) <= len(ENTRIES):
        try:
            settings_of(left, live=False, system=system)
            break
        except InputError as error:
            found.append(error)
            name = error.where.removeprefix("resolution.").partition("[")[0]
            gone = (name, *AXIAL) if name == "dimensions" else (name,)  # without it, the others would be told to have no effect
            left = {key: value for key, value in left.items() if key not in gone} if isinstance(left, dict) and name in left else None
    return found


def _above(where: str, found: int, most: int, what: str) -> InputError:
    return InputError(where, f"{found:,} {what} are too many here", f"at most {most:,}")
