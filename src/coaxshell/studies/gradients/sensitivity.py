"""What fields of a system change of one metric of one run, to first order."""

from __future__ import annotations

import math
import re
from functools import cached_property

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.absorbers import Absorber, AbsorberRing, gaps_of
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response import Response
from coaxshell.solver.adjoint.answer import Backwards
from coaxshell.solver.adjoint.faced import FacedSensitivity
from coaxshell.solver.adjoint.laws import ElementSensitivity
from coaxshell.solver.adjoint.planes import backwards_with_planes
from coaxshell.solver.adjoint.structure import StructureSensitivity
from coaxshell.solver.interface.absorbers import AbsorberSet, absorber_set, properties
from coaxshell.solver.recompute import spectra_of
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.solved_spectra import SolvedSpectra
from coaxshell.studies.gradients.norms import Norm
from coaxshell.studies.gradients.readings import Parts, SmoothMetric, smooth_metric
from coaxshell.studies.metrics import Metric
from coaxshell.studies.reading import DesignReading, MetricSource
from coaxshell.studies.varied_fields import Field, field_of, varied

_STEP = 1e-3
"""Relative step at which the ingredients of a run, never the run itself, are differenced."""
_STEP_OF_SOLIDS = 3e-4
"""The same where walls answer by their resonances, which stand beside the contour of the transform: what a sensor reads of the lowest
shapes is rounded at 3e-10."""
_ABSORBER = re.compile(r"absorbers(?:\[(\d{1,9})\])?\.(\w+)")
_FIELDS = ("mass", "damping", "linear_stiffness", "cubic_stiffness")


