"""What thin theory leaves out of a wall that fluids press from both sides, its pressure through the wall, and what is left without it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from test_exact_control import system

from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.arrays import ComplexArray, FloatArray
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.solid_spectra import FacedSystem, WallAnswer
from coaxshell.structure import electrodes
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.electroded_wall import ElectrodedWall
from coaxshell.structure.solid import HOOP, RADIAL

MODES = Modes.up_to(4)
NODES: ComplexArray = np.asarray(0.9 + 1j * np.linspace(0.0, 12.0, 31), dtype=np.complex128)
OUTER = 1


class Rest(NamedTuple):
    """Distances of a thin wall from an exact one, over it and over all nodes, of each order."""

    motion: FloatArray
    reading: FloatArray
    stress: FloatArray
    pressed_reading: FloatArray
    pressed_stress: FloatArray


def pressed(exact: ElasticWall, thin: ElectrodedWall, answer: WallAnswer) -> tuple[ComplexArray, ComplexArray]:
    """Return sigma_r of a thin wall, mean of its faces', and what it adds to V: -(m/R) G sigma_r/(M s^2 + K_vv - H P_v S_v)."""
    assert exact.transducers is not None
    assert thin.gains is not None
    force = sum(layer.thickness * layer.stiffness[RADIAL][HOOP] / layer.stiffness[RADIAL][RADIAL] for layer in exact.layers)
    charged = electrodes.opened(thin.section)
    solid = [exact.layers[one] for one, is_open in zip(exact.transducers.driven, exact.transducers.opened, strict=True) if is_open]
    for own, layer in zip(charged, solid, strict=True):  # an open circuit charges itself by e33 sigma_r/c33
        assert layer.coupling is not None
        along = own.thickness * own.reduced_coupling / own.permittivity
        force += along * layer.coupling[RADIAL][RADIAL] / layer.stiffness[RADIAL][RADIAL]
    m, across = MODES.column, 0.5 * (answer.faces.load_inner - answer.faces.load_outer)
    push, read = thin.drive(MODES).columns, thin.sensor_gain(MODES).columns
    stiffness = thin.mass * NODES**2 + np.where(m == 0, 1.0, thin.dynamic_stiffness(MODES, NODES).vv)
    return across, -(m / thin.radius) * force * across / (stiffness - thin.gains.at(NODES, MODES) * push.v * read.v)


def rest(kind: str, scale: float) -> Rest:
    """Return how far the outer shell of thin walls is from that of exact ones, layers *scale* times as thick."""
    problems = [dimensionless(system(kind, theory, scale)) for theory in ("elastic", "thin")]
    solid, flat = (FacedSystem(problem, NODES, MODES) for problem in problems)
    load = np.ones((MODES.count, 1)) / (1.0 + NODES**2)
    exact, thin = (each.under_sources(load)[OUTER] for each in (solid, flat))
    wall, own = (problem.shells[OUTER] for problem in problems)
    assert isinstance(wall, ElasticWall)
    assert isinstance(own, ElectrodedWall)
    across, moved = pressed(wall, own, thin)
    core, shown = wall.layers[wall.core], own.stress_gain(MODES).columns
    stress = shown.v * thin.tangential + shown.w * thin.normal
    through = shown.v * moved + core.stiffness[RADIAL][HOOP] / core.stiffness[RADIAL][RADIAL] * across
    heard, told = solid.sensed(OUTER, exact), flat.sensed(OUTER, thin)
    return Rest(
        apart(thin.normal, exact.normal),
        apart(told, heard),
        apart(stress, exact.hoop),
        apart(told + own.sensor_gain(MODES).columns.v * moved, heard),
        apart(stress + through, exact.hoop),
    )


def apart(one: ComplexArray, other: ComplexArray | float) -> FloatArray:
    """Return the difference of the first from the second over all nodes, over the second, of each order."""
    return np.asarray(np.linalg.norm(one - other, axis=-1) / np.linalg.norm(np.asarray(other), axis=-1))


@pytest.mark.parametrize("kind", ["electrodes", "charged", "open"])
def test_pressure_through_the_wall_is_what_thin_walls_lack_of_voltages_and_stress(kind: str) -> None:
    """Motion alone tends to that of exact walls; voltages and the core's stress do so too once sigma_r is along the wall, at least as h."""
    thicker, thinner = rest(kind, 0.25), rest(kind, 0.125)
    assert (thicker.motion / thinner.motion > 1.8).all()
    for lacking in ("reading", "stress"):
        before, after = getattr(thicker, lacking)[1:], getattr(thinner, lacking)[1:]
        assert (before / after < 1.3).all()
        assert (after > 0.03).all()
    for whole in ("pressed_reading", "pressed_stress"):
        before, after = getattr(thicker, whole), getattr(thinner, whole)
        assert (before / after > 1.7).all(), (whole, before / after)
        assert (after < 4e-3).all(), (whole, after)
