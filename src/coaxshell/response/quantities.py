"""What can be read of a shell, one entry each: a table that histories, the summary, metrics, plots, exports and comparisons all read.

A new output is one entry here and one function: its gain, where it is a linear combination of V and W of the same order, else its values
at angles. It then has histories (:meth:`Response.history`) and modal amplitudes, can be drawn, compared with another code's and asked for
in a study, and stands in the tables, files and pages that the entry names.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from coaxshell.model import Shell, System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.labels import ALONG_AXIS, COUNTERCLOCKWISE, INWARD, TENSION
from coaxshell.response.modal import (
    amplitudes,
    axial_gain,
    combined,
    displacement_gain,
    stress_gain_of,
    tangential_gain,
    voltage_gain,
)
from coaxshell.response.peaks import Amplitudes, Peak
from coaxshell.response.relaxing import Relaxing
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.response.translation import relative_gain, relative_tangential_gain
from coaxshell.response.voltages import actuator_values, largest_demanded_voltage, largest_sensor_voltage
from coaxshell.response.wall_motion import WallMotion
from coaxshell.response.wall_stress import largest_of_the_core, largest_through_wall, of_the_core, searchable, through_wall
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.shell_model import FieldGain, Gain

Where = Literal["head", "tail", "anywhere", "rms"]
Needs = Literal["", "elastic", "sensor", "control"]

_ROLES: dict[Needs, tuple[str, ...]] = {"": (), "elastic": (), "sensor": ("sensor",), "control": ("sensor", "actuator")}
_PLACES: dict[Where, str] = {"head": "at head", "tail": "at tail", "anywhere": "anywhere", "rms": "RMS"}
_SUFFIXES: dict[Where, str] = {"head": "_head", "tail": "_tail", "anywhere": "", "rms": "_rms"}


class Largest(Protocol):
    """The largest magnitude of a quantity within a window of time, as a mean over a segment of the wall."""

    def __call__(self, solution: ModalSolution, shell: int, window: slice, length: float, *, halved: bool = True) -> Peak:
        """Return the largest magnitude, the length in m; and what the lower half of the orders gives, where that is told and ``halved``."""


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """One output of a shell.

    Attributes
    ----------
    name : str
        By which it is asked for.
    label : str
        What an axis says, without the unit.
    noun : str
        What a row of a table says before the place, as in "stress at head".
    long_name, unit, sign : str
        Attributes of its histories: what it is, in which SI unit, which direction counts positive.
    gain : callable (solution, shell), or None
        Value per unit V and W of each order; None for what is no linear combination of them.
    values : callable (motion, shell, angles in degrees), or None
        Values at angles, shape (T, A); None where the gain gives them.
    largest : callable, or None
        Where the summary shows means over a segment of the wall.
    rate : int
        Order of the time derivative, 0, 1 or 2, of what the gain gives; from the transforms (:mod:`coaxshell.response.wall_motion`).
    needs : str
        What a shell must have: "" nothing, "elastic" a wall that is not rigid, "sensor" that layer, "control" both layers and gains.
    component : str
        "normal" for what has cos(m theta) in parity 0, "tangential" for sin(m theta).
    partner : str
        Name of the tangential component, for what is a vector.
    shown : tuple (str, float)
        Unit in which it is drawn, and how many of these one SI unit is.
    colour : str
        Of its curve, a name of :data:`coaxshell.plotting.COLOURS`.
    column : bool
        Whether tables, exports, comparisons and the studio hold it at head and tail.
    drifts : bool
        Whether it holds the translation of the section, which grows for as long as water flows past.
    array : str
        Name of its labelled arrays, where that is another.
    relaxes : bool
        Whether losses of a wall's layers are in it.
    through : bool
        Whether the depths of a wall are searched, which thin walls tell alone.
    summary, metrics : tuple of str
        Where the summary shows its largest magnitude, and where a study can ask for it: "head", "tail", "anywhere"; "rms".
    dimensions : int
        3 for what only a station of a three-dimensional run has.
    """

    name: str
    label: str
    noun: str
    long_name: str
    unit: str
    sign: str
    gain: Callable[[ModalSolution, int], Gain | FieldGain | Relaxing] | None = None
    values: Callable[[WallMotion, int, FloatArray], FloatArray] | None = None
    largest: Largest | None = None
    rate: int = 0
    needs: Needs = "elastic"
    component: str = "normal"
    partner: str = ""
    shown: tuple[str, float] = ("", 1.0)
    colour: str = "blue"
    column: bool = False
    drifts: bool = False
    array: str = ""
    relaxes: bool = False
    through: bool = False
    summary: tuple[Where, ...] = ()
    metrics: tuple[Where, ...] = ()
    dimensions: int = 2

    @property
    def stem(self) -> str:
        """Name of the quantity within the names of metrics."""
        return self.name.removeprefix("shell_")

    def key(self, where: Where) -> str:
        """Return the name of its largest magnitude at a place in the summary."""
        return self.name + _SUFFIXES[where]

    def metric(self, where: Where) -> str:
        """Return the name by which a study asks for it at a place."""
        return f"rms_{self.stem}" if where == "rms" else f"peak_{self.stem}{_SUFFIXES[where]}"

    @property
    def summary_keys(self) -> list[str]:
        """Names of all that the summary shows of it."""
        return [self.key(where) for where in self.summary]

    @property
    def words(self) -> str:
        """Name of the quantity in headings."""
        return self.name.replace("_", " ")

    @property
    def axis(self) -> str:
        """Label of an axis, with the unit drawn."""
        return f"{self.label} ({self.shown[0] or self.unit})"

    @property
    def roles(self) -> tuple[str, ...]:
        """Layers that a shell must have, by their roles."""
        return _ROLES[self.needs]

    def lack(self, system: System, shell: int) -> str | None:
        """Return what a shell would have to be for it to have this quantity, as in "is not rigid"; None if it has."""
        wall = system.shells[shell]
        if not self.needs:
            return None
        if not isinstance(wall, Shell):
            return "is not rigid"
        missing = next((role for role in self.roles if getattr(wall, role) is None), None)
        if missing is not None:
            return f"has a layer with the role {missing!r}"
        return "is controlled" if self.needs == "control" and shell not in system.controlled_shells else None

    def at(self, motion: WallMotion, shell: int, theta: FloatArray) -> FloatArray:
        """Return its values at angles (degrees), SI, shape (T, A)."""
        if self.values is not None:
            return self.values(motion, shell, theta)
        assert self.gain is not None
        if self.rate:
            parities, modes = motion.solution.normal.shape[1:3]
            basis = angle_basis(np.atleast_1d(theta), modes, parities, self.component)
            gain = self.gain(motion.solution, shell)
            assert not isinstance(gain, Relaxing)  # no rate of a stress is a quantity
            return motion.rates_at(shell, gain, self.rate, basis)
        return combined(motion.solution, shell, self.gain(motion.solution, shell), theta, self.component)

    def amplitudes(self, motion: WallMotion, shell: int) -> Amplitudes:
        """Return what gives its modal amplitudes, SI, at a slice of time indices."""
        assert self.gain is not None
        return motion.amplitudes(shell, self.gain(motion.solution, shell), self.rate)

    def given(self, motion: WallMotion, shell: int) -> bool:
        """Return whether a run gives it for a shell: the shell has it, and where its transform is needed the run all its instants."""
        solution = motion.solution
        wall = solution.problem.shells[shell]
        there = (self.dimensions == 2 or solution.along is not None) and (not self.through or searchable(solution, shell))
        needed = self.rate or int(self.relaxes and wall.relaxes)
        return there and motion.has_rate(needed) and self.lack(solution.problem.system, shell) is None


def _displacement(motion: WallMotion, shell: int, theta: FloatArray, component: str = "normal") -> FloatArray:
    modal = motion.solution.normal[shell] if component == "normal" else motion.solution.tangential[shell]
    basis = angle_basis(np.atleast_1d(theta), modal.shape[1], modal.shape[0], component)
    return np.asarray(motion.solution.problem.scales.length * at_angles(modal, basis), dtype=np.float64)


def _tangential_displacement(motion: WallMotion, shell: int, theta: FloatArray) -> FloatArray:
    return _displacement(motion, shell, theta, "tangential")


def _sensor_voltage(motion: WallMotion, shell: int, theta: FloatArray) -> FloatArray:
    modal = amplitudes(motion.solution, shell, voltage_gain(motion.solution, shell))
    return at_angles(modal, angle_basis(np.atleast_1d(theta), modal.shape[1], modal.shape[0]))


def _actuator_voltage(motion: WallMotion, shell: int, theta: FloatArray) -> FloatArray:
    return actuator_values(motion.solution, shell, theta)


_TABLE: tuple[Quantity, ...] = (
    Quantity(
        name="stress",
        label="hoop stress",
        noun="stress",
        long_name="mid-surface hoop stress of the core",
        unit="Pa",
        sign=TENSION,
        gain=stress_gain_of,
        relaxes=True,
        shown=("MPa", 1e-6),
        column=True,
        summary=("head", "tail", "anywhere", "rms"),
        metrics=("anywhere", "head", "tail", "rms"),
    ),
    Quantity(
        name="relative_displacement",
        label="inward displacement, relative",
        noun="relative displacement",
        long_name="normal displacement relative to the section's translation",
        unit="m",
        sign=INWARD,
        gain=lambda solution, _: relative_gain(solution),
        needs="",
        partner="relative_tangential_displacement",
        shown=("µm", 1e6),
        colour="orange",
        array="relative_normal_displacement",
        summary=("head", "tail", "anywhere"),
        metrics=("anywhere", "head", "tail"),
    ),
    Quantity(
        name="displacement",
        label="inward displacement",
        noun="absolute displacement",
        long_name="normal displacement",
        unit="m",
        sign=INWARD,
        gain=lambda solution, _: displacement_gain(solution),
        values=_displacement,
        needs="",
        partner="tangential_displacement",
        shown=("µm", 1e6),
        colour="orange",
        column=True,
        drifts=True,
        array="normal_displacement",
        summary=("head", "tail"),
        metrics=("anywhere", "head", "tail"),
    ),
    Quantity(
        name="tangential_displacement",
        label="tangential displacement",
        noun="tangential displacement",
        long_name="tangential displacement",
        unit="m",
        sign=COUNTERCLOCKWISE,
        gain=lambda solution, _: tangential_gain(solution),
        values=_tangential_displacement,
        needs="",
        component="tangential",
        shown=("µm", 1e6),
        colour="orange",
    ),
    Quantity(
        name="relative_tangential_displacement",
        label="tangential displacement, relative",
        noun="relative tangential displacement",
        long_name="tangential displacement relative to the section's translation",
        unit="m",
        sign=COUNTERCLOCKWISE,
        gain=lambda solution, _: relative_tangential_gain(solution),
        needs="",
        component="tangential",
        shown=("µm", 1e6),
        colour="orange",
    ),
    Quantity(
        name="shell_velocity",
        label="inward velocity",
        noun="shell velocity",
        long_name="normal velocity of the mid-surface",
        unit="m/s",
        sign=INWARD,
        gain=lambda solution, _: displacement_gain(solution),
        rate=1,
        needs="",
        partner="tangential_shell_velocity",
        shown=("mm/s", 1e3),
        colour="orange",
        column=True,
        summary=("anywhere",),
        metrics=("anywhere", "head", "tail", "rms"),
    ),
    Quantity(
        name="tangential_shell_velocity",
        label="tangential velocity",
        noun="tangential shell velocity",
        long_name="tangential velocity of the mid-surface",
        unit="m/s",
        sign=COUNTERCLOCKWISE,
        gain=lambda solution, _: tangential_gain(solution),
        rate=1,
        needs="",
        component="tangential",
        shown=("mm/s", 1e3),
        colour="orange",
    ),
    Quantity(
        name="shell_acceleration",
        label="inward acceleration",
        noun="shell acceleration",
        long_name="normal acceleration of the mid-surface",
        unit="m/s^2",
        sign=INWARD,
        gain=lambda solution, _: displacement_gain(solution),
        rate=2,
        needs="",
        partner="tangential_shell_acceleration",
        shown=("m/s²", 1.0),
        colour="orange",
        column=True,
        summary=("anywhere",),
        metrics=("anywhere", "head", "tail", "rms"),
    ),
    Quantity(
        name="tangential_shell_acceleration",
        label="tangential acceleration",
        noun="tangential shell acceleration",
        long_name="tangential acceleration of the mid-surface",
        unit="m/s^2",
        sign=COUNTERCLOCKWISE,
        gain=lambda solution, _: tangential_gain(solution),
        rate=2,
        needs="",
        component="tangential",
        shown=("m/s²", 1.0),
        colour="orange",
    ),
    Quantity(
        name="sensor_voltage",
        label="sensor voltage",
        noun="sensor voltage",
        long_name="open-circuit voltage of the sensor",
        unit="V",
        sign="of phi_s in Eq. 20",
        gain=voltage_gain,
        values=_sensor_voltage,
        largest=largest_sensor_voltage,
        needs="sensor",
        shown=("V", 1.0),
        colour="green",
        column=True,
        summary=("anywhere",),
        metrics=("anywhere",),
    ),
    Quantity(
        name="actuator_voltage",
        label="actuator voltage",
        noun="actuator voltage asked",
        long_name="control voltage on the actuator",
        unit="V",
        sign="of u in Eq. 17",
        values=_actuator_voltage,
        largest=largest_demanded_voltage,
        needs="control",
        shown=("kV", 1e-3),
        colour="purple",
        column=True,
        summary=("anywhere",),
    ),
)

_TABLE += (
    Quantity(
        name="axial_stress",
        label="axial stress",
        noun="axial stress",
        long_name="mid-surface axial stress of the core",
        unit="Pa",
        sign=TENSION,
        gain=lambda solution, shell: stress_gain_of(solution, shell, component="axial"),
        relaxes=True,
        shown=("MPa", 1e-6),
        column=True,
        summary=("head", "tail", "anywhere"),
        metrics=("anywhere", "head", "tail"),
        dimensions=3,
    ),
    Quantity(
        name="shear_stress",
        label="shear stress",
        noun="shear stress",
        long_name="mid-surface shear stress of the core between hoop and axis",
        unit="Pa",
        sign=COUNTERCLOCKWISE,
        gain=lambda solution, shell: stress_gain_of(solution, shell, component="shear"),
        relaxes=True,
        component="tangential",
        shown=("MPa", 1e-6),
        dimensions=3,
    ),
    Quantity(
        name="von_mises_stress",
        label="von Mises stress",
        noun="von Mises stress",
        long_name="mid-surface von Mises stress of the core",
        unit="Pa",
        sign="a magnitude",
        values=of_the_core,
        relaxes=True,
        largest=largest_of_the_core,
        shown=("MPa", 1e-6),
        column=True,
        summary=("anywhere",),
        metrics=("anywhere",),
        dimensions=3,
    ),
    Quantity(
        name="wall_stress",
        label="largest stress through the wall",
        noun="stress in the wall",
        long_name="largest von Mises stress through the wall",
        unit="Pa",
        sign="a magnitude",
        values=through_wall,
        largest=largest_through_wall,
        relaxes=True,
        through=True,
        shown=("MPa", 1e-6),
        summary=("anywhere",),
        metrics=("anywhere",),
    ),
    Quantity(
        name="axial_displacement",
        label="axial displacement",
        noun="axial displacement",
        long_name="axial displacement of the mid-surface",
        unit="m",
        sign=ALONG_AXIS,
        gain=lambda solution, _: axial_gain(solution),
        needs="",
        shown=("µm", 1e6),
        colour="orange",
        dimensions=3,
    ),
)

QUANTITIES: dict[str, Quantity] = {quantity.name: quantity for quantity in _TABLE}
"""Every output of a shell by name, in the order of the tables."""


def columns(dimensions: int = 2) -> Iterator[Quantity]:
    """Yield those that tables, exports, comparisons and the studio hold at head and tail."""
    yield from (quantity for quantity in QUANTITIES.values() if quantity.column and quantity.dimensions <= dimensions)


def summary_rows(dimensions: int = 2) -> list[tuple[str, str, str]]:
    """Return (key, label, unit) of the rows of a shell's summary, in the order of the tables."""
    return [
        (quantity.key(where), quantity.noun + (f" {_PLACES[where]}" if len(quantity.summary) > 1 else ""), quantity.unit)
        for quantity in QUANTITIES.values()
        for where in quantity.summary
        if quantity.dimensions <= dimensions
    ]


def shell_metrics(dimensions: int = 3) -> dict[str, tuple[Quantity, Where]]:
    """Return what a study can ask of a shell: names such as "peak_stress_head", and what of which quantity they stand for."""
    known = (quantity for quantity in QUANTITIES.values() if quantity.dimensions <= dimensions)
    return {quantity.metric(where): (quantity, where) for quantity in known for where in quantity.metrics}
