"""Charge, current and power of layers that amplifiers drive (theory manual, "Electrodes").

The charge of a driven layer per area is q = e32~ B(z_a) (V, W) + (mu33~/t) u, in elastic walls what its electrodes hold, over the
mid-surface; all actuators of a wall hang on one amplifier, so that their charges add up. The current per area is dq/dt. Around the wall

    P = oint u i ds,      S = (oint u^2 ds  oint i^2 ds)^(1/2) >= |P|

are the real and the apparent power per metre of length: what the amplifier gives, and what it must be built for. Where electrodes are
cut, segment k of width alpha R has one voltage u_k and holds q_k, the mean of q under it, so that its amplifier gives alpha R u_k dq_k/dt.

Where a limit holds at the end of a run q has a corner there, which transforms and differences of high order swing about: its last rate
is that of a parabola through its last three values. No segment whose current stops at a limit is told to take more: single
steps in which it begins to be held overshoot.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from coaxshell.model.gains import law_of, saturates
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.numerics.differences import time_derivative, work_along
from coaxshell.response.energy.electrodes import on_segments
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.solid_transducers import capacitances, strokes, volts_of
from coaxshell.response.voltages import cut_voltage, given_voltage
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.recompute import marches, spectra_of
from coaxshell.solver.solution import ModalSolution
from coaxshell.solver.station_currents import strain_charge
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.electroded_wall import ElectrodedWall
from coaxshell.structure.segmented_wall import SegmentedWall
from coaxshell.structure.segments import Segments
from coaxshell.structure.solid_charges import free_capacity


class Electrical(NamedTuple):
    """Modal histories of one wall, each (parities, M + 1, T): volts, charge (C/m^2) and current (A/m^2) of all its actuators together."""

    voltage: FloatArray
    charge: FloatArray
    current: FloatArray


class OfSegments(NamedTuple):
    """Histories of the segments of one wall, each (N, T): volts, charge (C/m^2) and current (A/m^2) of all its actuators together.

    Attributes
    ----------
    segments : Segments
    width : float
        Of a segment along the mid-surface, m.
    """

    segments: Segments
    width: float
    voltage: FloatArray
    charge: FloatArray
    current: FloatArray

    @property
    def power(self) -> FloatArray:
        """Real power of each segment, W per metre of length, (N, T)."""
        return np.asarray(self.width * self.voltage * self.current)

    @property
    def energy(self) -> FloatArray:
        """What the amplifier of each segment has given when the run ends, J per metre of length, (N,)."""
        return self.width * work_along(self.voltage, self.charge)


class Power(NamedTuple):
    """Real and apparent power of one wall, each (T,): W and VA per metre of length; ``energy`` given when the run ends, J per metre."""

    real: FloatArray
    apparent: FloatArray
    energy: float


def electrical(motion: WallMotion, shell: int) -> Electrical:
    """Return what the actuators of a wall between electrodes hold and take, by modes, made once; InputError if instants are missing."""
    return motion.kept(("electrical", shell), lambda: _electrical(motion, shell))


def of_segments(motion: WallMotion, shell: int) -> OfSegments | None:
    """Return what the segments of a wall hold and take, made once; None where electrodes are whole, and at stations of elastic walls."""
    wall = motion.solution.problem.shells[shell]
    if isinstance(wall, ElasticWall) and wall.gains is not None and wall.segments is not None:
        if motion.solution.along is not None:
            return None  # no station keeps charges of solids
        cut = wall.segments
        return motion.kept(("segments", shell), lambda: _segments_of_solids(motion, shell, wall, cut))
    if not isinstance(wall, SegmentedWall) or wall.gains is None:
        return None
    return motion.kept(("segments", shell), lambda: _of_segments(motion, shell, wall))


def _segments_of_solids(motion: WallMotion, shell: int, wall: ElasticWall, cut: Segments) -> OfSegments:
    """Return what the segments of an elastic wall hold and take.

    Orders end at M, and the voltage of a segment does not: what it puts in at once is that of the segment, the rest that of its orders.
    """
    whole, at_once = _whole(motion), free_capacity(wall)
    volts, charge = _of_solids(whole, shell, wall)
    voltage = cut.values(volts)
    charge = cut.means(charge - at_once * volts) + at_once * voltage
    voltage[list(cut.dead)] = 0.0
    metres = 2.0 * np.pi * wall.radius * cut.covered / cut.count * motion.solution.problem.scales.length
    return _stopped(motion.solution, shell, OfSegments(cut, metres, *_inverted(motion, whole, voltage, charge)))


def _of_segments(motion: WallMotion, shell: int, wall: SegmentedWall) -> OfSegments:
    if motion.solution.along is not None:
        return _segments_at_station(motion.solution, shell, wall)
    whole = _whole(motion)
    charges = wall.charges(whole.modes)
    assert whole.voltage is not None
    moved = [gain.columns.v * whole.tangential[shell] + gain.columns.w * whole.normal[shell] for gain, _ in charges]
    voltage, strained, width = on_segments(wall, whole.voltage[shell], moved)
    charge = sum((one + capacitance * voltage for one, (_, capacitance) in zip(strained, charges, strict=True)), np.zeros_like(voltage))
    voltage[0, list(wall.segments.dead)] = 0.0
    metres = float(width[0]) * motion.solution.problem.scales.length
    return _stopped(motion.solution, shell, OfSegments(wall.segments, metres, *_inverted(motion, whole, voltage[0], charge[0])))


def _electrical(motion: WallMotion, shell: int) -> Electrical:
    wall = motion.solution.problem.shells[shell]
    if motion.solution.along is not None and isinstance(wall, ElectrodedWall):
        return _at_station(motion.solution, shell, wall)
    whole = _whole(motion)
    return Electrical(*_inverted(motion, whole, *_spectra(whole, shell)))


def _at_station(solution: ModalSolution, shell: int, wall: ElectrodedWall) -> Electrical:
    """Return what actuators hold and take at a station along the axis, from the fields there; the current by differences."""
    solution.need_every_instant("a current")
    voltage = given_voltage(solution, shell)
    strained, capacitance = strain_charge(solution, shell, wall)
    return Electrical(voltage, *_charged(solution, strained + capacitance * voltage))


def _segments_at_station(solution: ModalSolution, shell: int, wall: SegmentedWall) -> OfSegments:
    """Return the same of each segment, per length along the axis there."""
    cut, voltage = wall.segments, cut_voltage(solution, shell)
    assert voltage is not None
    assert solution.along is not None
    cut = replace(cut, dead=tuple(sorted({*cut.dead, *solution.along.dead})))
    solution.need_every_instant("a current")
    strained, capacitance = strain_charge(solution, shell, wall)
    width = 2.0 * np.pi * wall.radius * cut.covered / cut.count * solution.problem.scales.length
    charge, current = _charged(solution, cut.means(strained) + capacitance * voltage.voltage)
    return _stopped(solution, shell, OfSegments(cut, width, voltage.voltage, charge, current))


def _charged(solution: ModalSolution, charge: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return a charge in C/m^2 and its current, A/m^2."""
    scales = solution.problem.scales
    charge = charge * (scales.pressure * scales.length)
    return charge, _ended(solution, charge, time_derivative(charge, solution.settings.time_step * scales.time))