class MetricSensitivity:
    """One metric of a run, and what fields of the system change of it.

    Parameters
    ----------
    system : System
    metric : Metric
    power : float or None
        Of the mean that stands for a largest magnitude; None for that itself.
    response : Response, optional
        Of its run by the spectral engine in two dimensions; needed but for masses and distances.

    Raises
    ------
    InputError
        If the metric, or the run, has no gradient.
    """

    def __init__(self, system: System, metric: Metric, power: float | None, response: Response | None = None) -> None:
        self.system, self.metric = system, metric
        if metric.of_design:
            self.value = self.peak = metric(DesignReading(system))
            return
        assert response is not None
        self._solution, self._problem = response.solution, response.solution.problem
        orders = self._solution.normal.shape[2]
        self._smooth: SmoothMetric = smooth_metric(metric, self._problem, orders, power)
        norm = self._norm
        self.value = norm.value
        self.peak = norm.value if self._smooth.where == "rms" else metric(MetricSource(response))

    @cached_property
    def _norm(self) -> Norm:
        return self._smooth.norm(self._solution)

    @cached_property
    def _solved(self) -> SolvedSpectra:
        return self._solution.spectra or spectra_of(self._solution)

    @cached_property
    def _back(self) -> Backwards:
        return backwards_with_planes(self._solved, self._smooth.reading(self._solution, self._solved, self._norm.slope))

    @cached_property
    def _structure(self) -> StructureSensitivity | FacedSensitivity:
        kind = StructureSensitivity if self._solved.solid is None else FacedSensitivity
        return kind(self._solved, self._back)

    @cached_property
    def _of_absorbers(self) -> dict[str, FloatArray]:
        """What the metric changes by per SI unit of each property of every absorber of the description, per degree of its angle."""
        system, count = self.system, len(self.system.absorber_list)
        if self.metric.of_design:
            return _of_design(self.metric, system)
        found, absorbers = self._back.links, self._solved.absorbers
        member, share = absorbers.member, 1.0 / absorbers.multiplicity
        unit = Absorber(mass=1.0, damping=1.0, linear_stiffness=1.0, cubic_stiffness=1.0)
        scales = properties([unit], self._problem.scales)
        per_unit = (found.mass, found.damping, found.linear, found.cubic)
        answer = {name: (per * share)[member] * float(scale[0]) for name, per, scale in zip(_FIELDS, per_unit, scales, strict=True)}
        angles = np.array([one.angle for one in system.absorber_list]).reshape(count)
        turned = np.remainder(angles - absorbers.angle[member] + 180.0, 360.0) - 180.0
        facing = np.where(np.abs(turned) < 1e-6, 1.0, -1.0)  # a mirror image turns the other way
        answer["angle"] = (found.around.angle * share)[member] * facing
        return answer

    def of(self, path: str) -> float:
        """Return what the metric changes by per unit of a field, in SI (degrees for angles).

        Parameters
        ----------
        path : str
            Dotted, as ``absorbers[0].mass``, ``control.derivative`` or ``shells[0].layers[1].thickness``.

        Raises
        ------
        InputError
            If it is no field of the system that varies continuously, or the metric has no gradient by it.
        """
        match = _ABSORBER.fullmatch(path.strip())
        name = "" if match is None else "angle" if match[2] == "offset" and isinstance(self.system.absorbers, AbsorberRing) else match[2]
        if match is not None and name in (*_FIELDS, "angle") and self.system.absorber_list:
            each = self._of_absorbers[name]
            if match[1] is None and (name != "angle" or match[2] == "offset"):
                return self._finite(float(each.sum()), path)
            if match[1] is not None and isinstance(self.system.absorbers, tuple) and int(match[1]) < each.size:
                return self._finite(float(each[int(match[1])]), path)
        return self._differenced(path)

    def _finite(self, value: float, path: str) -> float:
        if math.isfinite(value):
            return value
        problem = "has no gradient where every absorber is linear: they are solved without steps"
        raise InputError(path, problem, "give one of them a cubic stiffness, however small")

    def _differenced(self, path: str) -> float:
        """Return the derivative by a field from what it changes in the ingredients of the run, by central differences of fourth order."""
        field = field_of(self.system, path)
        relative = _STEP if self.metric.of_design or not self._problem.two_faced else _STEP_OF_SOLIDS
        step = relative * (abs(float(field.present)) or 1.0) if field.quantity is not None else math.nan
        if not math.isfinite(step):
            raise InputError(path, "is not a number that varies continuously", "give a property such as absorbers[0].mass")
        coarse, fine = (self._slope(field, part * step) for part in (1.0, 0.5))
        return (4.0 * fine - coarse) / 3.0

    def _slope(self, field: Field, step: float) -> float:
        before, after = (self._beside(field, shift) for shift in (-step, step))
        if self.metric.of_design:
            return (self.metric(DesignReading(after)) - self.metric(DesignReading(before))) / (2.0 * step)
        first, second = (dimensionless(system, settings=self._solution.settings) for system in (before, after))
        change = self._structure.change(first, second) + self._change_of_gains(first, second) + self._change_of_absorbers(first, second)
        return change / (2.0 * step)

    def _beside(self, field: Field, shift: float) -> System:
        try:
            return varied(self.system, {field.path: float(field.present) + shift})
        except InputError as error:
            problem = f"has no gradient at {field.present!r}, the end of what is allowed ({error.problem})"
            raise InputError(field.path, problem, "begin inside of it") from None

    def _change_of_gains(self, before: Problem, after: Problem) -> float:
        """Return the change by what makes the quantity of the motion, which stays as it is: gains, and the losses in them."""
        first, second = (self._smooth.parts(problem) for problem in (before, after))
        if _equal(first, second):
            return 0.0
        ends = (self._smooth.amplitudes(self._solution, problem) for problem in (before, after))
        old, new = (float(np.einsum("hmt,hmt->", self._norm.slope, amplitudes)) for amplitudes in ends)
        return new - old

    def _change_of_links(self, sets: list[AbsorberSet], before: Problem, after: Problem) -> float:
        """Return the change by the laws of links and by the arcs that they hold; *sets* carry every absorber of the description."""
        found, carried, total = self._back.links, self._solved.absorbers, 0.0
        share = 1.0 / carried.multiplicity[carried.member]
        first, second = sets
        if found.elements is not None and first.elements is not None and second.elements is not None:
            each = [found.elements.elements[side * carried.count + i] for side in (0, 1) for i in carried.member]
            besides = ElementSensitivity([bars[2:] for bars in each])  # the first two are the common damper and springs
            total += float(besides.change(first.elements.elements, second.elements.elements) @ np.tile(share, 2))
        if first.footprint is not None:
            moved = second.means(after, self._solved.modes) - first.means(before, self._solved.modes)
            total += float(np.einsum("snm,snm,n->", found.around.shapes[:, carried.member], moved, share))
        return total

    def _change_of_absorbers(self, before: Problem, after: Problem) -> float:
        """Return the change by the absorbers' dimensionless properties and angles, their laws and footprints."""
        if not self.system.absorber_list:
            return 0.0
        lists = [problem.system.absorber_list for problem in (before, after)]
        if len(lists[0]) != len(lists[1]):
            raise InputError("absorbers.count", "is a count and has no gradient", "write the absorbers out and vary their properties")
        unit = Absorber(mass=1.0, damping=1.0, linear_stiffness=1.0, cubic_stiffness=1.0)
        scales = [float(scale[0]) for scale in properties([unit], self._problem.scales)]
        first, second = (properties(listed, problem.scales) for listed, problem in zip(lists, (before, after), strict=True))
        total = 0.0
        for name, scale, old, new in zip(_FIELDS, scales, first, second, strict=True):
            if np.any(old != new):
                total += float((self._of_absorbers[name] / scale) @ (new - old))
        if not self.metric.of_design:
            total += self._change_of_links(
                [absorber_set(problem, problem.system.absorber_list, 2) for problem in (before, after)], before, after
            )
        turned = np.array([b.angle - a.angle for a, b in zip(*lists, strict=True)])
        if turned.any():
            total += float(self._of_absorbers["angle"] @ turned)
        return self._finite(total, "absorbers.cubic_stiffness")


