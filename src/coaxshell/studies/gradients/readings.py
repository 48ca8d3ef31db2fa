"""Which metrics have a gradient, and of which amplitudes each is a norm."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.modal import scaled, voltage_gain
from coaxshell.response.quantities import Where, shell_metrics
from coaxshell.response.voltages import actuator_limit, mean_shares
from coaxshell.solver.adjoint.answer import Reading
from coaxshell.solver.electrodes import segment_length
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.structure.control_law import ControlGains
from coaxshell.structure.shell_model import Gain
from coaxshell.studies.gradients.norms import Norm, power_mean, root_mean_square
from coaxshell.studies.metrics import Metric

Parts = tuple[Gain, Gain | None]
"""Gains on W and V, and on their rates, by which a quantity is made of them."""

_VOLTAGES = ("peak_actuator_voltage", "peak_actuator_field", "actuator_field_ratio")
_SEGMENT_METRICS = ("segment_actuator_voltage", "segment_actuator_field", "segment_field_ratio")


@dataclass(frozen=True)
class SmoothMetric:
    """A metric as a norm of modal amplitudes that are linear in the motion of one shell.

    Attributes
    ----------
    metric : Metric
    shell : int
    where : str
        "anywhere", "head", "tail" or "rms".
    power : float or None
        Of the mean that stands for a largest magnitude; None for that itself.
    parts : callable
        From a problem to the gains of the quantity.
    """

    metric: Metric
    shell: int
    where: Where
    power: float | None
    parts: Callable[[Problem], Parts]

    def amplitudes(self, solution: ModalSolution, problem: Problem | None = None) -> FloatArray:
        """Return the modal amplitudes (parities, M + 1, T) of the quantity; with the gains of another problem if given."""
        at_once, rate = self.parts(problem or solution.problem)
        modal = at_once.w[:, None] * solution.normal[self.shell] + at_once.v[:, None] * solution.tangential[self.shell]
        if rate is not None:
            assert solution.normal_rate is not None
            assert solution.tangential_rate is not None
            modal += rate.w[:, None] * solution.normal_rate[self.shell] + rate.v[:, None] * solution.tangential_rate[self.shell]
        return np.asarray(modal)

    def norm(self, solution: ModalSolution) -> Norm:
        """Return the value of a run, and what a unit of each amplitude changes of it."""
        modal, head = self.amplitudes(solution), solution.problem.system.sources[0].angle
        if self.where == "rms":
            return root_mean_square(modal, solution.time)
        return power_mean(modal, solution.time, self.power, self.where, head)

    def reading(self, solution: ModalSolution, solved: SolvedSpectra, slope: FloatArray) -> Reading:
        """Return what a unit of W and V at every node changes, from what a unit of each amplitude does."""
        grid, (at_once, rate) = solved.grid, self.parts(solution.problem)
        every = np.zeros((*slope.shape[:2], grid.time.size))
        every[..., :: solution.settings.refinement] = slope
        spectrum = grid.invert_transposed(every)
        normal, tangential = np.zeros((2, *solved.normal.shape), np.complex128)
        normal[self.shell], tangential[self.shell] = at_once.w[:, None] * spectrum, at_once.v[:, None] * spectrum
        if rate is not None:
            normal[self.shell] += rate.w[:, None] * (spectrum * grid.nodes)
            tangential[self.shell] += rate.v[:, None] * (spectrum * grid.nodes)
        return Reading(normal, tangential)


def has_gradient(metric: Metric) -> bool:
    """Return whether a metric has a gradient in some system: masses, distances, and norms of what is linear in the motion of a shell."""
    if metric.function is not None:
        return False
    entry = shell_metrics().get(metric.quantity)
    named = metric.quantity in (*_VOLTAGES, *_SEGMENT_METRICS) or (entry is not None and entry[0].gain is not None and entry[0].rate == 0)
    return named or (metric.of_design and metric.quantity != "absorber_count")


def smooth_metric(metric: Metric, problem: Problem, orders: int, power: float | None) -> SmoothMetric:
    """Return a metric of a shell as a norm.

    Parameters
    ----------
    metric : Metric
    problem : Problem
    orders : int
        M + 1 of the run.
    power : float or None

    Raises
    ------
    InputError
        If it is none, or its wall has losses or is an elastic solid, whose stress depends on the whole history.
    """
    if not has_gradient(metric):
        remedy = "use the RMS or the peak of stress, displacement or voltage of a shell, such as inner.rms_stress, or a mass"
        raise InputError("metric", f"{metric.name!r} has no gradient", remedy)
    assert isinstance(metric.place, int)
    shell, quantity = metric.place, metric.quantity
    entry = shell_metrics().get(quantity)

    def seen(problem: Problem) -> Any:
        return SimpleNamespace(problem=problem, normal=np.empty((0, 1, orders)), along=None)

    def of_table(problem: Problem) -> Parts:
        assert entry is not None
        assert entry[0].gain is not None
        return entry[0].gain(seen(problem), shell), None  # type: ignore[return-value]

    def of_voltage(problem: Problem) -> Parts:
        run, gains = seen(problem), problem.shells[shell].gains
        sensor = voltage_gain(run, shell)
        share = np.ones(orders)
        if quantity in _SEGMENT_METRICS:
            share = mean_shares(run, shell, segment_length(problem, shell))
        if quantity.endswith("field"):
            wall = problem.system.shells[shell]
            share = share / min(layer.thickness for layer in wall.serving("actuator"))  # type: ignore[union-attr]
        elif quantity.endswith("ratio"):
            share = share / actuator_limit(run, shell).volts
        if gains is None:
            return scaled(sensor, 0.0 * share), None  # type: ignore[return-value]
        if not isinstance(gains, ControlGains):
            remedy = "use its sensor's voltage, or a PDControl"
            raise InputError("metric", f"{metric.name!r} has no gradient: a law H(s) remembers earlier instants", remedy)
        return scaled(sensor, gains.proportional * share), scaled(sensor, gains.derivative * share)  # type: ignore[return-value]

    parts, where = (of_voltage, "anywhere") if entry is None else (of_table, entry[1])
    if not all(isinstance(part, Gain) for part in parts(problem) if part is not None):
        remedy = "use its displacement, or a wall without losses of the theory of thin walls"
        raise InputError("metric", f"{metric.name!r} has no gradient: in this wall it is no sum of V and W of the same instant", remedy)
    return SmoothMetric(metric, shell, where, power, parts)  # type: ignore[arg-type]
