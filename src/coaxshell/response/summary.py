"""The summary of a run: peaks with their times and places, RMS, error estimates, warnings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from coaxshell.acoustics.circle import circle_angles
from coaxshell.model.naming import shell_name
from coaxshell.response import arguments
from coaxshell.response.modal import Gain, amplitudes, displacement_gain, stress_gain_of, voltage_gain
from coaxshell.response.peaks import Amplitudes, Peak, peak_anywhere, peak_at, root_mean_square
from coaxshell.response.summary_text import summary_text
from coaxshell.response.voltages import actuator_limit, demanded_voltage
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
    displacement_head, displacement_tail : Peak
        Normal displacement, m.
    sensor_voltage : Peak or None
        Anywhere on the shell, V; None without a sensor.
    actuator_voltage : Peak or None
        What the control law asks for (before any saturation), anywhere, V; None without control.
    actuator_limit : float or None
        Volts that the actuator stands.
    stress_truncation : float
        Estimate of what the orders above M would add to the stress, relative (L2 over surface and time).
    """

    name: str
    stress_head: Peak
    stress_tail: Peak
    stress: Peak
    stress_rms: float
    displacement_head: Peak
    displacement_tail: Peak
    sensor_voltage: Peak | None
    actuator_voltage: Peak | None
    actuator_limit: float | None
    stress_truncation: float


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
        Estimate of the error of the inverse transform, relative.
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

    def to_dict(self) -> dict[str, Any]:
        """Return all of it as nested plain dicts, lists and numbers, ready for JSON."""
        plain = asdict(self)
        return {**plain, "window": list(self.window), "shells": list(plain["shells"]), "warnings": list(self.warnings)}

    def __str__(self) -> str:
        """Return the aligned table."""
        return summary_text(self.to_dict())


def summarise(solution: ModalSolution, window: Sequence[float] | None = None) -> Summary:
    """Return the summary of a solution within a window (start, end) in transits, by default the whole run.

    The head is the point of the shell nearest to the first source, the tail the one opposite.

    Raises
    ------
    InputError
        If the window holds no instant of the run.
    """
    span = arguments.time_window(solution.time, window)
    time = solution.time[span]
    scales = solution.problem.scales
    shells = tuple(_shell(solution, i, span) for i, shell in enumerate(solution.problem.shells) if shell.section is not None)
    q, f = solution.absorber_displacement, solution.absorber_force
    return Summary(
        title=solution.problem.system.name,
        window=(float(time[0]), float(time[-1])),
        transit_time=scales.time,
        shells=shells,
        absorber_displacement=None if q is None or not len(q) else float(abs(q[..., span]).max()) * scales.length,
        absorber_force=None if f is None or not len(f) else float(abs(f[..., span]).max()) * scales.line_force,
        time_window_error=float(solution.estimates.time_window),
        settings=asdict(solution.settings),
        warnings=tuple(solution.warnings),
    )


def _shell(solution: ModalSolution, shell: int, span: slice) -> ShellSummary:
    head = solution.problem.system.sources[0].angle
    ends = [head, head + 180.0]
    width = len(circle_angles(solution.normal.shape[2], solution.normal.shape[1]))
    time = solution.time
    section = solution.problem.shells[shell].section
    assert section is not None  # the caller leaves rigid shells out

    def of(gain: Gain) -> Amplitudes:
        return lambda block: amplitudes(solution, shell, gain, block)

    stress = of(stress_gain_of(solution, shell))
    stress_head, stress_tail = peak_at(stress, time, span, ends)
    displacement_head, displacement_tail = peak_at(of(displacement_gain(solution)), time, span, ends)
    sensor = of(voltage_gain(solution, shell)) if section.layer("sensor") else None
    anywhere = peak_anywhere(stress, time, span, width)
    return ShellSummary(
        name=shell_name(shell, len(solution.problem.shells)),
        stress_head=stress_head,
        stress_tail=stress_tail,
        stress=max(anywhere, stress_head, stress_tail, key=lambda peak: peak.value),  # never below a point shown beside it
        stress_rms=root_mean_square(stress, time, span, width),
        displacement_head=displacement_head,
        displacement_tail=displacement_tail,
        sensor_voltage=peak_anywhere(sensor, time, span, width) if sensor else None,
        actuator_voltage=_actuator(solution, shell, span, width),
        actuator_limit=actuator_limit(solution, shell).volts if section.layer("actuator") else None,
        stress_truncation=float(solution.estimates.modal_stress[shell]),
    )


def _actuator(solution: ModalSolution, shell: int, span: slice, width: int) -> Peak | None:
    if solution.problem.shells[shell].gains is None:
        return None
    voltage = demanded_voltage(solution, shell)  # whole, because its derivative needs the neighbours of every instant
    return peak_anywhere(lambda block: voltage[:, :, block], solution.time, span, width)
