"""Actuators that cannot follow the control law: the voltage stops at the field limit.

In the interface march the voltage given, clip(u), is a force on the shells without feedback like any other
(:class:`LimitedVoltages`). In the direct engine, whose step contains the control law, only what the actuator lacks is unknown,
delta = clip(u) - u. It acts as the pressure (actuator pressure per volt) * delta on its shell, and changes u in turn. Points around
the circle and their saturated set are solved for at every step (:class:`SaturatedShell`):

    u = u_known + B delta,      delta = clip(u) - u,

B the response of the voltage to a correction within the same step, by its modes. On the saturated set this is the linear
system (1 + B) delta = clip - u_known, whose set is corrected until it reproduces itself (a semi-smooth Newton method).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from coaxshell.acoustics.operators import all_orders
from coaxshell.model.gains import law_of
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.late import linalg
from coaxshell.solver.scaling import Problem

_MAX_SETS = 50
_OVERSAMPLING = 4
"""Points per order on the half circle: clipping makes harmonics of the voltage that fewer points would fold back."""
_FEWEST_POINTS = 180


def circle(modes: int, parities: int, finer: int = 1) -> tuple[FloatArray, FloatArray]:
    """Return the matrices from modal amplitudes (parities * modes) to the points of a circle, and back.

    Points are *finer* times as many as a march has. Cosines alone have their points on half the circle: they are even.
    """
    orders = all_orders(modes - 1)
    points = finer * max(_OVERSAMPLING * modes, _FEWEST_POINTS) * parities
    span = np.pi if parities == 1 else 2.0 * np.pi
    theta = span * (np.arange(points) + 0.5) / points
    angles = theta[:, None] * orders
    evaluate = np.concatenate([np.cos(angles), np.sin(angles)][:parities], axis=1)
    beta = np.tile(np.where(orders == 0, 2.0, 1.0), parities)
    return evaluate, np.ascontiguousarray(evaluate.T * (2.0 / (beta * points))[:, None])


class CircleSums:
    """What :func:`circle` does, of many instants at once and at half the cost or a quarter: by the symmetries of cosines and sines.

    Values at theta and pi - theta are sum and difference of what even and odd orders make at theta alone, and those at -theta of what
    cosines and sines make.

    Parameters
    ----------
    modes, parities, finer : int
    """

    def __init__(self, modes: int, parities: int, finer: int = 1) -> None:
        self._modes, self._parities = modes, parities
        evaluate, project = circle(modes, parities, finer)
        self.points = len(evaluate)
        quarter = self.points // (2 * parities)  # of the circle: half the points that cosines alone have
        parts = [slice(p * modes + odd, (p + 1) * modes, 2) for p in range(parities) for odd in (0, 1)]
        self._evaluate = [np.ascontiguousarray(evaluate[:quarter, part].T) for part in parts]
        self._project = [np.ascontiguousarray(project[part, :quarter].T) for part in parts]
        self._whole = evaluate, np.ascontiguousarray(project.T)

    def some(self, points: npt.NDArray[np.intp]) -> tuple[FloatArray, FloatArray]:
        """Return the matrices from amplitudes in a row (parities * (M + 1)) to values at some points, and back for values 0 elsewhere."""
        evaluate, project = self._whole
        return np.ascontiguousarray(evaluate[points].T), project[points]

    def at_points(self, amplitudes: FloatArray) -> FloatArray:
        """Return values at the points, shape (..., points), of amplitudes (..., parities, M + 1)."""
        rows = amplitudes.reshape(-1, self._parities, self._modes)
        even, odd = (rows[:, 0, k::2] @ self._evaluate[k] for k in (0, 1))
        values = _mirrored(even + odd, even - odd)
        if self._parities == 2:
            even, odd = (rows[:, 1, k::2] @ self._evaluate[2 + k] for k in (0, 1))
            sines = _mirrored(even + odd, odd - even)
            values = _mirrored(values + sines, values - sines)
        return values.reshape(*amplitudes.shape[:-2], self.points)

    def amplitudes(self, values: FloatArray) -> FloatArray:
        """Return the amplitudes (..., parities, M + 1) of values at the points."""
        rows = values.reshape(-1, self.points)
        found = np.empty((len(rows), self._parities, self._modes))
        if self._parities == 2:
            there, mirrored = _halves(rows)
            rows, (right, left) = there + mirrored, _halves(there - mirrored)
            found[:, 1, 0::2], found[:, 1, 1::2] = (right - left) @ self._project[2], (right + left) @ self._project[3]
        right, left = _halves(rows)
        found[:, 0, 0::2], found[:, 0, 1::2] = (right + left) @ self._project[0], (right - left) @ self._project[1]
        return found.reshape(*values.shape[:-1], self._parities, self._modes)


def _mirrored(there: FloatArray, mirrored: FloatArray) -> FloatArray:
    """Return values along an arc, then those at its mirror image, where it goes back."""
    return np.concatenate([there, mirrored[:, ::-1]], axis=1)


def _halves(values: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the values on the first half of an arc and those at their mirror images."""
    middle = values.shape[1] // 2
    return values[:, :middle], values[:, : middle - 1 : -1]


