"""Absorbers and saturating actuators of the direct engine: dampers centred and so coupled, springs explicit."""

from __future__ import annotations

import numpy as np

from coaxshell.acoustics.basis import Modes
from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.solver.direct.modal import ModalStep
from coaxshell.solver.interface.absorbers import AbsorberSet, InterfacePoints
from coaxshell.solver.interface.saturation import SaturatedShell
from coaxshell.solver.scaling import Problem

_TOLERANCE = 1e-12
_MAX_COUPLING = 60


class ExplicitInterface:
    """Forces of one step from the states at it, and the accelerations of shells and masses that follow."""

    def __init__(self, problem: Problem, absorbers: AbsorberSet, modal: ModalStep, saturate: bool) -> None:
        self.absorbers, self.modal, self.count = absorbers, modal, absorbers.count
        self.points = InterfacePoints(problem, absorbers, Modes(modal.orders))
        self.q, self.q_before = np.zeros(self.count), np.zeros(self.count)
        self.force = np.zeros((2, self.count))
        self.correction = np.zeros_like(modal.w)
        self._heavy = absorbers.mass > 0
        self._inverse_mass = np.divide(1.0, absorbers.mass, out=np.zeros(self.count), where=self._heavy)
        self._mobility = self._point_mobility()
        self._solve = np.linalg.inv(np.eye(2 * self.count) + 0.5 * modal.step * np.tile(absorbers.damping, 2)[:, None] * self._relative())
        self.actuators: list[SaturatedShell] = []
        if saturate:
            parities = modal.w.shape[1]
            for i in problem.system.controlled_shells:
                present = 0.5 * modal.step * (modal.derivative[i] * modal.sensor_w[i] * modal.mobility[:, i, i])[0]
                self.actuators.append(SaturatedShell(problem, i, present, parities))

    def _point_mobility(self) -> FloatArray:
        """Accelerations at the points per force there."""
        mobility = np.empty((2 * self.count, 2 * self.count))
        for column in range(2 * self.count):
            unit = np.zeros(2 * self.count)
            unit[column] = 1.0
            mobility[:, column] = self.points.evaluate(self.modal.accelerate(self.points.project(unit)))
        return mobility

    def _relative(self) -> FloatArray:
        """Accelerations of the points relative to their masses per force; a massless absorber moves with the mean of its points."""
        n = self.count
        pairs = np.tile(np.eye(n), (2, 2))
        mean = 0.5 * pairs @ self._mobility * np.tile(~self._heavy, 2)[:, None]
        return self._mobility + np.tile(self._inverse_mass, 2)[:, None] * pairs - mean

    def require_stable(self, time_step: float) -> None:
        """Raise InputError if a linear spring on the shell's own mass is beyond the central difference."""
        if not self.count:
            return
        own = np.diag(self._mobility).reshape(2, self.count).max(axis=0) + 2.0 * self._inverse_mass
        highest = float(np.sqrt(self.absorbers.linear * own).max())
        if highest * time_step >= 2.0:
            raise InputError(
                "time_step",
                f"{time_step:g} is unstable for the direct engine: the stiffest absorber vibrates at {highest:.4g} per transit",
                f'use at most {1.9 / highest:.2g} or engine = "spectral"',
            )

    def step(self, demand: FloatArray) -> FloatArray:
        """Return the normal accelerations of all shells (shells, parities, M + 1); moves the masses to the next step."""
        if self.count:
            self._hold_forces(demand)
        for _ in range(_MAX_COUPLING if self.actuators else 0):
            before = self.correction
            free = self.modal.accelerate(demand + (self.points.project(self.force.ravel()) if self.count else 0.0))
            self.correction = self._corrections(free)
            if self.count:
                self._hold_forces(demand + self.correction)
            change = float(np.abs(self.correction - before).max())
            if not self.count or change <= _TOLERANCE * float(np.abs(self.correction).max()):
                break
        if self.count:
            demand = demand + self.points.project(self.force.ravel())
            self._advance_masses()
        return self.modal.accelerate(demand + self.correction)

    def _corrections(self, acceleration: FloatArray) -> FloatArray:
        """Return the modal pressures that saturated actuators lack, given the accelerations without them."""
        modal = self.modal
        demanded_voltage = modal.demanded_voltage_known + modal.derivative * modal.sensor_w * 0.5 * modal.step * acceleration
        lacking = np.zeros_like(acceleration)
        for actuator in self.actuators:
            lacking[actuator.index] = actuator.correction(demanded_voltage[actuator.index])
        return lacking

    def _hold_forces(self, demand: FloatArray) -> None:
        """Set the forces of this step under a demand on the shells."""
        modal, links, n = self.modal, self.absorbers, self.count
        w = self.points.evaluate(modal.w).reshape(2, n)
        if not self._heavy.all():
            self.q = np.where(self._heavy, self.q, w.mean(axis=0))
        stretch = self.q - w
        rate_w = self.points.evaluate(modal.rate(modal.accelerate(demand))).reshape(2, n)
        rate_q = np.where(self._heavy, (self.q - self.q_before) / modal.step, rate_w.mean(axis=0))
        explicit = links.damping * (rate_q - rate_w) + (links.linear + links.cubic * stretch**2) * stretch
        self.force = (self._solve @ explicit.ravel()).reshape(2, n)

    def _advance_masses(self) -> None:
        acceleration = -self._inverse_mass * self.force.sum(axis=0)
        after = 2.0 * self.q - self.q_before + self.modal.step**2 * acceleration
        self.q_now = self.q
        self.q_before, self.q = self.q, np.where(self._heavy, after, self.q)
