"""Bridges of self-sensing layers: perfect ones are a sensor beside the actuator, others let the actuator's own voltage through."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model import presets
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.numerics.modes import Modes
from coaxshell.solver.plant import Plant
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solve import prepare, solve_prepared
from coaxshell.solver.stability import unstable_poles

PLANE = presets.load("electrodes").replace(source=cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4))
RUN = {"duration": 0.4, "time_step": 0.02, "modes": 5}
TIME = PLANE.transit_time
LAW = {"numerator": [0.2 * TIME, 3.0], "amplifier_corner": "5 kHz"}


def bridged(imbalance: float = 0.0, **others) -> cx.System:
    law = {**LAW, **others}
    return PLANE.replace(control=cx.Feedback(transducers="electrodes", bridge_imbalance=imbalance, **law))


def test_a_perfect_bridge_is_a_sensor_where_the_actuator_is():
    # Outer layers alone, driven and read; and inner ones read by their charge as if they lay where the outer ones are driven.
    one = bridged().with_overrides({f"shells[{i}].layers[0].role": "passive" for i in (0, 1)})
    roles = {f"shells[{i}].layers[{j}].role": role for i in (0, 1) for j, role in ((0, "charge-sensor"), (2, "actuator"))}
    problem, walls = dimensionless(bridged().with_overrides(roles)), []
    for wall in problem.shells:
        sensor, actuator = wall.section.piezoelectric
        walls.append(replace(wall, section=replace(wall.section, piezoelectric=(replace(sensor, centre=actuator.centre), actuator))))
    apart = replace(problem, shells=tuple(walls))
    settings = Settings(**RUN)
    other = solve_prepared(prepare(apart, settings), apart, settings)
    whole = cx.simulate(one, **RUN).solution
    for name in ("normal", "tangential", "control_voltage"):
        assert_allclose(getattr(other, name), getattr(whole, name), rtol=0, atol=1e-11 * np.abs(getattr(whole, name)).max())


@pytest.mark.parametrize("delay", [0.0, "1 us"])
def test_what_is_let_through_by_hand(delay):
    # y = phi + x u, u = H y and phi = phi_0 + G u: voltages by G of the plant.
    system, x = bridged(-0.05, delay=delay), -0.05
    solution, problem = cx.simulate(system, **RUN).solution, dimensionless(system)
    grid = LaplaceGrid(RUN["time_step"], round(RUN["duration"] / RUN["time_step"]))
    plant = Plant.of(problem, Modes.up_to(RUN["modes"]), grid.nodes)
    bare = cx.simulate(bridged(numerator=[0.0]), **RUN).solution.spectra
    read = [wall.sensor_gain(plant.modes).columns for wall in problem.shells]
    without = np.stack([gain.v * bare.tangential[i, 0] + gain.w * bare.normal[i, 0] for i, gain in enumerate(read)])
    seconds = grid.nodes / TIME
    law = system.control.polynomials
    h = np.polyval(law[0], seconds) / np.polyval(law[1], seconds) * np.exp(-system.control.delay * seconds)
    through = np.moveaxis(plant.transfer, (0, 1), (2, 3)) + x * np.eye(2)
    volts = np.linalg.solve(np.eye(2) - h[:, None, None] * through, np.moveaxis(h * without, 0, -1)[..., None])[..., 0]
    by_hand = grid.invert(np.moveaxis(volts, -1, 0)[:, None])
    assert_allclose(solution.control_voltage, by_hand, rtol=0, atol=1e-9 * np.abs(by_hand).max())
    balanced = cx.simulate(bridged(delay=delay), **RUN).solution
    assert np.abs(balanced.control_voltage - by_hand).max() > 0.02 * np.abs(by_hand).max()


def test_energy_closes_out_of_balance():
    energy = cx.simulate(bridged(-0.05, segments=4), **RUN).energy()
    assert np.abs(energy.closure_relative).max() < 2e-5
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert np.abs(electrical).max() < 1e-6 * np.abs(energy.actuator_work).max()


def test_files_and_shares():
    system = bridged(0.01)
    assert cx.System.from_toml_string(system.to_toml_string()) == system
    half = system.with_overrides({f"shells[{i}].layers[0].role": "charge-sensor" for i in (0, 1)})
    whole, shared = (dimensionless(one).shells[0].gains for one in (bridged(0.005), half))
    assert_allclose(shared.denominator, whole.denominator, rtol=1e-14)  # one of two sensors has a bridge


def test_stability_knows_what_is_let_through():
    # Capacitance in excess is positive feedback; where x H alone is stable the count decides.
    strong = {"numerator": [20 * TIME, 0.0], "amplifier_corner": "20 kHz"}
    largest = 1.0 / (20 * TIME * 2 * np.pi * 20e3)
    with pytest.raises(InputError, match=r"bridge_imbalance: .* feeds the amplifier its own voltage, which grows by e\^"):
        bridged(1.02 * largest, **strong)
    found = [unstable_poles(dimensionless(bridged(x * largest, **strong)), 5, 2.0).orders.size for x in (-0.98, 0.0, 0.98)]
    assert found == [0, 0, 0]  # collocated, and what is let through alone only turns the phase within a right angle


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"imbalance": 0.01, "amplifier_corner": None}, r"bridge_imbalance: 0\.01 feeds the amplifier its own voltage"),
        (
            {"imbalance": -0.02, "numerator": [100.0], "delay": "1 us"},
            r"bridge_imbalance: -0\.02 times the largest \|H\|, 2 at some frequency",
        ),
        ({"imbalance": 0.01, "matrix": [[1, 0], [0, 1]]}, r"bridge_imbalance: is not known beside a matrix"),
        ({"imbalance": 0.01, "weights": [1, 0.5]}, r"bridge_imbalance: is not known beside weights"),
        ({"imbalance": -1.0}, r"bridge_imbalance: -1\.0 .* must be greater than -1"),
    ],
)
def test_bridges_that_cannot_be(change, told):
    with pytest.raises(InputError, match=told):
        bridged(**change)


def test_a_bridge_needs_a_layer_that_does_both():
    roles = {f"shells[{i}].layers[{j}].role": role for i in (0, 1) for j, role in ((0, "sensor"), (2, "actuator"))}
    with pytest.raises(InputError, match=r"control\.bridge_imbalance: shells\[0\] has no self-sensing layer"):
        bridged(0.01).with_overrides(roles)
