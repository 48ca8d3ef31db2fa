"""The largest stress anywhere in a wall: over time, angle and depth, layer by layer.

In a layer the strain is linear in the depth z, and so is the stress but for the field of a piezoelectric layer, a half cosine's
derivative. A magnitude of what is linear in z, |sigma| or the von Mises stress (a norm), is convex in z: it is largest at a face of the
layer. Faces of all layers are searched. The field's part, C sin x with x from -pi/2 to pi/2 through its layer, leaves the straight line
between the faces by 0.21 C at most, which on the paper's walls is less than a thousandth of the largest stress. In a layer that is an
elastic solid the stress is a polynomial of the layer's degree: its points are searched, and then what lies between them around the
largest (:mod:`coaxshell.response.solid_wall_stress`).

At each depth no instant can exceed the sum over the orders of their amplitudes, in the norm that the von Mises stress is; instants that
cannot reach the largest value found so far are left out, so that few are summed around the circle.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial, reduce
from itertools import islice

import numpy as np

from coaxshell.errors import InputError
from coaxshell.model.layers import Shell
from coaxshell.model.materials import Material
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.circle import FINE, circle_angles, least_beside
from coaxshell.response.components import STRESSES
from coaxshell.response.depth_bounds import DepthStressWhereLarge, Driven, bounds
from coaxshell.response.depth_stress import CutVoltage, DepthStress
from coaxshell.response.modal import amplitudes, elastic_wall, stress_gain_of
from coaxshell.response.peaks import Peak, folded
from coaxshell.response.relaxing import Relaxing, relaxed_solution
from coaxshell.response.solid_wall_stress import SolidWallStress, StationWallStress
from coaxshell.response.stations import StationMotion
from coaxshell.response.synthesis import BLOCK, angle_basis, at_angles
from coaxshell.response.voltages import ActuatorLimit, CutElectrode, actuator_limit, applied, cut_voltage, demanded_voltage
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.laminate import missing_constants
from coaxshell.structure.losses import Relaxation
from coaxshell.structure.shell_model import SOLID_STRESSES, Gain

_FIRST = 16
"""Instants summed before the others are judged by what they can reach."""
_ROUNDING = 1e-9


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
        "von_mises", "hoop", "axial", "shear", or of elastic walls "radial" or "radial_hoop".
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
    """The stresses at any depth of a thin wall of a run.

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

    @property
    def components(self) -> tuple[str, ...]:
        """What may be asked for: in two dimensions there is no shear along the axis."""
        return ("von_mises", *self._made_of)

    @property
    def _made_of(self) -> tuple[str, ...]:
        if not self.wall.faces_move_alike:
            return SOLID_STRESSES
        return STRESSES if self.solution.along is not None else STRESSES[:2]

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
        if per_volt and not self._by_point:
            total += per_volt * self._voltage
        return total

    def volts(self, theta: FloatArray, window: slice | FloatArray) -> FloatArray:
        """Return the voltage of a saturating actuator, or of one cut into segments, at angles (degrees), (T, A)."""
        if self._cut is not None:
            return self._cut.at(theta, window)
        parities, orders, _ = self._voltage.shape
        return applied(at_angles(self._voltage[..., window], angle_basis(theta, orders, parities)), self._limit)

    @cached_property
    def _cut(self) -> CutElectrode | None:
        return cut_voltage(self.solution, self.shell)

    @property
    def _by_point(self) -> bool:
        """Whether the voltage is no sum of orders."""
        return self._cut is not None or self._limit.saturates

    @cached_property
    def _most_volts(self) -> float:
        return self._limit.volts if self._cut is None else float(np.abs(self._cut.voltage).max(initial=0.0))

    def depths(self) -> list[FloatArray]:
        """Return the depths (m) of each layer, from the inside out, among which its largest stress is."""
        length = self.solution.problem.scales.length
        return [length * np.array(depths) for depths in self.wall.sampled_depths]

    def at(self, depths: Sequence[float | None], component: str) -> Iterator[DepthStress]:
        """Yield a stress at each of some depths (m), or of the core at the mid-surface."""
        bounded = self.bounded(depths, component)
        if bounded is not None:
            yield from bounded
            return
        names = self._names(component)
        for depth in depths:
            modal = {name: self.amplitudes(depth, name) for name in names}
            per_volt = {name: self._per_volt(depth, name) for name in names}
            cut = CutVoltage(per_volt, self._most_volts, self.volts) if any(per_volt.values()) and self._by_point else None
            yield DepthStress(modal, cut)

    def _names(self, component: str) -> tuple[str, ...]:
        """Return the components that a stress is made of."""
        return self._made_of if component == "von_mises" else (component,)

    def bounded(self, depths: Sequence[float | None], component: str) -> list[DepthStressWhereLarge] | None:
        """Return a stress at all depths in two dimensions, made where it may be largest; None where it is no sum of orders of V and W.

        Voltages that are nowhere cut are such sums too.
        """
        solution, shell, names = self.solution, self.shell, self._names(component)
        gains = [{name: stress_gain_of(solution, shell, depth, name) for name in names} for depth in depths]
        plain = [{name: gain for name, gain in one.items() if isinstance(gain, Gain)} for one in gains]
        volts = [{name: self._per_volt(depth, name) for name in names} for depth in depths]
        drives = any(any(one.values()) for one in volts)
        if any(len(one) < len(names) for one in plain) or (drives and self._by_point):
            return None

        def stresses(of_depth: dict[str, Gain], per_volt: dict[str, float], instants: slice) -> dict[str, FloatArray]:
            normal, tangential = solution.normal[shell][..., instants], solution.tangential[shell][..., instants]
            found = {name: gain.w[:, None] * normal + gain.v[:, None] * tangential for name, gain in of_depth.items()}
            for name, volt in per_volt.items():
                if volt:
                    found[name] += volt * self._voltage[..., instants]
            return found

        reached = bounds(solution, shell, plain, Driven(self._voltage, volts) if drives else None)
        return [
            DepthStressWhereLarge(partial(stresses, of_depth, per_volt), reach, change)
            for of_depth, per_volt, reach, change in zip(plain, volts, *reached, strict=True)
        ]


