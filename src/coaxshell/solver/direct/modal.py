"""Shell modes of the direct engine: states at two instants and one central-difference step."""

from __future__ import annotations

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.places import shell_phrase
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import Problem
from coaxshell.structure.control_law import ControlGains


class ModalStep:
    """W and V of all shells at the present and the last step, and what their stiffness and feedback demand.

    Arrays of amplitudes have the shape (shells, parities, M + 1); matrices over modes (shells, M + 1).
    """

    def __init__(self, problem: Problem, grid: LaplaceGrid, max_order: int, parities: int) -> None:
        self.problem, self.step = problem, grid.time_step
        modes = Modes.up_to(max_order)
        self.orders = modes.orders
        count = len(problem.shells)
        walls = problem.shells
        self.free = np.array([wall.moves for wall in walls])
        self.mass = np.array([wall.mass for wall in walls])
        stiffness = [wall.stiffness(modes) for wall in walls]
        self.vv, self.vw, self.ww = (np.stack([k[entry] for k in stiffness])[:, None] for entry in range(3))
        sensors = [wall.sensor_gain(modes) for wall in walls]
        self.sensor_v, self.sensor_w = (np.stack(x)[:, None] for x in ([gain.v for gain in sensors], [gain.w for gain in sensors]))
        gains = [wall.gains for wall in walls]
        self.proportional = np.array([g.proportional if isinstance(g, ControlGains) else 0.0 for g in gains])[:, None, None]
        self.derivative = np.array([g.derivative if isinstance(g, ControlGains) else 0.0 for g in gains])[:, None, None]
        self.actuator = np.array([0.0 if wall.gains is None else wall.actuator_pressure for wall in walls])[:, None, None]
        shape = (count, parities, max_order + 1)
        self.w, self.w_before, self.v, self.v_before = (np.zeros(shape) for _ in range(4))
        self._require_stable()

    def couple(self, present: FloatArray) -> None:
        """Invert the matrices of the present accelerations: inertia, fluids' weights at lag 0, and the centred derivative feedback."""
        count = len(self.problem.shells)
        matrix = np.moveaxis(present.copy(), -1, 0)  # (M + 1, shells, shells)
        feedback = -self.actuator * self.derivative * self.sensor_w * (0.5 * self.step)
        for i in range(count):
            if self.free[i]:
                matrix[:, i, i] += self.mass[i] + feedback[i, 0]
            else:
                matrix[:, i, :] = 0.0
                matrix[:, i, i] = 1.0
        self.mobility = np.linalg.inv(matrix)

    def accelerate(self, demand: FloatArray) -> FloatArray:
        """Return the normal accelerations under a demand, shape (shells, parities, M + 1)."""
        return np.asarray(np.einsum("mij,jhm->ihm", self.mobility, demand * self.free[:, None, None]), dtype=np.float64)

    def demand(self, load: FloatArray) -> FloatArray:
        """Return all that is known at this step: load on the outermost shell, stiffness, feedback without the present W''.

        Also advances V, whose equation has no fluid in it.
        """
        tangential = -(self.vv * self.v + self.vw * self.w) / self.mass[:, None, None]
        self.v_after = 2.0 * self.v - self.v_before + self.step**2 * tangential
        self.v_rate = (self.v_after - self.v_before) / (2.0 * self.step)
        self.w_rate_known = (self.w - self.w_before) / self.step
        volts = self.sensor_v * self.v + self.sensor_w * self.w
        rate = self.sensor_v * self.v_rate + self.sensor_w * self.w_rate_known
        self.demanded_voltage_known = self.proportional * volts + self.derivative * rate
        demand = self.actuator * self.demanded_voltage_known - self.vw * self.v - self.ww * self.w
        demand[-1] += load
        return np.asarray(demand, dtype=np.float64)

    def rate(self, acceleration: FloatArray) -> FloatArray:
        """Return the centred normal velocity of this step."""
        return self.w_rate_known + 0.5 * self.step * acceleration

    def advance(self, acceleration: FloatArray) -> None:
        """Move to the next step."""
        after = 2.0 * self.w - self.w_before + self.step**2 * acceleration
        self.w_before, self.w, self.v_before, self.v = self.w, after, self.v, self.v_after

    def _require_stable(self) -> None:
        """Raise InputError if a shell's own highest frequency is beyond the central difference, omega dt < 2."""
        for i in np.flatnonzero(self.free):
            vv, vw, ww = (x[i, 0] / self.mass[i] for x in (self.vv, self.vw, self.ww))
            highest = float(np.sqrt(0.5 * (vv + ww + np.sqrt((vv - ww) ** 2 + 4.0 * vw**2))).max())
            if highest * self.step >= 2.0:
                name = shell_phrase(int(i), len(self.free))
                raise InputError(
                    "time_step",
                    f"{self.step:g} is unstable for the direct engine: the {name} vibrates at up to {highest:.4g} per transit",
                    f'use at most {1.9 / highest:.2g}, fewer modes, or engine = "spectral"',
                )
