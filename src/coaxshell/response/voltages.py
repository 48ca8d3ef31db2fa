"""Sensor and actuator voltages by modes and at angles, and their largest values (Eqs. 17 and 20)."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.gains import law_of
from coaxshell.model.places import shell_phrase
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.circle import circle_angles
from coaxshell.numerics.differences import time_derivative
from coaxshell.numerics.renamed import renamed
from coaxshell.response.modal import amplitudes, elastic_wall, orders, scaled, voltage_gain
from coaxshell.response.peaks import Amplitudes, Peak, folded, made_once, peak_anywhere
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.solver.electrodes import lower_half, segment_mean
from coaxshell.solver.interface.saturation import circle, voltage_limit
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.control_law import ControlGains, ControlLaw
from coaxshell.structure.segments import Segments
from coaxshell.structure.shell_model import FieldGain, Gain

_PER_WAVE = 8
_FEWEST = 64
"""Points to the shortest wave, and to a segment at least, where the mean of a cut voltage is taken."""


class ActuatorLimit(NamedTuple):
    """What the actuator stands: volts, and whether the controller stops there."""

    volts: float
    saturates: bool


def control_law(solution: ModalSolution, shell: int) -> ControlLaw:
    """Return the control law of a shell; InputError if nothing controls it."""
    gains = solution.problem.shells[shell].gains
    if gains is None:
        name = shell_phrase(shell, len(solution.problem.shells))
        raise InputError("control", f"the {name} is not controlled", "give the system a PDControl or a Feedback that covers this shell")
    return gains


def actuator_limit(solution: ModalSolution, shell: int) -> ActuatorLimit:
    """Return field limit times thickness of the actuator, V (section 5 of the theory); InputError if the shell has none."""
    if not elastic_wall(solution.problem, shell).has("actuator"):
        raise InputError(f"shells[{shell}].layers", "there is no actuator", 'give a piezoelectric layer the role "actuator"')
    control = law_of(solution.problem.system, shell)
    return ActuatorLimit(voltage_limit(solution.problem, shell), control is not None and control.saturation)


def sensor_rate(solution: ModalSolution, shell: int) -> FloatArray:
    """Return d/dt of the modal sensor voltage, V per transit, shape (parities, M + 1, T): by the engine's rates, else by differences."""
    gain = voltage_gain(solution, shell)
    normal, tangential = getattr(solution, "normal_rate", None), getattr(solution, "tangential_rate", None)
    if isinstance(gain, FieldGain) and gain.layer is not None and solution.along is not None and solution.along.potential_rates:
        kept: FloatArray = solution.along.potential_rates[gain.layer][shell]
        return kept
    if not isinstance(gain, Gain) or normal is None or tangential is None:
        solution.need_every_instant("a voltage of derivative control")
        return time_derivative(amplitudes(solution, shell, gain), solution.settings.time_step)
    rate: FloatArray = gain.w[:, None] * normal[shell] + gain.v[:, None] * tangential[shell]
    return rate


def demanded_voltage(solution: ModalSolution, shell: int) -> FloatArray:
    """Return the modal voltage that the control law asks for, V: k_p phi_s + k_d dphi_s/dt, t in transits (Eq. 17), or H(s) phi_s.

    Returns
    -------
    ndarray, shape (parities, M + 1, T)

    Raises
    ------
    InputError
        If the shell has no sensor, no actuator or no control.
    """
    actuator_limit(solution, shell)
    gains = control_law(solution, shell)
    kept = getattr(solution, "control_voltage", None)
    if kept is not None:
        return np.asarray(kept[shell], dtype=np.float64)
    assert isinstance(gains, ControlGains)
    voltage = gains.proportional * amplitudes(solution, shell, voltage_gain(solution, shell))
    if gains.derivative:
        voltage += gains.derivative * sensor_rate(solution, shell)
    return voltage


def given_voltage(solution: ModalSolution, shell: int) -> FloatArray:
    """Return the modal voltage on the actuator, V, shape (parities, M + 1, T): the orders of what is asked for, cut at every point."""
    modal, limit = demanded_voltage(solution, shell), actuator_limit(solution, shell)
    if not limit.saturates or np.abs(modal).sum(axis=(0, 1)).max() <= limit.volts:
        return modal
    evaluate, project = circle(modal.shape[1], modal.shape[0])
    flat = modal.reshape(-1, modal.shape[-1])
    return np.asarray((project @ applied(evaluate @ flat, limit)).reshape(modal.shape))


def applied(voltage: FloatArray, limit: ActuatorLimit) -> FloatArray:
    """Return the voltage on the actuator: what is asked for, cut at the limit if the controller saturates."""
    return np.clip(voltage, -limit.volts, limit.volts) if limit.saturates else voltage


