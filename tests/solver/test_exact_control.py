"""Feedback on walls of elastic solids: transducers against thin walls and a dense solution, limits, balances, stability, refusals."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.numerics.winding import turning
from coaxshell.response import load_response
from coaxshell.solver.scaling import Problem, dimensionless
from coaxshell.solver.stability import opened, unstable_poles
from coaxshell.structure.elastic_basis import strain_rows
from coaxshell.structure.elastic_depth import shown_by_shapes
from coaxshell.structure.elastic_wall import ElasticWall
from coaxshell.structure.thin_wall import ThinWall

PRESETS = {"paper": "active", "electrodes": "electrodes", "charged": "electrodes", "open": "electrodes"}
GAINS = {
    "paper": cx.PDControl(proportional=-2e4, derivative=-150),
    "electrodes": cx.PDControl(proportional=0, derivative=2, transducers="electrodes"),
    "charged": cx.PDControl(proportional=0, derivative=2, transducers="electrodes"),
    "open": cx.PDControl(proportional=0, derivative=2, transducers="electrodes"),
}


def system(kind: str, theory: str = "elastic", scale: float = 1.0, **changes: Any) -> cx.System:
    """Return a preset with walls of a theory, all layers *scale* times as thick, ceramics without printed slips.

    "charged": a sensor read by its charge beside a self-sensing layer; "open": with its circuit open.
    """
    base, shells = cx.presets.load(PRESETS[kind]), []
    for shell in base.shells:
        layers = []
        for place, layer in enumerate(shell.layers):
            material = layer.material
            if isinstance(material, cx.Piezoelectric):
                material = material.replace(permittivity_reduction="standard")
            sensor = {"charged": "charge-sensor", "open": "sensor"}.get(kind)
            role = {"role": (sensor, None, "self-sensing")[place]} if sensor and place != 1 else {}
            layers.append(layer.replace(thickness=scale * layer.thickness, material=material, **role))
        wetted = {"wetted": "faces"} if theory == "thin" else {}
        shells.append(shell.replace(layers=layers, theory=theory, **wetted))
    return base.replace(**{"shells": shells, "control": GAINS[kind], **changes})


@cache
def run(kind: str, theory: str = "elastic", scale: float = 1.0, controlled: bool = True) -> cx.Response:
    described = system(kind, theory, scale) if controlled else system(kind, theory, scale, control=None)
    return cx.simulate(described, duration=0.8, time_step=1e-2, modes=6)


def walls(kind: str, scale: float = 1.0) -> tuple[ElasticWall, ThinWall, Problem]:
    solid, thin = (dimensionless(system(kind, theory, scale)) for theory in ("elastic", "thin"))
    first, second = solid.shells[0], thin.shells[0]
    assert isinstance(first, ElasticWall)
    assert isinstance(second, ThinWall)
    return first, second, solid


@pytest.mark.parametrize(("kind", "close"), [("paper", 0.05), ("electrodes", 2e-3), ("charged", 2e-3)])
def test_loads_and_readings_of_bending_and_stretching_are_those_of_thin_walls(kind: str, close: float) -> None:
    """Of the paper's sensor bending alone: thin theory takes a half cosine for its potential and leaves out what stretching does to it."""
    solid, thin, _ = walls(kind, 0.25)
    modes = Modes.up_to(5)
    part, driven, transducers = solid.basis(modes)[0], solid.driven(modes)[0], solid.transducers
    assert transducers is not None
    w, v = (shown_by_shapes(part, solid.layer_at(0.0), solid.radius, name) for name in ("normal", "tangential"))
    for m in (2, 3, 5):
        n = 0 if kind == "paper" else 1
        read, push = thin.sensor_gain(modes), thin.drive(modes)
        expected = read.v[m] * v[m, n] + read.w[m] * w[m, n]
        assert transducers.sensing @ driven.readings[m, :, n] == pytest.approx(expected, rel=close)
        load = thin.radius * (push.v[m] * v[m, n] + push.w[m] * w[m, n])
        assert transducers.acting @ driven.loads[m, :, n] == pytest.approx(load, rel=2e-3)


