"""Which metrics have a gradient, and of which amplitudes each is a norm."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np

from coaxshell.errors import InputError
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.modal import amplitudes, scaled, voltage_gain
from coaxshell.response.quantities import Where, shell_metrics
from coaxshell.response.relaxing import Relaxing, relaxed, relaxed_transposed
from coaxshell.response.voltages import actuator_limit, mean_shares
from coaxshell.solver.adjoint.answer import Reading
from coaxshell.solver.adjoint.faces import Rows
from coaxshell.solver.electrodes import segment_length
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.structure.control_law import ControlGains
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.shell_model import FieldGain, Gain
from coaxshell.studies.gradients.norms import Norm, power_mean, root_mean_square
from coaxshell.studies.metrics import Metric


class Parts(NamedTuple):
    """Gains on what a wall shows, each under a factor g(s) of losses or None for 1, and on rates of W and V, that make a quantity."""

    at_once: tuple[tuple[Relaxation | None, Gain | FieldGain], ...]
    rate: Gain | None = None


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
        modal = np.zeros_like(solution.normal[self.shell])
        for factor, gain in at_once:
            modal += relaxed(solution, factor, amplitudes(solution, self.shell, gain))
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
        normal, tangential = np.zeros((2, *solved.normal.shape), np.complex128)
        rows: Rows = {}

        def at_nodes(histories: FloatArray) -> ComplexArray:
            every = np.zeros((*slope.shape[:2], grid.time.size))
            every[..., :: solution.settings.refinement] = histories
            return grid.invert_transposed(every)

        for factor, gain in at_once:
            spectrum = at_nodes(relaxed_transposed(solution, factor, slope))
            if solved.solid is not None:
                rows |= {(self.shell, row): each[:, None] * spectrum for row, each in _rows(gain).items()}
            elif isinstance(gain, Gain):
                normal[self.shell] += gain.w[:, None] * spectrum
                tangential[self.shell] += gain.v[:, None] * spectrum
        if rate is not None:
            spectrum = at_nodes(slope)
            normal[self.shell] += rate.w[:, None] * (spectrum * grid.nodes)
            tangential[self.shell] += rate.v[:, None] * (spectrum * grid.nodes)
        return Reading(normal, tangential, rows)


def _rows(gain: Gain | FieldGain) -> dict[int, FloatArray]:
    """Return the factors by row of what a wall shows: 0 W, 1 V, 2 hoop stress, then potentials."""
    if isinstance(gain, Gain):
        return {0: gain.w, 1: gain.v}
    found = {{"w": 0, "v": 1, "hoop": 2}[name]: factor for name, factor in gain.fields.items()}
    return found if gain.layer is None else {**found, 3 + gain.layer: np.asarray(gain.potential)}


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
        If it is none, or in its wall no sum of what that shows at the same instant.
    """
    if not has_gradient(metric):
        remedy = "use the RMS or the peak of stress, displacement or voltage of a shell, such as inner.rms_stress, or a mass"
        raise InputError("metric", f"{metric.name!r} has no gradient", remedy)
    assert isinstance(metric.place, int)
    shell, quantity = metric.place, metric.quantity
    entry = shell_metrics().get(quantity)

    def seen(problem: Problem) -> Any:
        return SimpleNamespace(problem=problem, normal=np.empty((0, 1, orders)), along=None)

    def of_driven(problem: Problem, share: FloatArray) -> Parts:
        """Return the voltage that the law gives, which a wall with two faces shows as its last potential."""
        wall = problem.shells[shell]
        return Parts(((None, FieldGain(potential=share, layer=wall.shown_potentials - 1)),))

    def of_table(problem: Problem) -> Parts:
        assert entry is not None
        assert entry[0].gain is not None
        gain = entry[0].gain(seen(problem), shell)
        return Parts(gain.parts if isinstance(gain, Relaxing) else ((None, gain),))

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
            return Parts(((None, scaled(sensor, 0.0 * share)),))
        if not problem.shells[shell].faces_move_alike:
            return of_driven(problem, share)
        if not isinstance(gains, ControlGains):
            remedy = "use its sensor's voltage, or a PDControl"
            raise InputError("metric", f"{metric.name!r} has no gradient: a law H(s) remembers earlier instants", remedy)
        at_once, rate = scaled(sensor, gains.proportional * share), scaled(sensor, gains.derivative * share)
        return Parts(((None, at_once),), rate)  # type: ignore[arg-type]

    parts, where = (of_voltage, "anywhere") if entry is None else (of_table, entry[1])
    made = parts(problem)
    solid = not problem.shells[shell].faces_move_alike
    shown = all(isinstance(part, Gain) or (solid and isinstance(part, FieldGain)) for _, part in made.at_once)
    if not shown or (made.rate is not None and not isinstance(made.rate, Gain)):
        remedy = "use its displacement, or a wall of the theory of thin walls"
        raise InputError("metric", f"{metric.name!r} has no gradient: in this wall it is no sum of V and W of the same instant", remedy)
    return SmoothMetric(metric, shell, where, power, parts)  # type: ignore[arg-type]