class LimitedVoltages:
    """What limited actuators give, n(u) = clip(u), by modes; u in units of each actuator's limit.

    Its tangent says which points of each circle are held at a limit: 1 there and 0 elsewhere, shape (shells, points).

    Parameters
    ----------
    shells : int
        Controlled shells.
    parities, modes : int
    """

    def __init__(self, shells: int, parities: int, modes: int) -> None:
        self._shape = (shells, parities * modes)
        self._evaluate, self._project = circle(modes, parities)
        self._around, self._back = np.ascontiguousarray(self._evaluate.T), np.ascontiguousarray(self._project.T)

    def _within(self, amplitudes: FloatArray) -> bool:
        """Return whether no sum of these amplitudes can reach a limit."""
        return bool(np.abs(amplitudes).sum(axis=1).max() <= 1.0)

    def saturates(self, z: FloatArray) -> bool:
        """Return whether any voltage asked for at some steps is cut, z of shape (steps, shells * parities * M + 1)."""
        amplitudes = z.reshape(-1, self._shape[1])
        return not self._within(amplitudes) and bool(np.abs(amplitudes @ self._around).max() > 1.0)

    def nonlinear_part(self, z: FloatArray) -> FloatArray:
        """Return n(u) by modes."""
        amplitudes = z.reshape(self._shape)
        if self._within(amplitudes):
            return z.copy()
        given = np.clip(amplitudes @ self._around, -1.0, 1.0)
        return np.asarray((given @ self._back).ravel())

    def linearise(self, z: FloatArray) -> FloatArray:
        """Return where voltages are held."""
        return (np.abs(z.reshape(self._shape) @ self._around) > 1.0).astype(np.float64)

    def times_tangent(self, response: FloatArray, held: FloatArray) -> FloatArray:
        """Return R T, T the identity but for the points held."""
        answer = response.copy()
        width = self._shape[1]
        for shell, here in enumerate(held):
            rows = np.flatnonzero(here)
            if rows.size:
                part = slice(shell * width, (shell + 1) * width)
                tangent = self._project[:, rows] @ self._evaluate[rows]
                answer[:, part] -= response[:, part] @ tangent
        return answer

    def tangent_remainder(self, z: FloatArray, held: FloatArray) -> FloatArray:
        """Return n(u) - T u."""
        amplitudes = z.reshape(self._shape)
        if not held.any() and self._within(amplitudes):
            return np.zeros_like(z)
        volts = amplitudes @ self._around
        beyond = np.clip(volts, -1.0, 1.0) + (held - 1.0) * volts
        return np.asarray((beyond @ self._back).ravel())


class SaturatedShell:
    """The actuator of one shell on a circle of points.

    Parameters
    ----------
    problem : Problem
    index : int
        The shell.
    present : ndarray, shape (M + 1,)
        Modal voltage asked for per modal pressure within the same step.
    parities : int
    """

    def __init__(self, problem: Problem, index: int, present: FloatArray, parities: int) -> None:
        self.index = index
        self.limit = voltage_limit(problem, index)
        self.pressure_per_volt = problem.shells[index].actuator_pressure
        self.evaluate, self.project = circle(present.size, parities)
        self._shape = (parities, present.size)
        self._feedthrough = np.tile(present, parities) * self.pressure_per_volt
        self._response = (self.evaluate * self._feedthrough) @ self.project
        self._saturated = np.zeros(self.evaluate.shape[0], dtype=bool)

    def correction(self, demanded_voltage: FloatArray) -> FloatArray:
        """Return the modal pressure (parities, M + 1) of the correction to modal voltages asked for without it."""
        known = self.evaluate @ demanded_voltage.ravel()
        if not self._saturated.any() and np.abs(known).max() <= self.limit:
            return np.zeros(self._shape)
        delta = np.zeros_like(known)
        for _ in range(_MAX_SETS):
            held = np.flatnonzero(self._saturated)
            delta[:] = 0.0
            if held.size:
                # The sign of the limit at a held point is that of the voltage it is held against.
                target = np.copysign(self.limit, known[held]) - known[held]
                system = self._response[np.ix_(held, held)] + np.eye(held.size)
                delta[held] = linalg.solve(system, target, check_finite=False, overwrite_a=True, overwrite_b=True)
            voltage = known + (self._response[:, held] @ delta[held] if held.size else 0.0)
            saturated = np.abs(voltage) > self.limit
            if np.array_equal(saturated, self._saturated):
                break
            self._saturated = saturated
        return (self.pressure_per_volt * (self.project @ delta)).reshape(self._shape)


def voltage_limit(problem: Problem, index: int) -> float:
    """Return the largest voltage of a shell's actuator: field limit times thickness."""
    control = law_of(problem.system, index)
    field = None if control is None or control.field_limit is None else control.field_limit * problem.scales.length
    return problem.shells[index].voltage_limit(field)
