"""The summary of a run: peaks with their times and places, RMS, error estimates, warnings; and beside a drawing, for a notebook."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

from coaxshell.model.display import card
from coaxshell.model.places import shell_name
from coaxshell.model.prefixes import engineering
from coaxshell.numerics.circle import circle_angles
from coaxshell.response import arguments
from coaxshell.response.errors import error_table
from coaxshell.response.peaks import Peak, made_once, peak_anywhere, peak_at, root_mean_square
from coaxshell.response.quantities import QUANTITIES, Quantity, Where
from coaxshell.response.summary_text import summary_html, summary_text
from coaxshell.response.translation import still_grows
from coaxshell.response.voltages import actuator_limit, largest_mean
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.electrodes import Segment, segment_length
from coaxshell.solver.solution import ModalSolution


@dataclass(frozen=True)
class ShellSummary:
    """Peaks of one shell, each the largest magnitude within the window.

    Attributes
    ----------
    name : str
        "inner", "outer", "middle", "shell 2 of 4", ...
    stress_head, stress_tail, stress : Peak
        Design stress of the core (Eq. 22) at the head, at the tail and anywhere, Pa.
    stress_rms : float
        Its root mean square over the surface and the window, Pa.
    relative_displacement_head, relative_displacement_tail, relative_displacement : Peak
        Normal displacement relative to the translation of the shell's section (:mod:`coaxshell.response.translation`) at the head, at
        the tail and anywhere, m.
    displacement_head, displacement_tail : Peak
        Normal displacement itself, m; *growing* while the section's translation still grows at the end of the window.
    sensor_voltage : Peak or None
        Voltage of the sensor anywhere on the shell, as a mean over the segment, V, with what the lower half of the orders gives; None
        without a sensor.
    actuator_voltage : Peak or None
        Voltage that the control law asks for (before any saturation), anywhere on the shell, as a mean over the segment, V; None without
        control.
    segment : float or None
        Length of the wall over which voltages are means (:mod:`coaxshell.solver.electrodes`), m; 0 for points, None without a sensor.
    actuator_limit : float or None
        Volts that the actuator stands.
    stress_truncation : float
        Estimate of what the orders above M would add to the stress, relative (L2 over surface and time).
    errors : dict
        Estimated relative errors by quantity ("displacement", "stress") and cause ("orders", "time step", "march", "combined"), None where
        the engine does not estimate one; see :func:`coaxshell.response.errors.errors`.
    further : dict
        What else the table :mod:`coaxshell.response.quantities` shows in a summary, Peak, float or None by its key; each can be read as an
        attribute too.
    """

    name: str
    stress_head: Peak
    stress_tail: Peak
    stress: Peak
    stress_rms: float
    relative_displacement_head: Peak
    relative_displacement_tail: Peak
    relative_displacement: Peak
    displacement_head: Peak
    displacement_tail: Peak
    sensor_voltage: Peak | None
    actuator_voltage: Peak | None
    segment: float | None
    actuator_limit: float | None
    stress_truncation: float
    errors: dict[str, dict[str, float | None]]
    further: dict[str, Peak | float | None] = field(default_factory=dict)

    def __getattr__(self, name: str) -> Any:
        """Return what is among the further ones."""
        found = self.__dict__.get("further", {})
        if name not in found:
            raise AttributeError(f"{type(self).__name__!r} has no attribute {name!r}")
        return found[name]


_FIELDS = {one.name for one in fields(ShellSummary)}


@dataclass(frozen=True)
class Summary:
    """What a run came to; ``str(summary)`` is an aligned table.

    Attributes
    ----------
    title : str
        The system's name.
    window : tuple of float
        First and last instant looked at, transits.
    transit_time : float
        Seconds in a transit.
    shells : tuple of ShellSummary
        Elastic shells from the inside out; rigid ones are left out.
    absorber_displacement, absorber_force : float or None
        Largest magnitude over all absorbers (and both sides), m and N/m; None without absorbers.
    time_window_error : float
        Largest estimate of the error by the time step of any displacement, relative.
    settings : dict
        Resolution of the run.
    warnings : tuple of str
    """

    title: str
    window: tuple[float, float]
    transit_time: float
    shells: tuple[ShellSummary, ...]
    absorber_displacement: float | None
    absorber_force: float | None
    time_window_error: float
    settings: dict[str, Any]
    warnings: tuple[str, ...]

    def without_warnings(self) -> Summary:
        """Return the same without warnings, where they are told in another way."""
        return replace(self, warnings=())

    def to_dict(self) -> dict[str, Any]:
        """Return all of it as nested plain dicts, lists and numbers, ready for JSON."""
        plain = asdict(self)
        shells = [{**shell, **shell.pop("further")} for shell in plain["shells"]]
        return {**plain, "window": list(self.window), "shells": shells, "warnings": list(self.warnings)}

    def _repr_html_(self) -> str:
        return summary_html(self.to_dict())

    def __str__(self) -> str:
        """Return the aligned table."""
        return summary_text(self.to_dict())


def summarise(
    solution: ModalSolution,
    window: Sequence[float] | None = None,
    segment: Segment = None,
    *,
    motion: WallMotion | None = None,
    judged: bool = True,
) -> Summary:
    """Return the summary of a solution within a window (start, end) in transits, by default the whole run.

    The head is the point of the shell nearest to the first source, the tail the one opposite. Voltages are means over a segment of
    the wall: a length (m or text), None for what the pulse's band allows, or "point". Velocities and accelerations need the transforms
    of the run: they are given with its *motion*, and where the run has all its instants. Without being *judged* it has no warnings, NaN
    for its errors, which a run estimates only when they are read, and nothing of the lower half of the orders.

    Raises
    ------
    InputError
        If the window holds no instant of the run, or the segment is not allowed.
    """
    span = arguments.time_window(solution.time, window)
    time = solution.time[span]
    scales = solution.problem.scales
    elastic = [i for i, shell in enumerate(solution.problem.shells) if shell.moves]
    lengths = [segment_length(solution.problem, i, segment) for i in elastic]  # all checked before the first is computed
    walls, rates = motion or WallMotion(solution), motion is not None
    shells = tuple(_shell(walls, i, span, length, rates=rates, judged=judged) for i, length in zip(elastic, lengths, strict=True))
    q, f = solution.absorber_displacement, solution.absorber_force
    return Summary(
        title=solution.problem.system.name,
        window=(float(time[0]), float(time[-1])),
        transit_time=scales.time,
        shells=shells,
        absorber_displacement=None if q is None or not len(q) else float(abs(q[..., span]).max()) * scales.length,
        absorber_force=None if f is None or not len(f) else float(abs(f[..., span]).max()) * scales.line_force,
        time_window_error=float(solution.estimates.time_window) if judged else math.nan,
        settings=solution.settings.arguments(),
        warnings=tuple(solution.warnings) if judged else (),
    )


def _shell(motion: WallMotion, shell: int, span: slice, length: float, *, rates: bool, judged: bool) -> ShellSummary:
    solution = motion.solution
    problem = solution.problem
    wall = problem.shells[shell]
    found: dict[str, Any] = {}
    for quantity in QUANTITIES.values():
        if quantity.dimensions == 3 and solution.along is None:
            continue
        if not quantity.given(motion, shell) or (quantity.rate and not rates):
            found |= dict.fromkeys(quantity.summary_keys)
        elif quantity.summary:
            found |= largest_magnitudes(quantity, motion, shell, span, length, judged=judged)
    return ShellSummary(
        name=shell_name(shell, len(problem.shells)),
        segment=length if wall.has("sensor") else None,
        actuator_limit=actuator_limit(solution, shell).volts if wall.has("actuator") else None,
        stress_truncation=float(solution.estimates.modal_stress[shell]) if judged else math.nan,
        errors=error_table(solution, shell) if judged else {},
        further={key: found.pop(key) for key in list(found) if key not in _FIELDS},
        **found,
    )


def largest_magnitudes(
    quantity: Quantity, motion: WallMotion, shell: int, span: slice, length: float = 0.0, *, judged: bool = True
) -> dict[str, Peak | float | None]:
    """Return the largest magnitudes of a quantity of a shell that the summary shows, by their keys.

    Parameters
    ----------
    quantity : Quantity
    motion : WallMotion
    shell : int
    span : slice
        Time indices.
    length : float
        Of the segment (m) that voltages are means over; 0 for a point.
    judged : bool
        Whether voltages are told with what the lower half of the orders gives.
    """
    solution, wanted = motion.solution, quantity.summary
    if quantity.largest is not None:
        return {quantity.name: quantity.largest(solution, shell, span, length, halved=judged)}
    if quantity.modal is not None:
        return {quantity.name: largest_mean(solution, shell, quantity.amplitudes(motion, shell), span, length, halved=judged)}
    head, time = solution.problem.system.sources[0].angle, solution.time
    width = len(circle_angles(solution.normal.shape[2], solution.normal.shape[1]))
    amplitudes = made_once(quantity.amplitudes(motion, shell), span)
    found: dict[Where, Peak | float | None] = {}
    if "head" in wanted:
        found["head"], found["tail"] = peaks = peak_at(amplitudes, time, span, [head, head + 180.0])
    if "anywhere" in wanted:
        anywhere = peak_anywhere(amplitudes, time, span, width)
        beside = peaks if "head" in wanted else []
        found["anywhere"] = max([anywhere, *beside], key=lambda peak: peak.value)  # never below a point shown beside it
    if "rms" in wanted:
        found["rms"] = root_mean_square(amplitudes, time, span, width)
    drifting = quantity.drifts and still_grows(solution, shell, span)
    return {quantity.key(where): replace(one, growing=True) if drifting and isinstance(one, Peak) else one for where, one in found.items()}


def response_card(solution: ModalSolution) -> str:
    """Return the drawing of the system that was solved beside its peaks, error estimates and warnings, as HTML."""
    found = summarise(solution)
    rows = [
        ("", *("stress: head", "tail", "anywhere", "RMS", "relative displacement: head", "tail")),
        *(_row(shell) for shell in found.shells),
    ]
    return card(solution.problem.system, found.title or "unnamed system", rows, _notes(found))


def _row(shell: ShellSummary) -> tuple[str, ...]:
    stresses = (shell.stress_head.value, shell.stress_tail.value, shell.stress.value, shell.stress_rms)
    return (
        shell.name,
        *(engineering(value, "Pa") for value in stresses),
        *(engineering(peak.value, "m") for peak in (shell.relative_displacement_head, shell.relative_displacement_tail)),
    )


def _notes(found: Summary) -> list[str]:
    settings = found.settings
    left_out = ", ".join(f"{shell.name} {shell.stress_truncation:.1e}" for shell in found.shells)
    return [
        f"{settings['engine']} engine, {settings['modes']} modes, time step {settings['time_step']:g}, "
        f"t = {found.window[0]:g} to {found.window[1]:g} transits of {engineering(found.transit_time, 's')}",
        *([f"estimated relative error of the stress: {left_out}"] if left_out else []),
        *(f"warning: {text}" for text in found.warnings),
    ]
