"""The largest stress anywhere in a wall: over time, angle and depth, layer by layer.

In a layer the strain is linear in the depth z, and so is the stress but for the field of a piezoelectric layer, a half cosine's
derivative. A magnitude of what is linear in z, |sigma| or the von Mises stress (a norm), is convex in z: it is largest at a face of the
layer. Faces of all layers are searched. The field's part, C sin x with x from -pi/2 to pi/2 through its layer, leaves the straight line
between the faces by 0.21 C at most, which on the paper's walls is less than a thousandth of the largest stress.

At each depth no instant can exceed the sum over the orders of their amplitudes, in the norm that the von Mises stress is; instants that
cannot reach the largest value found so far are left out, so that few are summed around the circle.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from typing import Any

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.layers import Shell
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.circle import FINE, circle_angles, on_circle
from coaxshell.response.components import SIDES, STRESSES, von_mises
from coaxshell.response.modal import amplitudes, elastic_wall, stress_gain_of
from coaxshell.response.peaks import Peak, folded
from coaxshell.response.relaxing import Relaxing, relaxed_solution
from coaxshell.response.synthesis import BLOCK, angle_basis, at_angles
from coaxshell.response.voltages import ActuatorLimit, actuator_limit, applied, demanded_voltage
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.laminate import missing_constants
from coaxshell.structure.losses import Relaxation

COMPONENTS = ("von_mises", *STRESSES)
_FIRST = 16
"""Instants summed before the others are judged by what they can reach."""


@dataclass(frozen=True, kw_only=True)
class WallPeak(Peak):
    """The largest magnitude of a stress in a layer or a wall, Pa, with its time (transits) and angle (degrees).

    Attributes
    ----------
    depth : float
        Where, m outward from the mid-surface.
    layer : int
        In which layer, counted from the inside.
    material : str
        Of that layer.
    component : str
        "von_mises", "hoop", "axial" or "shear".
    margin : float or None
        Strength over stress; of a wall that of the layer that comes nearest to its strength. None where no strength is known.
    weakest : int or None
        That layer.
    station : float or None
        Axial position of a run in three dimensions, m.
    """

    depth: float
    layer: int
    material: str
    component: str
    margin: float | None = None
    weakest: int | None = None
    station: float | None = None


class WallStress:
    """The stresses at any depth of the wall of one shell of a run.

    Parameters
    ----------
    solution : ModalSolution
        In two dimensions, or at a station.
    shell : int

    Raises
    ------
    InputError
        If the shell is rigid.
    """

    def __init__(self, solution: ModalSolution, shell: int) -> None:
        self.solution, self.shell = solution, shell
        self.wall = elastic_wall(solution.problem, shell)
        self._relaxed: dict[Relaxation | None, ModalSolution] = {None: solution}

    def components(self, component: str) -> tuple[str, ...]:
        """Return the components that one is made of: in two dimensions there is no shear along the axis."""
        if component != "von_mises":
            return (component,)
        return STRESSES if self.solution.along is not None else ("hoop", "axial")

    @cached_property
    def _voltage(self) -> FloatArray:
        return demanded_voltage(self.solution, self.shell)

    def _per_volt(self, depth: float | None, component: str) -> float:
        """Return what a volt of control adds to a stress at a depth (m), Pa."""
        if depth is None or self.wall.gains is None or component == "shear":
            return 0.0
        scales = self.solution.problem.scales
        return scales.pressure * self.wall.control_stress(depth / scales.length, component)

    @cached_property
    def _limit(self) -> ActuatorLimit:
        return actuator_limit(self.solution, self.shell)

    def amplitudes(self, depth: float | None, component: str) -> FloatArray:
        """Return the modal amplitudes of a component at a depth (m), Pa, (parities, M + 1, T), without what a cut voltage adds.

        Without a depth those of the core at the mid-surface.
        """
        gain = stress_gain_of(self.solution, self.shell, depth, component)
        parts = gain.parts if isinstance(gain, Relaxing) else ((None, gain),)
        total: FloatArray | None = None
        for factor, part in parts:
            if factor not in self._relaxed:
                self._relaxed[factor] = relaxed_solution(self.solution, factor, self.shell)
            one = amplitudes(self._relaxed[factor], self.shell, part)
            total = one if total is None else np.add(total, one, out=total)
        assert total is not None
        per_volt = self._per_volt(depth, component)
        if per_volt and not self._limit.saturates:
            total += per_volt * self._voltage
        return total

    def cut_voltage(self, depth: float | None, component: str) -> float:
        """Return the Pa per volt of a saturating actuator at a depth (m); 0 elsewhere."""
        per_volt = self._per_volt(depth, component)
        return per_volt if per_volt and self._limit.saturates else 0.0

    def volts(self, basis: FloatArray, window: slice | FloatArray) -> FloatArray:
        """Return the voltage of a saturating actuator at the angles of a basis, (T, A)."""
        return applied(at_angles(self._voltage[..., window], basis), self._limit)

    def depths(self) -> Iterator[tuple[int, tuple[float, ...]]]:
        """Yield each layer with the depths (m) among which its largest stress is."""
        length = self.solution.problem.scales.length
        for number, depths in enumerate(self.wall.sampled_depths):
            yield number, tuple(length * z for z in depths)

    def at(self, depth: float | None, component: str) -> AtDepth:
        """Return a stress at a depth (m), or of the core at the mid-surface."""
        return AtDepth(self, depth, component)


class AtDepth:
    """A stress at one depth: its components' amplitudes, what they can reach, and its magnitude at angles."""

    def __init__(self, stress: WallStress, depth: float | None, component: str) -> None:
        self._stress, self.names = stress, stress.components(component)
        self.modal = {name: stress.amplitudes(depth, name) for name in self.names}
        self._cut = {name: per_volt for name in self.names if (per_volt := stress.cut_voltage(depth, name))}

    def reach(self, window: slice) -> FloatArray:
        """Return what the magnitude cannot exceed at any angle, at the instants of a window: a sum over orders of a norm of amplitudes."""
        parts = {name: modal[..., window] for name, modal in self.modal.items()}
        if len(parts) == 1:
            squares = next(iter(parts.values())) ** 2
        else:
            hoop, axial = parts["hoop"], parts["axial"]
            squares = hoop**2 + (axial - hoop) * axial
            if "shear" in parts:
                squares = squares + 3.0 * parts["shear"] ** 2
        bound = np.sqrt(np.maximum(squares.sum(axis=0), 0.0)).sum(axis=0)
        cut = sum(abs(x) for x in self._cut.values()) * self._stress._limit.volts if self._cut else 0.0
        return np.asarray((bound + cut) * (1.0 + 1e-9))

    def on_circle(self, instants: Any) -> FloatArray:
        """Return the magnitude at the angles of :func:`~coaxshell.numerics.circle.circle_angles` and some instants, (A, T)."""
        fields = {}
        for name, modal in self.modal.items():
            some = modal[..., instants]
            fields[name] = on_circle(some) if SIDES[name] == "normal" else _sines(some)
        if self._cut:
            parities, orders, _ = self.modal["hoop" if "hoop" in self.modal else self.names[0]].shape
            volts = self._stress.volts(angle_basis(circle_angles(orders, parities), orders, parities), instants).T
            fields = {name: field + self._cut.get(name, 0.0) * volts for name, field in fields.items()}
        return self._magnitude(fields)

    def at_angles(self, theta: FloatArray, window: Any) -> FloatArray:
        """Return the magnitude at angles (degrees), (T, A)."""
        fields = {}
        for name, modal in self.modal.items():
            parities, orders, _ = modal.shape
            fields[name] = at_angles(modal[..., window], angle_basis(theta, orders, parities, SIDES[name]))
            if name in self._cut:
                fields[name] = fields[name] + self._cut[name] * self._stress.volts(angle_basis(theta, orders, parities), window)
        return self._magnitude(fields)

    def _magnitude(self, fields: dict[str, FloatArray]) -> FloatArray:
        if len(fields) == 1:
            return np.abs(next(iter(fields.values())))
        return von_mises(fields["hoop"], fields["axial"], fields.get("shear", 0.0))


