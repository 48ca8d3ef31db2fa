"""Sensor and actuator voltages (Eqs. 17 and 20)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.late import xarray as xr
from coaxshell.response import arguments
from coaxshell.response.labels import history
from coaxshell.response.modal import amplitudes, elastic_section, voltage_gain
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.solver.scaling import ControlGains
from coaxshell.solver.solution import ModalSolution

FloatArray = npt.NDArray[np.float64]


class ActuatorLimit(NamedTuple):
    """What the actuator stands: volts, and whether the controller stops there."""

    volts: float
    saturates: bool


def control_gains(solution: ModalSolution, shell: int) -> ControlGains:
    """Return the gains of a shell; InputError if nothing controls it."""
    gains = solution.problem.shells[shell].gains
    if gains is None:
        raise InputError("control", f"shell {shell} is not controlled", "give the system a PDControl that covers this shell")
    return gains


def actuator_limit(solution: ModalSolution, shell: int) -> ActuatorLimit:
    """Return field limit times thickness of the actuator, V (section 5 of the theory); InputError if the shell has none."""
    actuator = elastic_section(solution.problem, shell).layer("actuator")
    if actuator is None:
        raise InputError(f"shells[{shell}].layers", "there is no actuator", 'give a piezoelectric layer the role "actuator"')
    control = solution.problem.system.control
    field = control.field_limit if control is not None and control.field_limit is not None else actuator.field_limit
    return ActuatorLimit(field * actuator.thickness, control is not None and control.saturation)


def time_derivative(values: FloatArray, step: float) -> FloatArray:
    """Return the derivative along the last axis by differences of fourth order, one-sided at both ends.

    Parameters
    ----------
    values : ndarray, shape (..., T)
        T >= 5, which the settings guarantee.
    step : float
    """
    f = values
    rate = np.empty_like(f)
    rate[..., 2:-2] = f[..., :-4] - 8 * f[..., 1:-3] + 8 * f[..., 3:-1] - f[..., 4:]
    first, second = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]), np.array([-3.0, -10.0, 18.0, -6.0, 1.0])
    rate[..., 0], rate[..., 1] = f[..., :5] @ first, f[..., :5] @ second
    rate[..., -1], rate[..., -2] = -(f[..., :-6:-1] @ first), -(f[..., :-6:-1] @ second)
    rate /= 12.0 * step
    return rate


def sensor_rate(solution: ModalSolution, shell: int) -> FloatArray:
    """Return d/dt of the modal sensor voltage, V per transit, shape (halves, M + 1, T): by the engine's rates, else by differences."""
    gain = voltage_gain(solution, shell)
    normal, tangential = getattr(solution, "normal_rate", None), getattr(solution, "tangential_rate", None)
    if normal is None or tangential is None:
        return time_derivative(amplitudes(solution, shell, gain), solution.settings.time_step)
    rate: FloatArray = gain.w[:, None] * normal[shell] + gain.v[:, None] * tangential[shell]
    return rate


def demanded_voltage(solution: ModalSolution, shell: int) -> FloatArray:
    """Return the modal voltage that the control law asks for, V: k_p phi_s + k_d dphi_s/dt, t in transits (Eq. 17).

    Returns
    -------
    ndarray, shape (halves, M + 1, T)

    Raises
    ------
    InputError
        If the shell has no sensor, no actuator or no control.
    """
    actuator_limit(solution, shell)
    gains = control_gains(solution, shell)
    voltage = gains.proportional * amplitudes(solution, shell, voltage_gain(solution, shell))
    if gains.derivative:
        voltage += gains.derivative * sensor_rate(solution, shell)
    return voltage


def applied(voltage: FloatArray, limit: ActuatorLimit) -> FloatArray:
    """Return the voltage on the actuator: what is asked for, cut at the limit if the controller saturates."""
    return np.clip(voltage, -limit.volts, limit.volts) if limit.saturates else voltage


def actuator_values(solution: ModalSolution, shell: int, theta: FloatArray) -> FloatArray:
    """Return the voltage on the actuator at angles, V, shape (T, A)."""
    modal = demanded_voltage(solution, shell)
    values = at_angles(modal, angle_basis(np.atleast_1d(theta), modal.shape[1], modal.shape[0]))
    return applied(values, actuator_limit(solution, shell))


def sensor_voltage(solution: ModalSolution, shell: int, angle: npt.ArrayLike) -> xr.DataArray:
    """Return the open-circuit voltage of the sensor at angles, V: phi_s = E_s (m V - m^2 W)/(zeta33 R^2 + m^2 zeta22) (Eq. 20).

    Parameters
    ----------
    solution : ModalSolution
    shell : int
    angle : array_like, shape () or (A,)
        Degrees from the source direction.

    Returns
    -------
    DataArray, dims (time, angle)

    Raises
    ------
    InputError
        If the shell has no sensor or the angle is not allowed.
    """
    theta = arguments.angles(angle)
    modal = amplitudes(solution, shell, voltage_gain(solution, shell))
    values = at_angles(modal, angle_basis(np.atleast_1d(theta), modal.shape[1], modal.shape[0]))
    long_name = "open-circuit voltage of the sensor"
    return history(solution, values, theta, shell, name="sensor_voltage", long_name=long_name, units="V", sign="of phi_s in Eq. 20")


def actuator_voltage(solution: ModalSolution, shell: int, angle: npt.ArrayLike) -> xr.DataArray:
    """Return the control voltage on the actuator at angles, V: u = k_p phi_s + k_d dphi_s/dt, t in transits (Eq. 17).

    Cut at the field limit times the thickness if the controller saturates. Without velocities from the engine the derivative is a
    difference of fourth order.

    Parameters
    ----------
    solution : ModalSolution
    shell : int
    angle : array_like, shape () or (A,)
        Degrees from the source direction.

    Returns
    -------
    DataArray, dims (time, angle)

    Raises
    ------
    InputError
        If the shell has no sensor, no actuator or no control, or the angle is not allowed.
    """
    theta = arguments.angles(angle)
    values = actuator_values(solution, shell, theta)
    long_name = "control voltage on the actuator"
    labelled = history(solution, values, theta, shell, name="actuator_voltage", long_name=long_name, units="V", sign="of u in Eq. 17")
    labelled.attrs["limit"] = actuator_limit(solution, shell).volts
    return labelled
