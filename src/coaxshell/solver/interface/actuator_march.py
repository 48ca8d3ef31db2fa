"""The march of saturating actuators alone: blocks of steps, by sums around the circle and a fixed point that must converge.

At the steps of a block the voltages asked for are, by modes and in units of the limits,

    u = b + Z clip(u),

b what is known: the voltages without actuators, and what those given in earlier blocks add. Z is the lower triangular Toeplitz matrix of
the first weights of the kernels, one a mode. With clip(u) = sigma u + r(u),

    u <- (1 - sigma Z)^-1 [b + Z r(u)],

where r has slopes of -sigma to 1 - sigma, at most sigma for sigma >= 1/2. Modes are orthogonal around the circle, so an iteration leaves
at most the part

    rho = max over modes of |sigma (1 - sigma Z)^-1 Z|_2

of an error, which is below 1 wherever feedback damps (-Z has a positive real part) and grows with the length of a block: the longest
block whose rho is small enough is taken, and where none is, the march of any interface (:mod:`coaxshell.solver.interface.march`) is
left to do it, by Newton's method. Steps that no limit touches are linear, sigma = 1, and solved at once; elsewhere only points that may
be held are summed over (:mod:`coaxshell.solver.interface.clipping`).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.convolution import History, HistorySum, KernelTable
from coaxshell.numerics.progress import Progress
from coaxshell.solver.interface.absorbers import AbsorberSet
from coaxshell.solver.interface.clipping import SHARE, Settled, settle
from coaxshell.solver.interface.plan import Actuators, actuators_of, demanded_voltage
from coaxshell.solver.interface.saturation import CircleSums
from coaxshell.solver.structure_spectra import StructureSpectra

_LENGTHS = (8, 4, 2, 1)
_SLOWEST = 0.97
"""The largest rho of a block: longer ones take more iterations than they save."""
_SLOWEST_ALONE = 0.95
"""The same of a single step, beyond which Newton's method is faster."""


class ActuatorHistories(NamedTuple):
    """Voltages given, in units of the limits, (controlled, parities, M + 1, T); whether any was cut; iterations of all blocks together."""

    given: FloatArray
    saturated: bool
    iterations: int


@dataclass(frozen=True, eq=False)
class ActuatorPlan:
    """Constants of such a march.

    Attributes
    ----------
    weights : ndarray, shape (controlled, controlled, M + 1, T)
        Voltages asked for per voltage given, both in units of the limits.
    length : int
        Steps of a block.
    linear : ndarray, shape (M + 1, controlled * length, controlled * length)
        (1 - Z)^-1.
    known, given : ndarray, same shape
        (1 - sigma Z)^-1, and that times Z.
    circle : CircleSums
    """

    weights: FloatArray
    length: int
    linear: FloatArray
    known: FloatArray
    given: FloatArray
    circle: CircleSums

    @classmethod
    def of(cls, structure: StructureSpectra, actuators: Actuators) -> ActuatorPlan | None:
        """Return the plan with the longest block that converges fast, None if there is none."""
        of_pressure = structure.kernels_with_voltage.kernels[actuators.shells :, actuators.controlled]
        weights = of_pressure * (actuators.full_pressure / actuators.limits[:, None])[..., None, None]
        circle = CircleSums(actuators.modes, actuators.parities)
        for length in _LENGTHS:
            toeplitz = _toeplitz(weights, length)
            own = np.eye(toeplitz.shape[-1])
            known = np.asarray(np.linalg.inv(own - SHARE * toeplitz), dtype=np.float64)
            given = known @ toeplitz
            if SHARE * float(np.linalg.norm(given, 2, axis=(1, 2)).max()) <= (_SLOWEST if length > 1 else _SLOWEST_ALONE):
                linear = np.asarray(np.linalg.inv(own - toeplitz), dtype=np.float64)
                return cls(weights, length, linear, known, given, circle)
        return None

    def march(self, demanded: FloatArray, progress: Progress | None = None) -> ActuatorHistories:
        """Return the voltages given where *demanded* are asked for without actuators, (controlled, parities, M + 1, T)."""
        walls, parities, modes, steps = demanded.shape
        sums, history = HistorySum(KernelTable(self.weights), parities), History()
        found, saturated, iterations = np.zeros_like(demanded), False, 0
        asked = np.zeros((walls, self.length, parities, modes))
        for start in range(1, steps, self.length):  # at rest at t = 0
            block = slice(start, min(start + self.length, steps))
            count = block.stop - start
            excited = np.zeros((walls, parities, modes, self.length))  # a last, shorter block is filled up with zeros
            excited[..., :count] = demanded[..., block]
            if history.step:
                excited[..., :count] += sums.forcing(history, count)
            asked, given, taken = self._block(excited.transpose(0, 3, 1, 2), asked)
            found[..., block] = given[:, :count].transpose(0, 2, 3, 1)
            saturated, iterations = saturated or taken > 0, iterations + taken
            history, _ = sums.push(history, found[..., block])
            if progress is not None:
                progress(block.stop / steps, "interface march")
        return ActuatorHistories(found, saturated, iterations)

    def _block(self, excited: FloatArray, before: FloatArray) -> Settled:
        """Return the voltages asked for and given in a block, (controlled, steps, parities, M + 1), and the iterations, 0 below all limits.

        ``excited`` is b, ``before`` what the block before asked for: its last step is where the iteration begins.
        """
        linear = _times(self.linear, excited)
        if np.abs(linear).sum(axis=(-2, -1)).max() <= 1.0 or np.abs(self.circle.at_points(linear)).max() <= 1.0:
            return Settled(linear, linear, 0)
        known = _times(self.known, excited)
        start = np.broadcast_to(before[:, -1:], before.shape)
        return settle(self.circle, lambda rest: _times(self.given, rest) + known, start)


def march_actuators(structure: StructureSpectra, absorbers: AbsorberSet, progress: Progress | None = None) -> ActuatorHistories | None:
    """March the saturating actuators of a structure over all times of its linear response; None where the fixed point would be slow.

    Parameters
    ----------
    structure : StructureSpectra
    absorbers : AbsorberSet
        Empty.
    progress : callable, optional
    """
    actuators = actuators_of(structure, structure.points(absorbers), structure.controlled)
    plan = ActuatorPlan.of(structure, actuators)
    return None if plan is None else plan.march(demanded_voltage(structure, actuators), progress)


def _toeplitz(weights: FloatArray, length: int) -> FloatArray:
    """Return what convolves a block, shape (M + 1, rows * length, columns * length), with weights (rows, columns, M + 1, T)."""
    rows, columns, modes, steps = weights.shape
    head = np.zeros((rows, columns, modes, length))
    head[..., : min(length, steps)] = weights[..., :length]
    lags = np.arange(length)[:, None] - np.arange(length)
    blocks = np.where(lags >= 0, head[..., np.maximum(lags, 0)], 0.0)
    return np.ascontiguousarray(blocks.transpose(2, 0, 3, 1, 4).reshape(modes, rows * length, columns * length))


def _times(matrices: FloatArray, modal: FloatArray) -> FloatArray:
    """Return matrices (M + 1, rows * length, columns * length) times modal values (columns, length, parities, M + 1)."""
    groups, length, parities, modes = modal.shape
    columns = np.ascontiguousarray(modal.reshape(groups * length, parities, modes).transpose(2, 0, 1))
    return np.ascontiguousarray((matrices @ columns).transpose(1, 2, 0)).reshape(-1, length, parities, modes)