def _sines(modal: FloatArray) -> FloatArray:
    """Return the sum of sin(m theta) and -cos(m theta) at the angles of the circle."""
    if len(modal) == 2:
        return on_circle(np.stack([-modal[1], modal[0]]))
    return on_circle(np.stack([np.zeros_like(modal[0]), modal[0]]))[: len(circle_angles(modal.shape[1], 1))]


def layer_peaks(solution: ModalSolution, shell: int, component: str, window: slice, station: float | None = None) -> list[WallPeak]:
    """Return the largest magnitude of a stress in each layer of a shell over a window of time, all angles and its depths.

    Parameters
    ----------
    solution : ModalSolution
    shell : int
    component : str
        One of :data:`COMPONENTS`.
    window : slice
        Time indices.
    station : float, optional
        What to tell of the axial position, m.

    Raises
    ------
    InputError
        If the shell is rigid or no thin wall, or a material lacks constants along the axis.
    """
    stress = WallStress(solution, shell)
    if not stress.wall.sampled_depths:
        remedy = 'read response.stress at depths of your own, or use theory = "thin"'
        raise InputError(f"shells[{shell}].theory", "the largest stress is searched through thin walls alone", remedy)
    described = solution.problem.system.shells[shell]
    layers = described.layers if isinstance(described, Shell) else ()
    found = []
    for number, depths in stress.depths():
        best: tuple[float, float, int, int] = (-1.0, depths[0], window.start, 0)
        kept: AtDepth | None = None
        for depth in depths:
            at = stress.at(depth, component)
            value, instant, place = _largest(at, window, best[0])
            if value > best[0]:
                best, kept = (value, depth, instant, place), at
        assert kept is not None
        peak = _refined(kept, solution, window, best[2], best[3])
        material = layers[number].material if number < len(layers) else None
        strength = getattr(material, "strength", None)
        margin = None if strength is None or peak.value == 0.0 else strength / peak.value
        found.append(
            WallPeak(
                value=peak.value,
                time=peak.time,
                angle=peak.angle,
                growing=peak.growing,
                depth=best[1],
                layer=number,
                material=getattr(material, "name", ""),
                component=component,
                margin=margin,
                weakest=None if margin is None else number,
                station=station,
            )
        )
    return found