def _ended(solution: ModalSolution, charge: FloatArray, current: FloatArray) -> FloatArray:
    """Return a current whose last value follows the charge's last three, where a limit may hold at the end."""
    if saturates(solution.problem.system):
        step = solution.settings.time_step * solution.problem.scales.time
        before, last = np.moveaxis(np.diff(charge[..., -3:]), -1, 0) / step
        current[..., -1] = 1.5 * last - 0.5 * before
    return current


def _stopped(solution: ModalSolution, shell: int, found: OfSegments) -> OfSegments:
    """Return what segments take where their current stops at a limit."""
    law = law_of(solution.problem.system, shell)
    if law is None or not law.current_saturation or law.current_limit is None:
        return found
    return found._replace(current=np.clip(found.current, -law.current_limit, law.current_limit))


def _whole(motion: WallMotion) -> Motion:
    solution = motion.solution
    return Motion.of(solution, 1, spectra_of(solution, continued=True) if marches(solution) else motion.spectra)


def _inverted(motion: WallMotion, whole: Motion, voltage: ComplexArray, charge: ComplexArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return histories of voltage (V), charge (C/m^2) and current (A/m^2) from transforms of voltage and of the dimensionless charge."""
    scales = motion.solution.problem.scales
    per_area, kept = scales.pressure * scales.length, slice(None, None, motion.solution.settings.refinement)
    current = charge * (whole.grid.nodes * (per_area / scales.time))
    volts, held, taken = (whole.grid.invert(x)[..., kept] for x in (voltage, charge * per_area, current))
    return volts, held, _ended(motion.solution, held, taken)


def power(motion: WallMotion, shell: int) -> Power:
    """Return the real and the apparent power of a wall's actuators over time."""
    problem = motion.solution.problem
    if (cut := of_segments(motion, shell)) is not None:
        rms = np.sqrt((cut.voltage**2).sum(axis=0) * (cut.current**2).sum(axis=0))
        return Power(cut.power.sum(axis=0), cut.width * rms, float(cut.energy.sum()))
    found = electrical(motion, shell)
    circle = np.pi * np.where(np.arange(found.voltage.shape[1]) == 0, 2.0, 1.0)
    around = circle * problem.shells[shell].radius * problem.scales.length

    def over(one: FloatArray, other: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("m,hmt,hmt->t", around, one, other), dtype=np.float64)

    u, i = found.voltage, found.current
    energy = float(np.einsum("m,hm->", around, work_along(u, found.charge)))
    return Power(over(u, i), np.sqrt(over(u, u) * over(i, i)), energy)


def charge(motion: WallMotion, shell: int) -> FloatArray:
    """Return the modal charge per area of all actuators of a wall, C/m^2, (parities, M + 1, T)."""
    return electrical(motion, shell).charge


def current(motion: WallMotion, shell: int) -> FloatArray:
    """Return the modal current per area into all actuators of a wall, A/m^2, (parities, M + 1, T)."""
    return electrical(motion, shell).current


def _spectra(motion: Motion, shell: int) -> tuple[ComplexArray, ComplexArray]:
    """Return the transforms of the voltage (V) and of the charge of all actuators, dimensionless."""
    wall, s = motion.problem.shells[shell], motion.grid.nodes
    if isinstance(wall, ElasticWall):
        return _of_solids(motion, shell, wall)
    assert wall.gains is not None
    w, v = motion.normal[shell], motion.tangential[shell]
    read = wall.sensor_gain(motion.modes).columns
    law = motion.voltage
    voltage = wall.gains.at(s, motion.modes) * (read.v * v + read.w * w) if law is None else law[shell]
    total = np.zeros_like(voltage)
    for moved, capacitance in wall.charges(motion.modes):
        total += moved.columns.v * v + moved.columns.w * w + capacitance * voltage
    return voltage, total


def _of_solids(motion: Motion, shell: int, wall: ElasticWall) -> tuple[ComplexArray, ComplexArray]:
    assert wall.transducers is not None
    volts = volts_of(motion, shell)
    assert volts is not None
    acting = np.flatnonzero(wall.transducers.acting)
    if not acting.size:
        return np.zeros_like(volts[0]), np.zeros_like(volts[0])
    moved, held = strokes(motion, shell, volts), capacitances(wall, motion)
    total = sum(moved[j] + held[j][:, None] * volts[j] for j in acting)
    return volts[acting[0]], np.asarray(total / wall.radius)
