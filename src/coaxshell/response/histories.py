"""Quantities of a shell at given angles, as labelled arrays."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response import arguments
from coaxshell.response.components import SIDES, STRESSES, von_mises
from coaxshell.response.labels import ALONG_AXIS, COUNTERCLOCKWISE, TENSION, history, modal_array
from coaxshell.response.modal import amplitudes, combined, elastic_wall, stress_gain_of, voltage_gain
from coaxshell.response.quantities import QUANTITIES, Quantity
from coaxshell.response.solid_histories import component_of, solid_stress
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.response.voltages import actuator_limit, actuator_values, mean_shares
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.electrodes import Segment, segment_length
from coaxshell.solver.solution import ModalSolution

PARITIES = {"normal": ("cos", "sin"), "tangential": ("sin", "-cos")}


def of_quantity(motion: WallMotion, shell: int, quantity: str, angle: npt.ArrayLike) -> xr.DataArray:
    """Return the history of any quantity of the table at angles, SI, dims (time, angle).

    Parameters
    ----------
    motion : WallMotion
    shell : int
    quantity : str
        A name of :data:`coaxshell.response.quantities.QUANTITIES`.
    angle : array_like, shape () or (A,)
        Degrees from the source direction.

    Raises
    ------
    InputError
        If the quantity is unknown, the shell has none, or the angle is not allowed.
    """
    entry = QUANTITIES[arguments.one_of("quantity", quantity, QUANTITIES)]
    theta = arguments.angles(angle)
    if entry.dimensions == 3 and motion.solution.along is None:
        raise InputError("quantity", f"{quantity!r} belongs to three dimensions", "run with dimensions=3")
    return _labelled(motion.solution, shell, entry, entry.at(motion, shell, theta), theta)


def _labelled(
    solution: ModalSolution, shell: int, entry: Quantity, values: FloatArray, theta: FloatArray, long_name: str = ""
) -> xr.DataArray:
    name, told = entry.array or entry.name, long_name or entry.long_name
    return history(solution, values, theta, shell, name=name, long_name=told, units=entry.unit, sign=entry.sign)


def displacement(
    solution: ModalSolution, shell: int, angle: npt.ArrayLike, component: str = "normal", *, relative: bool = False
) -> xr.DataArray:
    """Return the displacement of the mid-surface at angles, m: w = sum W cos(m theta) + ..., v = sum V sin(m theta) - ...

    Parameters
    ----------
    solution : ModalSolution
    shell : int
    angle : array_like, shape () or (A,)
        Degrees from the source direction.
    component : str
        "normal" (positive inward), "tangential" (positive towards increasing angle) or, at stations of three-dimensional runs, "axial".
    relative : bool
        Relative to the translation of the shell's section (its centre of mass), so that only what deforms the shell is left; see
        :mod:`coaxshell.response.translation`.

    Returns
    -------
    DataArray, dims (time, angle)

    Raises
    ------
    InputError
        If the angle or the component is not allowed.
    """
    component = arguments.one_of("component", component, ("normal", "tangential", "axial"))
    if component == "axial":
        return of_quantity(WallMotion(solution), shell, "axial_displacement", angle)
    name = "displacement" if component == "normal" else "tangential_displacement"
    return of_quantity(WallMotion(solution), shell, f"relative_{name}" if relative else name, angle)


def shell_velocity(motion: WallMotion, shell: int, angle: npt.ArrayLike, component: str = "normal") -> xr.DataArray:
    """Return the velocity of the mid-surface at angles, m/s: dw/dt or dv/dt, the inverse transform of s W or s V.

    Under the roll-off of the displacement, whose exact derivative it is within the band of the grid; a front of the pressure gives it a
    kink, no jump. Runs of the direct engine give their central differences. Zeros for a rigid shell.

    Parameters
    ----------
    motion : WallMotion
    shell : int
    angle : array_like, shape () or (A,)
        Degrees from the source direction.
    component : str
        "normal" (positive inward) or "tangential" (positive towards increasing angle).

    Returns
    -------
    DataArray, dims (time, angle)

    Raises
    ------
    InputError
        If the angle or the component is not allowed, or the run was thinned, cut or interpolated.
    """
    return _of_component(motion, shell, angle, component, "shell_velocity")


def shell_acceleration(motion: WallMotion, shell: int, angle: npt.ArrayLike, component: str = "normal") -> xr.DataArray:
    """Return the acceleration of the mid-surface at angles, m/s^2: d2w/dt2 or d2v/dt2, the inverse transform of s^2 W or s^2 V.

    A jump p of the pressure makes it jump by (1 + R) p/(mass per area), R = 1 where the fluid has not answered yet. The grid ends at the
    Nyquist frequency and rolls off by cos^2 over the top fifth of its band: at the jump stands the mean of both sides, beside it up to
    about a tenth of the jump too much, within some ten time steps. There a smaller step moves the overshoot closer to the front and
    does not lower it; a pulse with a rise time of a few steps has none.

    Parameters
    ----------
    motion : WallMotion
    shell : int
    angle : array_like, shape () or (A,)
        Degrees from the source direction.
    component : str
        "normal" (positive inward) or "tangential" (positive towards increasing angle).

    Returns
    -------
    DataArray, dims (time, angle)

    Raises
    ------
    InputError
        If the angle or the component is not allowed, or the run was thinned, cut or interpolated.
    """
    return _of_component(motion, shell, angle, component, "shell_acceleration")


def _of_component(motion: WallMotion, shell: int, angle: npt.ArrayLike, component: str, name: str) -> xr.DataArray:
    component = arguments.one_of("component", component, ("normal", "tangential"))
    return of_quantity(motion, shell, name if component == "normal" else QUANTITIES[name].partner, angle)


def stress(motion: WallMotion, shell: int, angle: npt.ArrayLike, depth: float | str | None = None, component: str = "hoop") -> xr.DataArray:
    """Return the stress at angles, Pa: the core's design stress at the mid-surface (Eq. 22), or the stress at a depth (Eqs. A.4, A.5).

    Parameters
    ----------
    motion : WallMotion
    shell : int
    angle : array_like, shape () or (A,)
        Degrees from the source direction.
    depth : float, str or None
        z in metres from the mid-surface, positive outward, or a face, "inner" or "outer". The modulus is that of the layer at z (the
        outer one on a boundary), bending is included, and in a piezoelectric layer the field of its own open-circuit potential and,
        in the actuator of a controlled shell, of the control voltage (-e32 u/t, Eq. A.10).
    component : str
        "hoop", "axial" (in two dimensions that of plane strain), "von_mises", and at stations of three-dimensional runs "shear"
        (between hoop and axis); elastic walls have "radial" and "radial_hoop" (the shear across the wall) too, at stations "radial_axial".

    Returns
    -------
    DataArray, dims (time, angle)

    Raises
    ------
    InputError
        If the shell is rigid, or the angle, the depth or the component is not allowed; if a material lacks constants along the axis.
    """
    theta, solution = arguments.angles(angle), motion.solution
    wall = elastic_wall(solution.problem, shell)
    if wall.faces_move_alike:
        component = arguments.one_of("component", component, (*STRESSES, "von_mises"))
    else:
        component = component_of(wall, component, plane=solution.along is None)
    if wall.faces_move_alike and component == "shear" and solution.along is None:
        raise InputError("component", f"{component!r} belongs to three dimensions", "run with dimensions=3")
    z, long_name = None, ""
    if depth is not None:
        length = solution.problem.scales.length
        z = arguments.depth_of((length * wall.faces[0], length * wall.faces[1]), depth)
        long_name = f"{component.replace('_', ' ')} stress at {z:g} m outward of the mid-surface"
    kept = STRESSES if solution.along is not None else ("hoop",)
    if not wall.faces_move_alike and (z is not None or component not in kept):
        values = solid_stress(motion, shell, theta, z, component)
    elif component == "von_mises":
        parts = STRESSES if solution.along is not None else ("hoop", "axial")
        values = von_mises(*(_stress(solution, shell, theta, z, name) for name in parts))
    else:
        values = _stress(solution, shell, theta, z, component)
    if component in _STRESS_NAMES:
        labelled = _labelled(solution, shell, QUANTITIES[_STRESS_NAMES[component]], values, theta, long_name)
    else:
        told = long_name or f"{component.replace('_', ' ')} stress of the core"
        sign = {"radial_hoop": COUNTERCLOCKWISE, "radial_axial": ALONG_AXIS}.get(component, TENSION)
        labelled = history(solution, values, theta, shell, name=f"{component}_stress", long_name=told, units="Pa", sign=sign)
    if z is not None:
        labelled.attrs["depth"] = z
    return labelled


_STRESS_NAMES = {"hoop": "stress", "axial": "axial_stress", "shear": "shear_stress", "von_mises": "von_mises_stress"}


def _stress(solution: ModalSolution, shell: int, theta: FloatArray, z: float | None, component: str) -> FloatArray:
    """Return a component of the stress at angles, Pa, shape (T, A), with what the control voltage adds to it at a depth z (m)."""
    wall, scales = elastic_wall(solution.problem, shell), solution.problem.scales
    values = combined(solution, shell, stress_gain_of(solution, shell, z, component), theta, SIDES[component])
    if z is None or component == "shear":
        return values
    per_volt = scales.pressure * wall.control_stress(z / scales.length, component)
    if per_volt and wall.gains is not None:
        values = values + per_volt * actuator_values(solution, shell, theta)
    return values


def sensor_voltage(solution: ModalSolution, shell: int, angle: npt.ArrayLike, segment: Segment = "point") -> xr.DataArray:
    """Return the open-circuit voltage of the sensor at angles, V: phi_s = E_s (m V - m^2 W)/(zeta33 R^2 + m^2 zeta22) (Eq. 20).

    Parameters
    ----------
    solution : ModalSolution
    shell : int
    angle : array_like, shape () or (A,)
        Degrees from the source direction.
    segment : float, str or None
        Length of the segment of the wall around each angle over which the mean is taken (:mod:`coaxshell.solver.electrodes`).

    Returns
    -------
    DataArray, dims (time, angle)

    Raises
    ------
    InputError
        If the shell has no sensor, or the angle or the segment is not allowed.
    """
    theta = arguments.angles(angle)
    length = segment_length(solution.problem, shell, segment)
    modal = amplitudes(solution, shell, voltage_gain(solution, shell))
    basis = angle_basis(np.atleast_1d(theta), modal.shape[1], modal.shape[0]) * mean_shares(solution, shell, length)
    values = at_angles(modal, basis)
    labelled = _labelled(solution, shell, QUANTITIES["sensor_voltage"], values, theta)
    return _over(labelled, length)


def actuator_voltage(solution: ModalSolution, shell: int, angle: npt.ArrayLike, segment: Segment = "point") -> xr.DataArray:
    """Return the control voltage on the actuator at angles, V: u = k_p phi_s + k_d dphi_s/dt, t in transits (Eq. 17).

    Cut at the field limit times the thickness if the controller saturates. Without velocities from the engine the derivative is a
    difference of fourth order.

    Parameters
    ----------
    solution : ModalSolution
    shell : int
    angle : array_like, shape () or (A,)
        Degrees from the source direction.
    segment : float, str or None
        Length of the segment of the wall around each angle over which the mean is taken (:mod:`coaxshell.solver.electrodes`).

    Returns
    -------
    DataArray, dims (time, angle)

    Raises
    ------
    InputError
        If the shell has no sensor, no actuator or no control, or the angle or the segment is not allowed.
    """
    theta = arguments.angles(angle)
    length = segment_length(solution.problem, shell, segment)
    values = actuator_values(solution, shell, theta, length)
    labelled = _labelled(solution, shell, QUANTITIES["actuator_voltage"], values, theta)
    labelled.attrs["limit"] = actuator_limit(solution, shell).volts
    return _over(labelled, length)


def _over(labelled: xr.DataArray, length: float) -> xr.DataArray:
    """Say over how long a segment the mean was taken."""
    if length:
        labelled.attrs["segment"] = length
        labelled.attrs["long_name"] += ", mean over a segment"
    return labelled


def modal(solution: ModalSolution | WallMotion, shell: int, quantity: str = "displacement") -> xr.DataArray:
    """Return modal amplitudes in SI, dims (half, mode, time).

    Parameters
    ----------
    solution : ModalSolution or WallMotion
    shell : int
    quantity : str
        Any of the table that is linear in the motion: "displacement" (W, m), "tangential_displacement" or "tangential" (V, m), "stress"
        (Eq. 22, Pa), "sensor_voltage" (Eq. 20, V), ...

    Raises
    ------
    InputError
        If the quantity is unknown or the shell has none.
    """
    motion = solution if isinstance(solution, WallMotion) else WallMotion(solution)
    linear = [name for name, entry in QUANTITIES.items() if entry.gain is not None or entry.modal is not None]
    quantity = arguments.one_of("quantity", quantity, ["tangential", *linear])
    entry = QUANTITIES["tangential_displacement" if quantity == "tangential" else quantity]
    values, parities = entry.amplitudes(motion, shell)(slice(None)), PARITIES[entry.component]
    long_name = f"modal {entry.long_name}"
    return modal_array(motion.solution, values, shell, name=f"modal_{quantity}", long_name=long_name, units=entry.unit, parities=parities)
