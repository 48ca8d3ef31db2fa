"""What control costs: voltage, field, charge, current and power of each shell, against what material and amplifier stand."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from functools import partial
from html import escape
from typing import TYPE_CHECKING, Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.gains import law_of, wired
from coaxshell.model.parts import laws_of, shells_under
from coaxshell.model.places import shell_name
from coaxshell.model.prefixes import engineering
from coaxshell.model.shells import Shell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.numerics.scalars import plain
from coaxshell.response.peaks import folded
from coaxshell.response.summary_text import aligned
from coaxshell.response.voltages import CutElectrode, actuator_limit, cut_voltage, largest_demanded_voltage, largest_mean
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.electrodes import Segment, segment_length
from coaxshell.structure.electroded_wall import ElectrodedWall

if TYPE_CHECKING:
    from coaxshell.response.electrical import OfSegments

ROWS = (
    ("voltage", "largest voltage", "V"),
    ("field", "largest field", "V/m"),
    ("charge", "largest charge", "C/m^2"),
    ("current", "largest current", "A/m^2"),
    ("real_power", "largest real power", "W/m"),
    ("apparent_power", "largest apparent power", "VA/m"),
    ("energy", "energy from the amplifier", "J/m"),
)
"""Attribute, words and unit of all that a shell's table tells."""
_TOTALS = ("real_power", "apparent_power", "energy")
"""What adds up over the segments of a wall."""
LIMITS = ("voltage", "current", "apparent_power")
"""What an amplifier may be limited in."""


@dataclass(frozen=True)
class SegmentEffort:
    """What the amplifier of one segment is asked for, largest magnitudes.

    Attributes
    ----------
    segment : int
        0 has its middle at theta = 0, the others follow counterclockwise.
    angle : float
        Of its middle, degrees, -180 to 180.
    voltage, field, charge, current : float
        V, V/m in the thinnest actuator, as asked for before any limit; C/m^2 and A/m^2 of all actuators together, the current a mean
        over a step and 0 of dead ones, which have no amplifier.
    real_power, apparent_power : float
        W and VA per metre of length; apparent is the largest voltage times the largest current, whenever they are.
    energy : float
        What the amplifier has given when the run ends, J per metre of length.
    """

    segment: int
    angle: float
    voltage: float
    field: float
    charge: float
    current: float
    real_power: float
    apparent_power: float
    energy: float


@dataclass(frozen=True)
class ShellEffort:
    """What the actuators of one shell are asked for, largest magnitudes.

    None where the paper's law, which has no charge, controls it, and at stations of elastic walls, which keep none.

    Attributes
    ----------
    shell : str
    voltage, charge, current : float
        Means over a segment of the wall, V, C/m^2 and A/m^2 of all actuators of the wall together; where electrodes are cut voltage and
        current (over a step) of their own segments.
    field : float
        V/m, in the thinnest actuator.
    real_power, apparent_power : float
        W and VA per metre of length, of the whole circumference.
    energy : float
        What the amplifier has given when the run ends, J per metre of length.
    limits : dict
        Of the material ("field", V/m) and of the amplifier, as far as they are known.
    segments : tuple of SegmentEffort
        Of each segment, where electrodes are cut: every one has an amplifier of its own, and the limits are those of one. Voltage, field,
        charge and current are then those of the segment that is asked for most.
    """

    shell: str
    voltage: float
    field: float
    charge: float | None
    current: float | None
    real_power: float | None
    apparent_power: float | None
    energy: float | None
    limits: dict[str, float]
    segments: tuple[SegmentEffort, ...] = ()

    @property
    def shares(self) -> dict[str, float]:
        """Share of each limit that is used, where electrodes are cut by the segment that uses most; 1 is all of it."""
        return {name: value / limit for name, limit in self.limits.items() if (value := self._limited(name)) is not None}

    def worst(self, name: str) -> SegmentEffort:
        """Return the segment with the largest voltage, field, charge, current, real or apparent power, or energy.

        Raises
        ------
        InputError
            If electrodes are whole, or the name is none of these.
        """
        if not self.segments:
            raise InputError("shell", f"electrodes of {self.shell!r} are whole", "cut them: control.segments")
        known = [one for one, *_ in ROWS]
        if name not in known:
            raise InputError("name", f"{name!r} is told of no segment", f"allowed: {', '.join(known)}")
        return max(self.segments, key=lambda one: float(getattr(one, name)))

    def _limited(self, name: str) -> float | None:
        told: float | None = getattr(self.worst(name) if self.segments else self, name)
        return told