def stress_through(motion: WallMotion, shell: int) -> WallStress | SolidWallStress:
    """Return the stresses through the wall of a shell; InputError if it is rigid, or of a theory or run whose depths are not known."""
    solution = motion.solution
    if elastic_wall(solution.problem, shell).faces_move_alike:
        found = WallStress(solution, shell)
        if not found.wall.sampled_depths:
            remedy = 'read response.stress at depths of your own, or use theory = "thin"'
            raise InputError(f"shells[{shell}].theory", "the depths of a wall of this theory are not known", remedy)
        return found
    solution.need_every_instant("the largest stress through an elastic wall")
    return StationWallStress(motion, shell) if isinstance(motion, StationMotion) else SolidWallStress(solution, shell)


def searchable(solution: ModalSolution, shell: int) -> bool:
    """Return whether the largest stress through the wall of a shell can be told at once: not by solving the waves along the axis again."""
    wall = solution.problem.shells[shell]
    return bool(wall.sampled_depths) if wall.faces_move_alike else solution.along is None and solution.whole


def layer_peaks(motions: Sequence[tuple[float | None, WallMotion]], shell: int, component: str, window: slice) -> list[WallPeak]:
    """Return the largest magnitude of a stress in each layer of a shell over a window of time, all angles, its depths, and stations.

    Parameters
    ----------
    motions : sequence of (float or None, WallMotion)
        Axial positions (m) of stations, None in two dimensions, and the motion there.
    shell : int
    component : str
        One of the wall's.
    window : slice
        Time indices.

    Raises
    ------
    InputError
        If the shell is rigid or its depths are not known, or a material lacks constants along the axis.
    """
    stresses = [stress_through(motion, shell) for _, motion in motions]
    found, through = [], stresses[0].depths()
    each = [stress.at([float(z) for z in np.concatenate(through)], component) for stress in stresses]  # as many together as it likes
    for number, depths in enumerate(through):
        asked = zip(stresses, each, strict=True)
        peaks = [one for one in (_of_layer(s, depths, islice(at, depths.size), component, window) for s, at in asked) if one is not None]
        best = max(range(len(peaks)), key=lambda i: peaks[i][0].value)
        found.append(_layer_peak(stresses[0], number, *peaks[best], component, motions[best][0]))
    return found


