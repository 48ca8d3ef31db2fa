"""Feedback across shells of which some are elastic solids, with losses or without: each its own, thin walls, balances, poles, margins."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from electrode_pairs import pairs

import coaxshell as cx

PLANE = cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4)
RUN: dict[str, Any] = {"duration": 0.6, "time_step": 2e-2, "modes": 3}
MIXED = [[1.0, 0.5], [0.3, 0.8]]


def under(matrix: Any, *which: Any, **law: Any) -> cx.System:
    """Return pairs of electrodes under a lead that read each other, in a plane wave."""
    return pairs(*which, matrix=matrix, **law).replace(source=PLANE)


@pytest.mark.parametrize("loss_factor", [0.0, 0.05])
def test_shells_that_read_themselves_are_those_without_a_matrix(loss_factor: float) -> None:
    own, unit = (cx.simulate(under(matrix, loss_factor=loss_factor), **RUN) for matrix in (None, [[1, 0], [0, 1]]))
    for name in ("normal", "tangential"):
        one, other = getattr(own.solution, name), getattr(unit.solution, name)
        np.testing.assert_allclose(other, one, rtol=0, atol=1e-12 * np.abs(one).max())
    volts = [np.asarray(run.actuator_voltage("outer", [0, 70])) for run in (own, unit)]
    np.testing.assert_allclose(volts[1], volts[0], rtol=0, atol=1e-12 * np.abs(volts[0]).max())


@pytest.mark.parametrize(
    ("theories", "loss_factor"), [(("elastic", "elastic"), 0.05), (("thin", "elastic"), 0.0), (("elastic", "thin"), 0.05)]
)
def test_energy_closes_and_they_tend_to_thin_walls(theories: tuple[str, str], loss_factor: float) -> None:
    errors = []
    for scale in (1.0, 0.25):
        mixed, thin = (cx.simulate(under(MIXED, each, loss_factor, scale), **RUN) for each in (theories, ("thin", "thin")))
        a, b = (np.asarray(run.displacement("inner", [0, 50, 180])) for run in (mixed, thin))
        errors.append(np.linalg.norm(a - b) / np.linalg.norm(b))
        if scale == 1.0:
            energy = mixed.energy()
            assert float(np.abs(energy.closure_relative).max()) < 2e-5
            electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
            assert float(np.abs(electrical).max()) < 1e-6 * float(np.abs(energy.actuator_work).max())
            assert mixed.control_effort()["inner"].energy != 0.0
    assert errors[1] < 5e-3
    assert errors[1] < 0.27 * errors[0]


def test_one_wall_senses_and_the_other_acts() -> None:
    """Sensors on the inner shell alone drive actuators on the outer one alone: each lacks what its law does not ask for."""
    runs = []
    for theory in ("elastic", "thin"):
        described = under([[0, 0], [-0.2, 0]], (theory, theory))
        shells = []
        for shell, role in zip(described.shells, ("sensor", "actuator"), strict=True):
            layers = [layer if layer.role != "self-sensing" else layer.replace(role=role) for layer in shell.layers]
            shells.append(shell.replace(layers=layers))
        runs.append(cx.simulate(described.replace(shells=shells), **RUN))
    exact, thin = (np.asarray(run.actuator_voltage("outer", [0, 90])) for run in runs)
    assert np.abs(thin).max() > 1.0
    assert np.linalg.norm(exact - thin) < 0.1 * np.linalg.norm(thin)
    exact, thin = (np.asarray(run.displacement("outer", [0, 90])) for run in runs)
    assert np.linalg.norm(exact - thin) < 3e-3 * np.linalg.norm(thin)
    assert float(np.abs(runs[0].energy().closure_relative).max()) < 2e-5
    with pytest.raises(cx.InputError, match="there is no actuator"):
        runs[0].actuator_voltage("inner", 0)


def test_poles_and_margins_are_those_of_thin_walls() -> None:
    exact, thin = (cx.stability_margins(under(MIXED, (each, each)), duration=0.8, modes=3) for each in ("elastic", "thin"))
    np.testing.assert_allclose(exact.phase_margin.values, thin.phase_margin.values, atol=1.0)
    with pytest.raises(cx.InputError, match=r"control\.matrix: .* makes .* of all shells together grow"):
        cx.simulate(under([[0.0, 1.0], [1.0, 0.0]]), **RUN)


def test_segments_across_shells() -> None:
    energy = cx.simulate(under(MIXED, segments=3, dead=[1]), **RUN).energy()
    assert float(np.abs(energy.closure_relative).max()) < 2e-5