@dataclass(frozen=True)
class ControlEffort:
    """The effort of all controlled shells; ``str(effort)`` is an aligned table."""

    shells: tuple[ShellEffort, ...]

    def __getitem__(self, shell: str) -> ShellEffort:
        """Return that of a shell by its name."""
        known = {one.shell: one for one in self.shells}
        if shell not in known:
            raise InputError("shell", f"{shell!r} is not a controlled shell", f"allowed: {', '.join(known)}")
        return known[shell]

    @property
    def within(self) -> bool:
        """Whether no limit is exceeded."""
        return all(share <= 1.0 for one in self.shells for share in one.shares.values())

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain data, ready for JSON."""
        return {"shells": [{**asdict(one), "shares": one.shares} for one in self.shells], "within": self.within}

    def __str__(self) -> str:
        """Return the aligned table; where electrodes are cut it names the segment that is asked for most."""
        cut = any(one.segments for one in self.shells)
        head = ("shell", "effort", "value", "limit", "share", *(["segment"] if cut else []))
        return "\n".join(aligned([head, *self._rows(cut)], left=2))

    def _repr_html_(self) -> str:
        return f"<pre>{escape(str(self))}</pre>"

    def _rows(self, cut: bool) -> Iterator[tuple[str, ...]]:
        for one in self.shells:
            for name, words, unit in ROWS:
                if (value := getattr(one, name)) is None:
                    continue
                total = bool(one.segments) and name in _TOTALS
                limit = None if total else one.limits.get(name)
                row = (one.shell, f"{words}, all segments" if total else words, *_beside(value, limit, unit))
                worst = one.worst(name) if one.segments else None
                yield row if not cut else (*row, "" if total or worst is None else str(worst.segment))
                if total and worst is not None:
                    largest = getattr(worst, name)
                    words = "largest voltage times current" if name == "apparent_power" else words
                    yield (one.shell, f"{words}, one segment", *_beside(largest, one.limits.get(name), unit), str(worst.segment))


def _beside(value: float, limit: float | None, unit: str) -> tuple[str, str, str]:
    """Return a value, its limit and its share of it as they are shown."""
    shown = ("", "") if limit is None else (engineering(limit, unit), f"{100.0 * value / limit:.3g} %")
    return engineering(value, unit), *shown


def control_effort(motion: WallMotion, segment: Segment = None, **limits: float | None) -> ControlEffort:
    """Return what control costs on every controlled shell.

    Parameters
    ----------
    motion : WallMotion
        Of a run with all its instants, or of a station of one in three dimensions.
    segment : float, str or None
        Length of the wall over which voltages, charges and currents are means, as in the summary; "point" for points.
    **limits : float
        Of the amplifier, of each segment where electrodes are cut: voltage (V), current (A per m^2 of electrode; that of the law unless
        given), apparent_power (VA per metre of length).

    Raises
    ------
    InputError
        If nothing is controlled, or a limit is unknown or not positive.
    """
    solution = motion.solution
    system = solution.problem.system
    controlled = [i for i in system.controlled_shells if wired(system, i, "actuator")]
    if not controlled:
        raise InputError("control", "nothing is fed back", "give the system a PDControl or a Feedback")
    known = {name: _positive(name, value) for name, value in limits.items() if value is not None}
    return ControlEffort(tuple(_of_shell(motion, i, segment, known) for i in controlled))


def _positive(name: str, value: Any) -> float:
    if name not in LIMITS:
        raise InputError(name, "is no limit of an amplifier", f"allowed: {', '.join(LIMITS)}")
    number = plain(value)
    if isinstance(number, bool) or not isinstance(number, int | float) or not 0.0 < number < float("inf"):
        raise InputError(name, f"{value!r} is not allowed", "give a positive number")
    return float(number)


def _of_shell(motion: WallMotion, shell: int, segment: Segment, limits: dict[str, float]) -> ShellEffort:
    from coaxshell.response.electrical import charge, current, of_segments, power  # with energies, which take long to import

    solution, everything = motion.solution, slice(0, motion.solution.time.size)
    system, length = solution.problem.system, segment_length(solution.problem, shell, segment)
    wall = system.shells[shell]
    assert isinstance(wall, Shell)
    thinnest = min(layer.thickness for layer in wall.serving("actuator"))
    volts = largest_demanded_voltage(solution, shell, everything, length, halved=False).value
    law = law_of(system, shell)
    field_limit = actuator_limit(solution, shell).volts / thinnest
    found: dict[str, float | None] = dict.fromkeys(("charge", "current", "real_power", "apparent_power", "energy"))
    segments: tuple[SegmentEffort, ...] = ()
    known = solution.along is None or isinstance(solution.problem.shells[shell], ElectrodedWall)  # no station keeps charges of solids
    told = known and law is not None and law.transducers == "electrodes"
    step = solution.settings.time_step * solution.problem.scales.time
    if (cut := of_segments(motion, shell)) is not None:
        asked = cut_voltage(solution, shell, asked=True)
        segments = tuple(_of_segment(cut, asked, number, thinnest, step) for number in range(cut.segments.count))
        found |= {name: max(getattr(one, name) for one in segments) for name in ("charge", "current")}
    elif told:
        for name, modal in (("charge", charge(motion, shell)), ("current", current(motion, shell))):
            found[name] = largest_mean(solution, shell, partial(_window, modal), everything, length, halved=False).value
    if told:
        used = power(motion, shell)
        found["real_power"], found["apparent_power"] = float(np.abs(used.real).max()), float(used.apparent.max())
        found["energy"] = used.energy
    if law is not None and law.current_limit is not None:
        limits = {"current": law.current_limit, **limits}
    if law is not None and law.current_saturation and law.current_limit is not None:  # steps in which it begins to be held overshoot
        found["current"] = None if found["current"] is None else min(found["current"], law.current_limit)
        segments = tuple(replace(one, current=min(one.current, law.current_limit)) for one in segments)
    return ShellEffort(
        shell=shell_name(shell, len(system.shells)),
        voltage=volts,
        field=volts / thinnest,
        limits={"field": field_limit, **limits} if np.isfinite(field_limit) else dict(limits),
        segments=segments,
        **found,
    )


def _of_segment(cut: OfSegments, asked: CutElectrode | None, number: int, thinnest: float, step: float) -> SegmentEffort:
    given, real = float(np.abs(cut.voltage[number]).max()), cut.power[number]
    volts = given if asked is None else float(np.abs(asked.voltage[number]).max())
    current = 0.0 if number in cut.segments.dead else float(np.abs(np.diff(cut.charge[number])).max()) / step
    return SegmentEffort(
        segment=number,
        angle=folded(float(np.degrees(cut.segments.centres[number]))),
        voltage=volts,
        field=volts / thinnest,
        charge=float(np.abs(cut.charge[number]).max()),
        current=current,
        real_power=float(np.abs(real).max()),
        apparent_power=cut.width * given * current,
        energy=float(cut.energy[number]),
    )


def _window(modal: FloatArray, block: slice) -> FloatArray:
    return modal[..., block]


def electrical_power(motion: WallMotion) -> xr.Dataset:
    """Return real and apparent power of the actuators between electrodes over time, W/m and VA/m, dims (shell, time).

    Where these are cut also the real power of each segment, dims (shell, segment, time).

    Raises
    ------
    InputError
        If no shell is controlled by electrodes, or instants of the run are missing.
    """
    from coaxshell.response.electrical import of_segments, power

    solution = motion.solution
    system = solution.problem.system
    electrodes = [law for law in laws_of(system) if law.transducers == "electrodes"]
    shells = [i for law in electrodes for i in shells_under(system, law) if wired(system, i, "actuator")]
    if not shells or solution.along is not None:
        remedy = 'use transducers = "electrodes", in two dimensions'
        raise InputError("control", "no shell is driven by electrodes whose charge is known", remedy)
    found = [power(motion, i) for i in sorted(shells)]
    names = [shell_name(i, len(system.shells)) for i in sorted(shells)]
    told = {"real_power": ("W/m", "power of the amplifier"), "apparent_power": ("VA/m", "root mean square voltage times current, around")}

    def stacked(name: str) -> FloatArray:
        return np.stack([getattr(one, name.removesuffix("_power")) for one in found])

    variables = {
        name: xr.Variable(("shell", "time"), stacked(name), {"units": unit, "long_name": long_name})
        for name, (unit, long_name) in told.items()
    }
    cut = [of_segments(motion, i) for i in sorted(shells)]
    if all(cut):
        each = np.stack([one.power for one in cut if one is not None])
        told_of = {"units": "W/m", "long_name": "power of the amplifier of a segment"}
        variables["segment_power"] = xr.Variable(("shell", "segment", "time"), each, told_of)
    return xr.Dataset(variables, {"shell": xr.Variable("shell", names), "time": xr.Variable("time", solution.time, {"units": "a/c"})})