def wall_peak(motion: WallMotion, shell: int, component: str, window: slice) -> WallPeak:
    """Return the largest magnitude of a stress in a wall, as :func:`of_wall` of all :func:`layer_peaks`; in two dimensions.

    Layers that can neither hold it nor come nearest to their strength are not searched to the end: at the angle of
    :func:`~coaxshell.numerics.circle.circle_angles` nearest to its largest value a sum of orders, and so a norm of several, has a known
    share of it.
    """
    stress = stress_through(motion, shell)
    through = stress.depths()
    each = stress.bounded([float(z) for z in np.concatenate(through)], component) if isinstance(stress, WallStress) else None
    if each is None:
        return of_wall(layer_peaks([(None, motion)], shell, component, window))
    ends = np.cumsum([depths.size for depths in through])
    of_layers = [each[end - depths.size : end] for depths, end in zip(through, ends, strict=True)]
    share = least_beside(*reversed(motion.solution.normal.shape[1:3])) * (1.0 - _ROUNDING)
    found: dict[int, WallPeak] = {}
    for number in sorted(range(len(through)), key=lambda i: -max(at.most(window) for at in of_layers[i])):
        enough = max((peak.value for peak in found.values()), default=0.0)
        strength, margins = _strength(stress, number), [peak.margin for peak in found.values() if peak.margin is not None]
        if strength is not None:
            enough = min(enough, strength / min(margins)) if margins else 0.0
        depths = through[number]
        peak = _of_layer(stress, depths, of_layers[number], component, window, share * enough if enough else -1.0)
        if peak is not None:
            found[number] = _layer_peak(stress, number, *peak, component, None)
    return of_wall([found[number] for number in sorted(found)])


def _strength(stress: WallStress | SolidWallStress, layer: int) -> float | None:
    """Return the strength of the material of a layer, Pa, where it is known."""
    found: float | None = getattr(_material(stress, layer), "strength", None)
    return found


def _material(stress: WallStress | SolidWallStress, layer: int) -> Material | None:
    described = stress.solution.problem.system.shells[stress.shell]
    layers = described.layers if isinstance(described, Shell) else ()
    return layers[layer].material if layer < len(layers) else None


def _layer_peak(
    stress: WallStress | SolidWallStress, layer: int, peak: Peak, depth: float, component: str, station: float | None
) -> WallPeak:
    """Return the largest stress of a layer with its place, material and margin."""
    strength = _strength(stress, layer)
    margin = None if strength is None or peak.value == 0.0 else strength / peak.value
    return WallPeak(
        value=peak.value,
        time=peak.time,
        angle=peak.angle,
        growing=peak.growing,
        depth=depth,
        layer=layer,
        material=getattr(_material(stress, layer), "name", ""),
        component=component,
        margin=margin,
        weakest=None if margin is None else layer,
        station=station,
    )