def _equal(first: Parts, second: Parts) -> bool:
    """Return whether two quantities are made of the motion in the same way."""
    pairs = [*zip(first.at_once, second.at_once, strict=True), ((None, first.rate), (None, second.rate))]
    same_factors = all(one[0] == other[0] for one, other in pairs)
    gains = [(one[1], other[1]) for one, other in pairs if one[1] is not None and other[1] is not None]
    parts = [(a, b) for one, other in gains for a, b in zip(one, other, strict=True)]
    return same_factors and all(np.array_equal(a, b) for a, b in parts)  # type: ignore[arg-type]


def _of_design(metric: Metric, system: System) -> dict[str, FloatArray]:
    """Return what a mass or a distance of the absorbers changes by with each of them."""
    listed = system.absorber_list
    found = {name: np.zeros(len(listed)) for name in (*_FIELDS, "angle")}
    if metric.quantity in ("absorber_mass", "total_mass"):
        found["mass"][:] = 1.0
    elif metric.quantity == "absorber_spacing":
        closest = min(neighbours(system), key=lambda pair: pair[3], default=None)
        if closest is not None:
            one, other, radius, _ = closest
            found["angle"][[one, other]] = np.radians(radius) * np.array([-1.0, 1.0])
    return found


def neighbours(system: System) -> list[tuple[int, int, float, float]]:
    """Return every two neighbours among the absorbers of a gap: their numbers, the second ahead, the radius beneath, and the arc, m."""
    found, listed = [], system.absorber_list
    for shell in {gap for one in listed for gap in gaps_of(one)}:
        here = sorted((i for i, one in enumerate(listed) if shell in gaps_of(one)), key=lambda i: listed[i].angle % 360.0)
        radius = system.shells[shell].radius
        for one, other in zip(here, [*here[1:], here[0]], strict=True):
            if one != other:
                turn = (listed[other].angle - listed[one].angle) % 360.0
                found.append((one, other, radius, math.radians(turn) * radius))
    return found