@pytest.mark.parametrize("kind", ["paper", "electrodes", "charged"])
def test_the_closed_wall_against_the_equations_of_its_points(kind: str) -> None:
    """Stiffness, mass, d and p of all points, solved at one order and frequency: what volts do along the wall, and at rest through it.

    The law hears what moves along the wall, of loads too. Where one layer senses and acts what is left out, the inertia that volts find in
    the thickness and what is read of that, is small: (K + M s^2 - H d p') x = loads. Another sensor would feel pressure through it.
    """
    wall, _, _ = walls(kind)
    modes, s = Modes.up_to(3), np.array([0.7 + 2.3j])
    part, driven, transducers = wall.basis(modes)[0], wall.driven(modes)[0], wall.transducers
    assert transducers is not None
    assert wall.gains is not None
    found, law, mass = wall.receptance(modes, s), wall.gains.at(s, modes)[0], np.tile(part.mesh.mass, 2)
    places, given = [0, part.mesh.radius.size - 1], wall.under_voltage(modes, s, wall.asked_of_port)
    for m in range(4):
        rows = strain_rows(part.mesh, part.orders[m : m + 1], 0.0)[0]
        stiffness = rows.reshape(len(rows), -1).T @ rows.reshape(len(rows), -1)
        shapes = part.shapes[m].reshape(part.shapes.shape[1], -1)
        d, p = (each[m] @ (shapes * mass) for each in (driven.loads, driven.readings))  # back to the points, by completeness
        push, read = transducers.acting @ d, transducers.sensing @ p
        dynamic, loads = stiffness + np.diag(mass * s[0] ** 2), np.zeros((mass.size, 2))
        loads[places, [0, 1]] = -1.0  # each r_a q_a = 1
        free = np.linalg.solve(dynamic, loads)
        squares, vectors = eigh(stiffness, np.diag(mass))
        slow, along, through = part.squares[m, :2], shapes[:2].T, vectors[:, 2:]  # the low ones of K are lost to rounding
        pushed = along @ ((along.T @ push) / (slow + s[0] ** 2))
        heard = (read @ along) @ ((along.T @ loads) / (slow + s[0] ** 2)[:, None])
        volts = law * heard / (1.0 - law * (read @ pushed))
        pushed = pushed + through @ ((through.T @ push) / squares[2:])
        moved = -(free + np.outer(pushed, volts))[places]
        np.testing.assert_allclose(given.faces[:, m, 0], -pushed[places], rtol=0, atol=1e-6 * np.abs(pushed).max())
        here = [[found.inner[m, 0], found.across[m, 0]], [found.back[m, 0], found.outer[m, 0]]]
        np.testing.assert_allclose(here, moved, rtol=0, atol=1e-6 * np.abs(moved).max())
        if kind == "electrodes":
            whole = -np.linalg.solve(dynamic - law * np.outer(push, read), loads)[places]
            np.testing.assert_allclose(here, whole, rtol=0, atol=2e-3 * np.abs(whole).max())
        assert np.abs(here + free[places]).max() > 1e-3 * np.abs(moved).max()


def test_exact_walls_under_electrodes_tend_to_thin_ones() -> None:
    errors = []
    for scale in (1.0, 0.25):
        exact, thin = (np.asarray(run("electrodes", theory, scale).displacement("inner", [0, 50, 180])) for theory in ("elastic", "thin"))
        errors.append(np.linalg.norm(exact - thin) / np.linalg.norm(exact))
    bare = np.asarray(run("electrodes", "elastic", 1.0, False).displacement("inner", [0, 50, 180]))
    controlled = np.asarray(run("electrodes").displacement("inner", [0, 50, 180]))
    assert errors[1] < 2e-3
    assert errors[0] / errors[1] > 2.0
    assert np.linalg.norm(bare - controlled) > 10.0 * errors[0] * np.linalg.norm(bare)


@pytest.mark.parametrize("kind", ["paper", "charged", "open"])
def test_no_loop_grows_through_the_thickness(kind: str) -> None:
    """Zeros of D/D0 with all inertia, counted to beyond the resonances of the thickness, which checks of stability do not look at.

    A law that heard pressure through its sensor would drive them: e^(1000 t) of the paper's, several poles of each.
    """
    problem, modes = dimensionless(system(kind)).resolving(400.0), Modes(np.array([2.0]))
    s = 25.0 + 1j * np.arange(0.0, 6e4, 20.0)
    ratio = opened(problem, problem.open_loop, s, modes, None).closed(problem, s, modes)
    assert abs(turning(ratio)[0]) < 0.05 * np.pi
    np.testing.assert_allclose(np.abs(ratio[0, -100:]), 1.0, rtol=0.1)


