"""Charge, current and power of layers that amplifiers drive (theory manual, "Electrodes").

The charge of a driven layer per area is q = e32~ B(z_a) (V, W) + (mu33~/t) u, in elastic walls what its electrodes hold, over the
mid-surface; all actuators of a wall hang on one amplifier, so that their charges add up. The current per area is dq/dt. Around the wall

    P = oint u i ds,      S = (oint u^2 ds  oint i^2 ds)^(1/2) >= |P|

are the real and the apparent power per metre of length: what the amplifier gives, and what it must be built for.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.response.energy.motion import Motion
from coaxshell.response.energy.solid_transducers import capacitances, strokes, volts_of
from coaxshell.response.wall_motion import WallMotion
from coaxshell.solver.recompute import marches, spectra_of
from coaxshell.structure.elastic_wall import ElasticWall


class Electrical(NamedTuple):
    """Modal histories of one wall, each (parities, M + 1, T): volts, charge (C/m^2) and current (A/m^2) of all its actuators together."""

    voltage: FloatArray
    charge: FloatArray
    current: FloatArray


class Power(NamedTuple):
    """Real and apparent power of one wall, each (T,): W and VA per metre of length."""

    real: FloatArray
    apparent: FloatArray


def electrical(motion: WallMotion, shell: int) -> Electrical:
    """Return what the actuators of a wall between electrodes hold and take, by modes, made once; InputError if instants are missing."""
    return motion.kept(("electrical", shell), lambda: _electrical(motion, shell))


def _electrical(motion: WallMotion, shell: int) -> Electrical:
    solution, scales = motion.solution, motion.solution.problem.scales
    whole = Motion.of(solution, 1, spectra_of(solution, continued=True) if marches(solution) else motion.spectra)
    voltage, charge = _spectra(whole, shell)
    per_area = scales.pressure * scales.length
    kept = slice(None, None, solution.settings.refinement)
    current = charge * (whole.grid.nodes * (per_area / scales.time))
    found = (whole.grid.invert(x)[..., kept] for x in (voltage, charge * per_area, current))
    return Electrical(*found)


def power(motion: WallMotion, shell: int) -> Power:
    """Return the real and the apparent power of a wall's actuators over time."""
    found, problem = electrical(motion, shell), motion.solution.problem
    circle = np.pi * np.where(np.arange(found.voltage.shape[1]) == 0, 2.0, 1.0)
    around = circle * problem.shells[shell].radius * problem.scales.length

    def over(one: FloatArray, other: FloatArray) -> FloatArray:
        return np.asarray(np.einsum("m,hmt,hmt->t", around, one, other), dtype=np.float64)

    u, i = found.voltage, found.current
    return Power(over(u, i), np.sqrt(over(u, u) * over(i, i)))


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
    moved, held = strokes(motion, shell, volts), capacitances(wall, motion)
    total = sum(moved[j] + held[j][:, None] * volts[j] for j in acting)
    return volts[acting[0]], np.asarray(total / wall.radius)
