"""The modal pressures of the actuators: what the control law asks for at a motion, and what saturating actuators gave (Eqs. 4, 17, 20)."""

from __future__ import annotations

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.structure.control_law import ControlGains
from coaxshell.structure.elastic_wall import ElasticWall


def pressure_asked(
    problem: Problem, normal: FloatArray, tangential: FloatArray, normal_rate: FloatArray, tangential_rate: FloatArray
) -> FloatArray:
    """Return the pressure of the linear law, A (k_p phi_s + k_d dphi_s/dt), from the motion and its rates.

    Parameters
    ----------
    problem : Problem
    normal, tangential, normal_rate, tangential_rate : ndarray, shape (shells, parities, M + 1, T)
        W, V, dW/dt and dV/dt.

    Returns
    -------
    ndarray, shape (shells, parities, M + 1, T)
        Positive inward; 0 on shells without feedback.
    """
    pressure, modes = np.zeros_like(normal), Modes.up_to(normal.shape[2] - 1)
    for i, wall in enumerate(problem.shells):
        if wall.gains is None:
            continue
        assert isinstance(wall.gains, ControlGains)  # no other law saturates
        sensor = wall.sensor_gain(modes).columns
        sensed, rate = (sensor.v * v[i] + sensor.w * w[i] for w, v in ((normal, tangential), (normal_rate, tangential_rate)))
        pressure[i] = wall.actuator_pressure * (wall.gains.proportional * sensed + wall.gains.derivative * rate)
    return pressure


def voltage_asked(solved: SolvedSpectra) -> ComplexArray:
    """Return the transforms of the voltage H(s) phi_s that the law of each shell asks for, V; 0 on shells without feedback.

    Returns
    -------
    ndarray, shape (shells, parities, M + 1, nodes)
    """
    if solved.voltage is not None:
        return solved.voltage if solved.asked is None else solved.asked
    voltage = np.zeros_like(solved.normal)
    for i, wall in enumerate(solved.problem.shells):
        if isinstance(wall, ElasticWall):
            if wall.gains is not None:
                assert solved.solid is not None
                voltage[i] = solved.solid.voltage(i, wall)
        elif wall.gains is not None:
            sensor = wall.sensor_gain(solved.modes).columns
            voltage[i] = wall.gains.at(solved.grid.nodes, solved.modes) * (sensor.v * solved.tangential[i] + sensor.w * solved.normal[i])
    return voltage


def saturated(solution: ModalSolution) -> bool:
    """Return whether an actuator reached its limit in a run."""
    lack = solution.control_correction
    return lack is not None and solution.normal_rate is not None and bool(lack.any())


def pressure_given(solution: ModalSolution) -> FloatArray | None:
    """Return the pressure that saturating actuators gave, shape (shells, parities, M + 1, T); None where the linear law held throughout."""
    lack, w_rate, v_rate = solution.control_correction, solution.normal_rate, solution.tangential_rate
    if lack is None or w_rate is None or v_rate is None or not saturated(solution):
        return None
    return pressure_asked(solution.problem, solution.normal, solution.tangential, w_rate, v_rate) + lack