def _largest(at: AtDepth, window: slice, above: float) -> tuple[float, int, int]:
    """Return the largest magnitude at one depth with its instant and place on the circle; -1 if none exceeds *above*."""
    bound = at.reach(window)
    orders = next(iter(at.modal.values())).shape[1]
    width = max(1, BLOCK // (8 * orders))
    best, instant, place = above, -1, 0
    order = np.argsort(-bound, kind="stable")
    start, step = 0, _FIRST
    while start < order.size and bound[order[start]] > best:
        some = window.start + np.sort(order[start : start + step][bound[order[start : start + step]] > best])
        field = at.on_circle(some)
        i, k = np.unravel_index(int(field.argmax()), field.shape)
        if field[i, k] > best:
            best, instant, place = float(field[i, k]), int(some[k]), int(i)
        start, step = start + step, width
    return (best, instant, place) if instant >= 0 else (-1.0, window.start, 0)


def _refined(at: AtDepth, solution: ModalSolution, window: slice, instant: int, place: int) -> Peak:
    """Return the largest in steps of the circle FINE times finer around a place, at an instant and the two beside it."""
    parities, orders = solution.normal.shape[1:3]
    grid = circle_angles(orders, parities)
    near = slice(max(window.start, instant - 1), min(window.stop, instant + 2))
    angles = grid[place] + (grid[1] - grid[0]) / FINE * np.arange(-FINE, FINE + 1)
    values = at.at_angles(angles, near)
    k, i = np.unravel_index(int(values.argmax()), values.shape)
    angle = folded(float(angles[i]))
    growing = bool(near.start + k == window.stop - 1 and k > 0 and values[k, i] > values[k - 1, i])
    return Peak(float(values[k, i]), float(solution.time[near.start + k]), abs(angle) if parities == 1 else angle, growing)


def of_wall(layers: list[WallPeak]) -> WallPeak:
    """Return the largest stress of a wall's layers, with the margin of the one that comes nearest to its strength."""
    largest = max(layers, key=lambda peak: peak.value)
    known = [peak for peak in layers if peak.margin is not None]
    if not known:
        return largest
    nearest = min(known, key=lambda peak: float(peak.margin or 0.0))
    return replace(largest, margin=nearest.margin, weakest=nearest.layer)


def usual_component(solution: ModalSolution, shell: int) -> str:
    """Return "von_mises", or "hoop" where a material lacks constants along the axis."""
    described = solution.problem.system.shells[shell]
    lacking = isinstance(described, Shell) and any(missing_constants(layer.material) for layer in described.layers)
    return "hoop" if lacking else "von_mises"


def largest_through_wall(solution: ModalSolution, shell: int, window: slice, length: float, *, halved: bool = True) -> Peak:
    """Return the largest stress anywhere in a wall within a window; a mean over a segment is not taken."""
    return of_wall(layer_peaks(solution, shell, usual_component(solution, shell), window))


def largest_of_the_core(solution: ModalSolution, shell: int, window: slice, length: float, *, halved: bool = True) -> Peak:
    """Return the largest von Mises stress of the core at the mid-surface within a window; a mean over a segment is not taken."""
    at = WallStress(solution, shell).at(None, "von_mises")
    _, instant, place = _largest(at, window, -1.0)
    return _refined(at, solution, window, instant, place)


def of_the_core(motion: WallMotion, shell: int, theta: FloatArray) -> FloatArray:
    """Return the von Mises stress of the core at the mid-surface at angles (degrees), Pa, (T, A)."""
    at = WallStress(motion.solution, shell).at(None, "von_mises")
    return at.at_angles(np.atleast_1d(theta), slice(0, motion.solution.time.size))


def through_wall(motion: WallMotion, shell: int, theta: FloatArray) -> FloatArray:
    """Return the largest stress through the wall at angles (degrees), Pa, (T, A)."""
    stress, component = WallStress(motion.solution, shell), usual_component(motion.solution, shell)
    every = slice(0, motion.solution.time.size)
    each = (stress.at(z, component).at_angles(np.atleast_1d(theta), every) for _, depths in stress.depths() for z in depths)
    return np.asarray(reduce(np.maximum, each))