def _of_layer(
    stress: WallStress | SolidWallStress,
    depths: FloatArray,
    each: Iterable[DepthStress],
    component: str,
    window: slice,
    above: float = -1.0,
) -> tuple[Peak, float] | None:
    """Return the largest magnitude in a layer, from the stress at each of its depths (m), and the depth where it is.

    None where it is *above* some value at no angle of the circle.
    """
    best, kept, fields = (above, window.start, 0, 0), None, []
    for number, at in enumerate(each):
        value, instant, place = _largest(at, window, best[0])
        if value > best[0]:
            best, kept = (value, instant, place, number), at
        if isinstance(stress, SolidWallStress):
            fields.append(at)
    if kept is None:
        return None
    _, instant, place, number = best
    near, depth = _beside(instant, window), float(depths[number])
    if isinstance(stress, SolidWallStress):
        fine, between = stress.between(depths, fields, number, near)
        depth = float(fine[_refined(between, slice(None), stress.solution, window, near, place)[1]])
        if depth not in depths:
            (kept,) = stress.at([depth], component)
    return _refined(kept, near, stress.solution, window, near, place)[0], depth


def _largest(at: DepthStress, window: slice, above: float) -> tuple[float, int, int]:
    """Return the largest magnitude at one depth with its instant and place on the circle; -1 if none exceeds *above*."""
    if isinstance(at, DepthStressWhereLarge):
        return at.largest(window, above)
    bound = at.reach(window)
    width = max(1, BLOCK // (8 * at.orders))
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


def _beside(instant: int, window: slice) -> slice:
    """Return an instant and the two beside it."""
    return slice(max(window.start, instant - 1), min(window.stop, instant + 2))


def _refined(at: DepthStress, which: slice, solution: ModalSolution, window: slice, near: slice, place: int) -> tuple[Peak, int]:
    """Return the largest in steps of the circle FINE times finer around a place, and at which of several depths.

    Parameters
    ----------
    at : DepthStress
    which : slice
        Of its instants: those of *near*, at one depth after the other.
    solution : ModalSolution
    window, near : slice
        Time indices: all that count, and those looked at.
    place : int
        On the circle.
    """
    parities, orders = solution.normal.shape[1:3]
    grid = circle_angles(orders, parities)
    angles = grid[place] + (grid[1] - grid[0]) / FINE * np.arange(-FINE, FINE + 1)
    values = at.at_angles(angles, which).reshape(-1, near.stop - near.start, angles.size)
    depth, k, i = (int(n) for n in np.unravel_index(int(values.argmax()), values.shape))
    angle = folded(float(angles[i]))
    growing = bool(near.start + k == window.stop - 1 and k > 0 and values[depth, k, i] > values[depth, k - 1, i])
    value, time = float(values[depth, k, i]), float(solution.time[near.start + k])
    return Peak(value, time, abs(angle) if parities == 1 else angle, growing), depth


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
    return wall_peak(WallMotion(solution), shell, usual_component(solution, shell), window)


def largest_of_the_core(solution: ModalSolution, shell: int, window: slice, length: float, *, halved: bool = True) -> Peak:
    """Return the largest von Mises stress of the core at the mid-surface within a window; a mean over a segment is not taken."""
    (at,) = WallStress(solution, shell).at([None], "von_mises")
    _, instant, place = _largest(at, window, -1.0)
    near = _beside(instant, window)
    return _refined(at, near, solution, window, near, place)[0]


def of_the_core(motion: WallMotion, shell: int, theta: FloatArray) -> FloatArray:
    """Return the von Mises stress of the core at the mid-surface at angles (degrees), Pa, (T, A)."""
    (at,) = WallStress(motion.solution, shell).at([None], "von_mises")
    return at.at_angles(np.atleast_1d(theta), slice(0, motion.solution.time.size))


def through_wall(motion: WallMotion, shell: int, theta: FloatArray) -> FloatArray:
    """Return the largest stress through the wall at angles (degrees), Pa, (T, A)."""
    stress, component = stress_through(motion, shell), usual_component(motion.solution, shell)
    every, depths = slice(0, motion.solution.time.size), np.concatenate(stress.depths())
    return np.asarray(
        reduce(np.maximum, (at.at_angles(np.atleast_1d(theta), every) for at in stress.at([float(z) for z in depths], component)))
    )
