"""What walls do at a frequency, SI per unit of what drives them: motion, stress, voltages, each (nodes, A), and the absorbers."""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.places import shell_phrase
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response import arguments
from coaxshell.response.components import SIDES
from coaxshell.response.frequency.steady import Steady
from coaxshell.response.modal import elastic_wall
from coaxshell.response.solid_histories import COMPONENTS
from coaxshell.solver.scaling import Problem
from coaxshell.structure.elastic_depth import Shown
from coaxshell.structure.elastic_wall import Asked as Within
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.shell_model import Gain, ShellModel


def displacement(steady: Steady, shell: int, theta: FloatArray, component: str, rate: int, depth: float | None = None) -> ComplexArray:
    """Return s^rate times the displacement of the mid-surface, or at a depth (m) of an elastic wall: m, m/s or m/s^2.

    Parameters
    ----------
    steady : Steady
    shell : int
    theta : ndarray
        Degrees.
    component : str
        "normal" or "tangential".
    rate : int
        0, 1 or 2.
    depth : float, optional
    """
    scales, wall = steady.problem.scales, steady.problem.shells[shell]
    if isinstance(wall, ElasticWall):
        what: Shown = "normal" if component == "normal" else "tangential"
        modal = _within(steady, shell, wall, what, 0.0 if depth is None else depth / scales.length)
    else:
        modal = steady.motion.outer[shell]
        if component == "tangential":
            modal = modal * wall.operator(steady.system.modes, steady.s).tangential
    return steady.around(modal * (steady.s / scales.time) ** rate * scales.length, theta, component)


def stress(steady: Steady, shell: int, theta: FloatArray, component: str, depth: float | None) -> ComplexArray:
    """Return a stress, Pa: of the core where thin walls are designed by it, or at a depth (m), with that of the control voltage there."""
    wall, scales = steady.problem.shells[shell], steady.problem.scales
    z = None if depth is None else depth / scales.length
    if isinstance(wall, ElasticWall):
        what: Shown = component  # type: ignore[assignment]
        modal = _within(steady, shell, wall, what, wall.design_depth if z is None else z)
        return steady.around(modal * scales.pressure, theta, SIDES[component])
    total: ComplexArray | float = 0.0
    for factor, gain in wall.stress_parts(steady.system.modes, z, component):
        part = _of_motion(steady, shell, wall, gain)
        total = total + (part if factor is None else part * factor.at(steady.s))
    if z is not None and wall.gains is not None:
        per_volt = wall.control_stress(z, component)
        if per_volt:
            total = total + per_volt * _demanded(steady, shell, wall)
    return steady.around(np.asarray(total * scales.pressure), theta, SIDES[component])


def sensor_voltage(steady: Steady, shell: int, theta: FloatArray) -> ComplexArray:
    """Return the open-circuit voltage of the sensor, V."""
    wall = steady.problem.shells[shell]
    if isinstance(wall, ElasticWall):
        if wall.gains is not None:
            return steady.around(_read_by_law(steady, shell, wall), theta)
        number = wall.layer_number("sensor")
        assert number is not None
        layer = wall.layers[wall.piezoelectric[number]]
        return steady.around(-_within(steady, shell, wall, "potential", 0.5 * (layer.inner + layer.outer) - wall.radius), theta)
    return steady.around(_of_motion(steady, shell, wall, wall.sensor_gain(steady.system.modes)), theta)


def actuator_voltage(steady: Steady, shell: int, theta: FloatArray) -> ComplexArray:
    """Return the voltage that the control law asks for, V."""
    return steady.around(_demanded(steady, shell, steady.problem.shells[shell]), theta)


def link_displacement(steady: Steady) -> ComplexArray:
    """Return the displacement of the absorbers' masses, m, positive inward, shape (nodes, N)."""
    return np.asarray(steady.motion.link_displacement.T * steady.problem.scales.length)


def link_force(steady: Steady) -> ComplexArray:
    """Return the forces of the absorbers on their shells, N/m, positive inward, shape (nodes, N, 2)."""
    return np.asarray(np.moveaxis(steady.motion.link_force, -1, 0) * steady.problem.scales.line_force)


def _of_motion(steady: Steady, shell: int, wall: ShellModel, gain: Gain) -> ComplexArray:
    """Return the modal amplitudes of a linear combination of V, W and U of a thin wall, (parities, M + 1, nodes)."""
    moving = wall.operator(steady.system.modes, steady.s)
    return np.asarray(steady.motion.outer[shell] * gain.columns.recovered(moving.tangential, moving.axial))


def _demanded(steady: Steady, shell: int, wall: ShellModel) -> ComplexArray:
    """Return the modal control voltage, V."""
    assert wall.gains is not None
    solid = isinstance(wall, ElasticWall)
    read = _read_by_law(steady, shell, wall) if solid else _of_motion(steady, shell, wall, wall.sensor_gain(steady.system.modes))
    return np.asarray(wall.gains.at(steady.s, steady.system.modes) * read)


def _read_by_law(steady: Steady, shell: int, wall: ShellModel) -> ComplexArray:
    """Return what the law of an elastic wall reads, the mean of its sensors, V."""
    assert isinstance(wall, ElasticWall)
    loop, motion = wall.loop(steady.system.modes, steady.s), steady.motion
    assert loop is not None
    return np.asarray(loop.sensed[0] * motion.load_inner[shell] + loop.sensed[1] * motion.load_outer[shell])


def _within(steady: Steady, shell: int, wall: ElasticWall, what: Shown, depth: float) -> ComplexArray:
    """Return the modal amplitudes of a quantity at a depth (in a) of an elastic wall, dimensionless."""
    (transfer,) = wall.transfer(steady.system.modes, steady.s, [Within(what, depth)])
    motion = steady.motion
    return np.asarray(transfer[0] * motion.load_inner[shell] + transfer[1] * motion.load_outer[shell])


def component_of(problem: Problem, shell: int, component: object) -> str:
    """Return a component of the stress of a wall that is linear in its motion; InputError if it has none of that name."""
    wall = elastic_wall(problem, shell)
    if component == "von_mises":
        remedy = "ask for its components, complex amplitudes, and combine them at an instant of the cycle"
        raise InputError("component", "'von_mises' is no linear combination of the motion and has no amplitude at a frequency", remedy)
    allowed = ("hoop", "axial") if wall.faces_move_alike else tuple(name for name in COMPONENTS if name != "von_mises")
    return arguments.one_of("component", component, allowed)


def depth_of(problem: Problem, shell: int, depth: object) -> float | None:
    """Return a depth in m; InputError if it lies outside the wall."""
    if depth is None:
        return None
    faces, length = problem.shells[shell].faces, problem.scales.length
    return arguments.depth_of((length * faces[0], length * faces[1]), depth)


def require(problem: Problem, shell: int, needs: str) -> None:
    """Raise InputError if a wall has no sensor, or no control, where that is asked for."""
    wall = elastic_wall(problem, shell)
    if not wall.has("sensor"):
        raise InputError(f"shells[{shell}].layers", "there is no sensor", 'give a piezoelectric layer the role "sensor"')
    if needs == "control" and wall.gains is None:
        name = shell_phrase(shell, len(problem.shells))
        raise InputError("control", f"the {name} is not controlled", "give the system a PDControl that covers this shell")
