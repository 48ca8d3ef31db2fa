"""Displacement and hoop stress of a shell at given angles."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import xarray as xr
from coaxshell.response import arguments
from coaxshell.response.labels import INWARD, history, modal_array
from coaxshell.response.modal import amplitudes, displacement_gain, elastic_wall, stress_gain_of, voltage_gain
from coaxshell.response.synthesis import angle_basis, at_angles
from coaxshell.response.translation import relative_gain, relative_tangential_gain
from coaxshell.response.voltages import actuator_values
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.shell_model import Gain

TENSION = "positive in tension"
COUNTERCLOCKWISE = "positive towards increasing angle"
COSINE = ("cos", "sin")


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
        "normal" (positive inward) or "tangential" (positive towards increasing angle).
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
    component = arguments.one_of("component", component, ("normal", "tangential"))
    theta = arguments.angles(angle)
    modal = solution.normal[shell] if component == "normal" else solution.tangential[shell]
    basis = angle_basis(np.atleast_1d(theta), modal.shape[1], modal.shape[0], component)
    if relative:
        gain = relative_gain(solution) if component == "normal" else relative_tangential_gain(solution)
        values = at_angles(solution.normal[shell], basis * gain.w) + at_angles(solution.tangential[shell], basis * gain.v)
    else:
        values = solution.problem.scales.length * at_angles(modal, basis)
    sign = INWARD if component == "normal" else COUNTERCLOCKWISE
    name, long_name = f"{component}_displacement", f"{component} displacement"
    if relative:
        name, long_name = f"relative_{name}", f"{long_name} relative to the section's translation"
    return history(solution, values, theta, shell, name=name, long_name=long_name, units="m", sign=sign)


def combined(solution: ModalSolution, shell: int, gain: Gain, theta: FloatArray) -> FloatArray:
    """Return gain.v V + gain.w W at angles, shape (T, A); the gains go into the basis, so no modal array is built."""
    normal, tangential = solution.normal[shell], solution.tangential[shell]
    basis = angle_basis(np.atleast_1d(theta), normal.shape[1], normal.shape[0])
    return at_angles(normal, basis * gain.w) + at_angles(tangential, basis * gain.v)


def stress(solution: ModalSolution, shell: int, angle: npt.ArrayLike, depth: float | str | None = None) -> xr.DataArray:
    """Return the hoop stress at angles, Pa: the core's design stress at the mid-surface (Eq. 22), or the stress at a depth (Eqs. A.4, A.5).

    Parameters
    ----------
    solution : ModalSolution
    shell : int
    angle : array_like, shape () or (A,)
        Degrees from the source direction.
    depth : float, str or None
        z in metres from the mid-surface, positive outward, or a face, "inner" or "outer". The modulus is that of the layer at z (the
        outer one on a boundary), bending is included, and in a piezoelectric layer the field of its own open-circuit potential and,
        in the actuator of a controlled shell, of the control voltage (-e32 u/t, Eq. A.10).

    Returns
    -------
    DataArray, dims (time, angle)

    Raises
    ------
    InputError
        If the shell is rigid, or the angle or the depth is not allowed.
    """
    theta = arguments.angles(angle)
    wall = elastic_wall(solution.problem, shell)
    if depth is None:
        values = combined(solution, shell, stress_gain_of(solution, shell), theta)
        long_name = "mid-surface hoop stress of the core"
    else:
        z = arguments.depth_of(wall.faces, depth)
        values = combined(solution, shell, stress_gain_of(solution, shell, z), theta)
        per_volt = wall.control_stress(z)
        if per_volt and wall.gains is not None:
            values = values + per_volt * actuator_values(solution, shell, theta)
        long_name = f"hoop stress at {z:g} m outward of the mid-surface"
    labelled = history(solution, values, theta, shell, name="stress", long_name=long_name, units="Pa", sign=TENSION)
    if depth is not None:
        labelled.attrs["depth"] = z
    return labelled


def modal(solution: ModalSolution, shell: int, quantity: str = "displacement") -> xr.DataArray:
    """Return modal amplitudes in SI, dims (half, mode, time).

    Parameters
    ----------
    solution : ModalSolution
    shell : int
    quantity : str
        "displacement" (W, m), "tangential" (V, m), "stress" (Eq. 22, Pa) or "sensor_voltage" (Eq. 20, V).

    Raises
    ------
    InputError
        If the quantity is unknown or the shell has none.
    """
    names = {
        "displacement": ("normal displacement", "m"),
        "tangential": ("tangential displacement", "m"),
        "stress": ("mid-surface hoop stress of the core", "Pa"),
        "sensor_voltage": ("open-circuit voltage of the sensor", "V"),
    }
    quantity = arguments.one_of("quantity", quantity, names)
    parities = COSINE
    match quantity:
        case "tangential":
            values = solution.problem.scales.length * solution.tangential[shell]
            parities = ("sin", "-cos")
        case "displacement":
            values = amplitudes(solution, shell, displacement_gain(solution))
        case "stress":
            values = amplitudes(solution, shell, stress_gain_of(solution, shell))
        case _:
            values = amplitudes(solution, shell, voltage_gain(solution, shell))
    long_name, units = names[quantity]
    return modal_array(solution, values, shell, name=f"modal_{quantity}", long_name=f"modal {long_name}", units=units, parities=parities)