class CutElectrode(NamedTuple):
    """The voltages of the segments of a wall's electrodes, V, shape (N, T)."""

    segments: Segments
    voltage: FloatArray

    def at(self, theta: FloatArray, window: Any = slice(None)) -> FloatArray:
        """Return the voltage over angles (degrees), (T, A): that of the segment there, 0 between segments."""
        which = self.segments.at(np.radians(theta))
        some = self.voltage[:, window]
        return np.asarray(np.where(which >= 0, some[which].T, 0.0))

    def largest(self, time: FloatArray, window: slice) -> Peak:
        """Return the largest magnitude of all segments within a window; half the orders are no other answer."""
        size = np.abs(self.voltage[:, window])
        which, instant = (int(n) for n in np.unravel_index(int(size.argmax()), size.shape))
        growing = bool(instant == size.shape[1] - 1 and instant > 0 and size[which, instant] > size[which, instant - 1])
        value = float(size[which, instant])
        angle = folded(float(np.degrees(self.segments.centres[which])))
        return Peak(value, float(time[window][instant]), angle, growing, lower_half=value)


def cut_voltage(solution: ModalSolution, shell: int, *, asked: bool = False) -> CutElectrode | None:
    """Return the voltages of the segments of a shell's electrodes, given or *asked* for; None where they are not cut."""
    wall, kept = solution.problem.shells[shell], getattr(solution, "segment_voltage", None)
    if kept is None or wall.electrode_segments is None or wall.gains is None:
        return None
    return CutElectrode(wall.electrode_segments, kept[shell] if asked else applied(kept[shell], actuator_limit(solution, shell)))


def mean_shares(solution: ModalSolution, shell: int, length: float) -> FloatArray:
    """Return by what each order counts in the mean over a segment of a length (m), shape (M + 1,); ones for a point."""
    return segment_mean(orders(solution), length / solution.problem.system.shells[shell].radius)


def actuator_values(solution: ModalSolution, shell: int, theta: FloatArray, length: float = 0.0) -> FloatArray:
    """Return the voltage on the actuator at angles, V, shape (T, A), or its mean over a segment of a length (m) around each of them.

    A saturating controller cuts at every point, so that its mean is that of what has been cut, by the midpoint rule.
    """
    limit, centres = actuator_limit(solution, shell), np.atleast_1d(theta)
    cut = cut_voltage(solution, shell)
    if cut is not None:
        return cut.at(centres)
    modal = demanded_voltage(solution, shell)
    if length and limit.saturates:
        angle = np.degrees(length / solution.problem.system.shells[shell].radius)
        count = max(_FEWEST, -(-int(_PER_WAVE * modal.shape[1] * angle) // 360))
        around = (centres[:, None] + angle * ((np.arange(count) + 0.5) / count - 0.5)).ravel()
        values = applied(at_angles(modal, angle_basis(around, modal.shape[1], modal.shape[0])), limit)
        return np.asarray(values.reshape(len(values), len(centres), count).mean(axis=-1), dtype=np.float64)
    basis = angle_basis(centres, modal.shape[1], modal.shape[0]) * mean_shares(solution, shell, length)
    return applied(at_angles(modal, basis), limit)


def largest_sensor_voltage(solution: ModalSolution, shell: int, window: slice, length: float, *, halved: bool = True) -> Peak:
    """Return the largest sensor voltage anywhere within a window, as a mean over a segment of a length (m; 0 a point).

    With what the lower half of the orders gives, unless it is not to be ``halved``.
    """
    gain, share = voltage_gain(solution, shell), mean_shares(solution, shell, length)
    return _largest(solution, lambda block: amplitudes(solution, shell, scaled(gain, share), block), window, halved)


def largest_demanded_voltage(solution: ModalSolution, shell: int, window: slice, length: float, *, halved: bool = True) -> Peak:
    """Return the largest voltage asked for anywhere within a window, V, as a mean over a segment of a length (m; 0 a point).

    With what the lower half of the orders gives, unless it is not to be ``halved``.
    """
    cut = cut_voltage(solution, shell, asked=True)
    if cut is not None:
        return cut.largest(solution.time, window)
    voltage = demanded_voltage(solution, shell)  # whole, because its derivative needs the neighbours of every instant
    share = mean_shares(solution, shell, length)[:, None]
    return _largest(solution, lambda block: voltage[:, :, block] * share, window, halved)


def largest_mean(solution: ModalSolution, shell: int, quantity: Amplitudes, window: slice, length: float, *, halved: bool = True) -> Peak:
    """Return the largest magnitude of any quantity of amplitudes, as a mean over a segment of a length (m; 0 a point)."""
    share = mean_shares(solution, shell, length)[:, None]
    return _largest(solution, lambda block: quantity(block) * share, window, halved)


def _largest(solution: ModalSolution, quantity: Amplitudes, window: slice, halved: bool) -> Peak:
    """Return the largest magnitude of a quantity, and beside it what the lower half of the orders gives."""
    parities, all_of_them = solution.normal.shape[1:3]
    few, quantity = lower_half(all_of_them), made_once(quantity, window)
    largest = peak_anywhere(quantity, solution.time, window, len(circle_angles(all_of_them, parities)))
    if not halved:
        return largest
    fewer = peak_anywhere(lambda block: quantity(block)[:, :few], solution.time, window, len(circle_angles(few, parities)))
    return replace(largest, lower_half=fewer.value)


def __getattr__(name: str) -> Any:
    """Find the labelled voltages where they live now; deprecated."""
    histories = "coaxshell.response.histories"
    return renamed(__name__, name, sensor_voltage=f"{histories}.sensor_voltage", actuator_voltage=f"{histories}.actuator_voltage")
