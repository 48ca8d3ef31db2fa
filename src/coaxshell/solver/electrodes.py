"""The mean of a voltage over a segment of an electrode: the measure that converges with the number of orders.

A sensor's voltage follows the change of curvature, m^2 W. Behind a sharp front W falls only as m^-2 where it passes, so the voltage
*at a point* grows with the orders that are kept. An electrode covers a segment of the wall, of length L along the mid-surface, and
takes the mean of what happens under it. Order m then counts with

    s_m = sin(m L/(2 R))/(m L/(2 R)),

and the sum converges as soon as M exceeds a few 2 pi R/L.

Electrodes that are cut have segments of their own, whose voltages are known. Else, where nothing is said,
L is the acoustic wavelength c_e/f at the upper end f of the pulse's band (nine tenths of its energy lie below; for
an exponential decay L = 0.995 c_e tau): an amplifier that passes the pulse has no use for more. It is never less than 2 pi times the
wall's thickness, below which thin-shell theory says nothing, nor more than a sixteenth of the circumference, over which the mean would
take a tenth off the fourth order.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from coaxshell.acoustics.operators import all_orders
from coaxshell.acoustics.pulse_band import pulse_band
from coaxshell.errors import InputError
from coaxshell.model.units import to_si
from coaxshell.numerics.arrays import FloatArray
from coaxshell.numerics.circle import around, peak_on_circle
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import Problem
from coaxshell.solver.solution import ModalSolution
from coaxshell.structure.control_law import ControlGains

Segment = float | str | None
"""Length of a segment, m or as text such as "50 mm"; "point" for the value at a point; None for what the pulse's band allows."""

LARGEST_SHARE = 1.0 / 16.0
_NEAR = 0.7  # of the largest value, which the circle's own angles reach at least: four or more of them to the shortest wave


def segment_length(problem: Problem, shell: int, segment: Segment = None) -> float:
    """Return the length of a segment on one shell, m; 0 is a point.

    Raises
    ------
    InputError
        If it is neither a length, "point" nor None, or longer than the circumference.
    """
    wall = problem.system.shells[shell]
    around = 2.0 * math.pi * wall.radius
    cut = problem.shells[shell].electrode_segments
    if segment is None and cut is not None:
        return around * cut.covered / cut.count
    if segment is None:
        highest = max(pulse_band(source.pulse) for source in problem.system.sources)
        wave = problem.scales.velocity / highest if highest > 0.0 else math.inf
        return min(max(wave, 2.0 * math.pi * wall.thickness), LARGEST_SHARE * around)
    if isinstance(segment, str) and segment.strip().lower() == "point":
        return 0.0
    try:
        length = to_si(segment, "length")
    except InputError as error:
        raise InputError("segment", error.problem, 'give a length in m, a text such as "50 mm", or "point"') from None
    if not 0.0 < length <= around:
        raise InputError("segment", f"{length:g} m is not allowed", f'give more than 0 and at most {around:g} m, or "point"')
    return length


def segment_mean(orders: FloatArray, angle: float) -> FloatArray:
    """Return by what each order counts in the mean over a segment of some angle (radians): sin(m angle/2)/(m angle/2)."""
    return np.asarray(np.sinc(orders * angle / (2.0 * math.pi)), dtype=np.float64)


@dataclass(frozen=True)
class LargestVoltage:
    """The largest voltage that a control law asks for: its value, what the lower half of the orders gives alone, and the segment (m)."""

    value: float
    lower_half: float
    segment: float


def largest_demand(solution: ModalSolution, index: int, above: float) -> LargestVoltage | None:
    """Return the largest voltage asked for on one shell, anywhere and at any time, as a mean over the default segment (Eq. 17).

    None if it does not exceed *above* (V), or the run does not know it: it needs the engine's velocities, or the potentials of a station.
    """
    problem = solution.problem
    length = segment_length(problem, index)
    if solution.segment_voltage is not None:
        largest = float(np.abs(solution.segment_voltage[index]).max(initial=0.0))
        return LargestVoltage(largest, largest, length) if largest > above else None
    orders = all_orders(solution.normal.shape[2] - 1)
    voltage = _demand(solution, index, orders, segment_mean(orders, length / problem.system.shells[index].radius))
    if voltage is None:
        return None
    highest = _largest(voltage, _NEAR * above)
    return LargestVoltage(highest, _largest(voltage[:, : lower_half(len(orders))]), length) if highest > above else None


def _demand(solution: ModalSolution, index: int, orders: FloatArray, share: FloatArray) -> FloatArray | None:
    """Return the voltage asked for, (parities, M + 1, T), by how much each order counts."""
    wall = solution.problem.shells[index]
    gains, along = wall.gains, solution.along
    if solution.control_voltage is not None:
        return np.asarray(share[:, None] * solution.control_voltage[index])
    assert isinstance(gains, ControlGains)
    if along is not None:
        layer = wall.layer_number("sensor")
        if layer is None or not along.potential_rates:
            return None
        potential, rate = along.potentials[layer][index], along.potential_rates[layer][index]
        return np.asarray(share[:, None] * (gains.proportional * potential + gains.derivative * rate))
    if solution.normal_rate is None or solution.tangential_rate is None:
        return None
    sensor = wall.sensor_gain(Modes(orders))
    sensor_v, sensor_w = share * sensor.v, share * sensor.w
    voltage = sensor_w[:, None] * (gains.proportional * solution.normal[index] + gains.derivative * solution.normal_rate[index])
    voltage += sensor_v[:, None] * (gains.proportional * solution.tangential[index] + gains.derivative * solution.tangential_rate[index])
    return np.asarray(voltage, dtype=np.float64)


def _largest(modal: FloatArray, above: float = -1.0) -> float:
    """Return the largest magnitude on the circle as the summary finds it; 0 if none comes near *above*."""
    found = peak_on_circle(modal, above=above)
    if found is None:
        return 0.0
    near = slice(max(0, found.instant - 1), found.instant + 2)
    return float(np.abs(around(modal[..., near], found.place)[1]).max())


def lower_half(orders: int) -> int:
    """Return how many of M + 1 orders are the lower half, those up to M/2."""
    return (orders - 1) // 2 + 1