@pytest.mark.slow_for("paper")
@pytest.mark.parametrize("kind", ["paper", "charged"])
def test_the_energy_with_cubic_absorbers_closes_as_the_step_shortens(kind: str) -> None:
    """The march's kernels see all frequencies: a loop that grows at any of them shows there, and more the shorter the step."""
    source = cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4)
    law: dict[str, Any] = {"mass": 50.0, "damping": 1e5, "linear_stiffness": 1e9, "cubic_stiffness": 1e20, "footprint": 0.2}
    absorbers, closed = [cx.Absorber(angle=angle, **law) for angle in (20.0, 160.0, 250.0)], []
    for step in (0.02, 0.01):
        run = cx.simulate(system(kind, source=source, absorbers=absorbers), duration=0.6, time_step=step, modes=4)
        closed.append(float(np.abs(run.energy(every=2).closure_relative).max()))
    assert closed[1] < 0.4 * closed[0] < 4e-5


@pytest.mark.slow_for("charged")
@pytest.mark.parametrize("kind", ["paper", "electrodes", "charged"])
def test_the_energy_closes_and_voltages_follow_the_law(kind: str, tmp_path: Any) -> None:
    response = run(kind)
    energy = response.energy()
    assert float(np.abs(energy.closure_relative).max()) < 2e-5
    assert float(energy.actuator_work[-1]) > 0.01 * float(energy.exterior_work.max())
    if kind != "paper":
        left = energy.amplifier_work - energy.actuator_field + energy.actuator_work
        assert float(np.abs(left).max()) < 1e-3 * float(energy.actuator_work.max())
    response.save(tmp_path / "run.nc")
    angles, step = [0.0, 70.0], 1e-2
    sensed, given = (np.asarray(f("inner", angles)) for f in (response.sensor_voltage, response.actuator_voltage))
    gains = GAINS[kind]
    rate = (-sensed[4:] + 8.0 * sensed[3:-1] - 8.0 * sensed[1:-3] + sensed[:-4]) / (12.0 * step)
    expected = gains.proportional * sensed[2:-2] + gains.derivative * rate
    late = slice(40, None)  # after the fronts, which differences blur
    assert np.linalg.norm((given[2:-2] - expected)[late]) < 0.1 * np.linalg.norm(given[2:-2][late])
    again = load_response(tmp_path / "run.nc")
    np.testing.assert_allclose(np.asarray(again.actuator_voltage("inner", angles)), given, rtol=1e-9)


def test_marched_absorbers_and_feedback_together() -> None:
    ring = cx.absorber_ring(3, mass=20, damping=1e5, linear_stiffness=1e9, cubic_stiffness=1e20, footprint=0.2)
    energy = cx.simulate(system("electrodes", absorbers=ring), duration=0.8, time_step=1e-2, modes=8).energy()
    assert float(np.abs(energy.closure_relative).max()) < 1e-4
    assert float(energy.damper_dissipation[-1]) > 0.0


@pytest.mark.parametrize(("kind", "sign"), [("paper", -1.0), ("electrodes", -1.0), ("electrodes", 1.0)])
def test_unstable_orders_are_those_of_thin_walls(kind: str, sign: float) -> None:
    control = GAINS[kind].replace(proportional=sign * GAINS[kind].proportional, derivative=sign * GAINS[kind].derivative)
    solid, thin = (dimensionless(system(kind, theory, 0.5, control=control)) for theory in ("elastic", "thin"))
    found, expected = (unstable_poles(problem, 6, 1.0).orders for problem in (solid, thin))
    np.testing.assert_array_equal(found, expected)
    assert (found.size > 0) == (sign < 0)


@pytest.mark.parametrize("kind", ["paper", "electrodes"])
def test_margins_of_the_loops_are_those_of_thin_walls(kind: str) -> None:
    exact, thin = (cx.stability_margins(system(kind, theory), duration=1.0, time_step=1e-2, modes=5) for theory in ("elastic", "thin"))
    np.testing.assert_allclose(exact.phase_margin.values, thin.phase_margin.values, atol=1.0)
    assert np.isfinite(thin.phase_margin.values).sum() > 3


def test_an_unstable_loop_is_refused() -> None:
    with pytest.raises(cx.InputError, match="makes the closed loop unstable"):
        cx.simulate(system("paper", control=cx.PDControl(proportional=2e4, derivative=150)), duration=1.0, time_step=2e-2, modes=6)
