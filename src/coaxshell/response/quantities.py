"""What can be read of a shell, one entry each: a table that histories, the summary, metrics, plots, exports and comparisons all read.

A new output is one entry here and one function: its gain, where it is a linear combination of V and W of the same order, else its values
at angles. It then has histories (:meth:`Response.history`) and modal amplitudes, can be drawn, compared with another code's and asked for
in a study, and stands in the tables, files and pages that the entry names.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.labels import ALONG_AXIS, COUNTERCLOCKWISE, INWARD, TENSION
from coaxshell.response.modal import (
    amplitudes,
    axial_gain,
    displacement_gain,
    stress_gain_of,
    tangential_gain,
    voltage_gain,
)
from coaxshell.response.quantity import PLACES, Quantity, Where
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.response.translation import relative_gain, relative_tangential_gain
from coaxshell.response.voltages import actuator_values, largest_demanded_voltage, largest_sensor_voltage
from coaxshell.response.wall_motion import WallMotion
from coaxshell.response.wall_stress import largest_of_the_core, largest_through_wall, of_the_core, through_wall

__all__ = ["QUANTITIES", "Quantity", "Where", "columns", "shell_metrics", "summary_rows"]


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


def _charge(motion: WallMotion, shell: int) -> FloatArray:
    from coaxshell.response.electrical import charge  # with energies, which take long to import

    return charge(motion, shell)


def _current(motion: WallMotion, shell: int) -> FloatArray:
    from coaxshell.response.electrical import current

    return current(motion, shell)


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
        name="actuator_charge",
        label="actuator charge",
        noun="actuator charge",
        long_name="charge of all actuators per area",
        unit="C/m^2",
        sign="of the voltage that it comes with",
        modal=_charge,
        rate=1,
        needs="electrodes",
        shown=("mC/m²", 1e3),
        colour="green",
        summary=("anywhere",),
        metrics=("anywhere",),
    ),
    Quantity(
        name="actuator_current",
        label="actuator current",
        noun="actuator current",
        long_name="current of the amplifier into all actuators per area",
        unit="A/m^2",
        sign="of rising charge",
        modal=_current,
        rate=1,
        needs="electrodes",
        shown=("A/m²", 1.0),
        colour="purple",
        summary=("anywhere",),
        metrics=("anywhere",),
    ),
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
        (quantity.key(where), quantity.noun + (f" {PLACES[where]}" if len(quantity.summary) > 1 else ""), quantity.unit)
        for quantity in QUANTITIES.values()
        for where in quantity.summary
        if quantity.dimensions <= dimensions
    ]


def shell_metrics(dimensions: int = 3) -> dict[str, tuple[Quantity, Where]]:
    """Return what a study can ask of a shell: names such as "peak_stress_head", and what of which quantity they stand for."""
    known = (quantity for quantity in QUANTITIES.values() if quantity.dimensions <= dimensions)
    return {quantity.metric(where): (quantity, where) for quantity in known for where in quantity.metrics}
