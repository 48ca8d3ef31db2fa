"""Voltages at their limit beside absorbers: against the march of the paper's transducers, exact and thin walls, limits, energy, storage."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.solver.limited_absorbers import solve_limited_beside
from coaxshell.solver.recompute import spectra_of

SOURCE = cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4)
PAIRS, PAPER = (cx.presets.load(name).replace(source=SOURCE) for name in ("electrodes", "active"))
RUN: dict[str, Any] = {"duration": 0.3, "time_step": 2e-2, "modes": 3}
LINEAR = [cx.Absorber(angle=angle, mass=50.0, damping=1e5, linear_stiffness=1e9, footprint=0.2) for angle in (20.0, 160.0, 250.0)]
CUBIC = [one.replace(cubic_stiffness=1e20) for one in LINEAR]
MIXED = [[1.0, 0.5], [0.3, 0.8]]


def system(theory: str, absorbers: Any = LINEAR, scale: float = 1.0, **law: Any) -> cx.System:
    """Return pairs of electrodes under a lead, limits of 0.45 V, walls of a theory, all layers *scale* times as thick."""
    shells = []
    for shell in PAIRS.shells:
        layers = []
        for layer in shell.layers:
            standard = {"permittivity_reduction": "standard"} if isinstance(layer.material, cx.Piezoelectric) else {}
            layers.append(layer.replace(material=layer.material.replace(**standard), thickness=scale * layer.thickness))
        shells.append(shell.replace(layers=layers, theory=theory, **({"wetted": "faces"} if theory == "thin" else {})))
    limit = {"saturation": True, "field_limit": 150.0 / scale, **law}
    control = cx.Feedback(numerator=[2 * PAIRS.transit_time, 3], transducers="electrodes", **limit)
    return PAIRS.replace(shells=shells, control=control, absorbers=absorbers)


def off(one: cx.Response, other: cx.Response) -> float:
    return float(np.abs(one.solution.normal - other.solution.normal).max() / np.abs(other.solution.normal).max())


@pytest.mark.parametrize("absorbers", [LINEAR, CUBIC], ids=["linear", "cubic"])
def test_the_papers_transducers_on_thin_walls_are_those_of_the_march_of_all_at_once(absorbers: Any) -> None:
    """Links and orders stepped together by other kernels and Newton's method: both come to the same at second order."""
    described = PAPER.replace(absorbers=absorbers, control=PAPER.control.replace(saturation=True, field_limit=5e4))
    errors = []
    for step in (0.02, 0.01):
        solved = cx.simulate(described, **{**RUN, "duration": 0.6, "time_step": step}).solution.spectra
        assert solved.actuation is not None
        beside = solve_limited_beside(solved.structure, solved.absorbers)
        assert beside is not None
        one, other = (solved.grid.invert(each.normal) for each in (beside, solved))
        errors.append(np.abs(one - other).max() / np.abs(other).max())
    free = cx.simulate(described.with_overrides({"control.saturation": False}), **{**RUN, "duration": 0.6, "time_step": step})
    moved = np.abs(free.solution.normal - other).max() / np.abs(other).max()
    assert errors[1] < 0.05 * moved
    assert errors[0] / errors[1] > 2.5


def test_exact_walls_tend_to_thin_ones() -> None:
    errors = [off(*(cx.simulate(system(each, CUBIC, scale), **RUN) for each in ("elastic", "thin"))) for scale in (1.0, 0.25)]
    assert errors[1] < 0.3 * errors[0]


@pytest.fixture(scope="module")
def held() -> cx.Response:
    return cx.simulate(system("elastic", CUBIC, matrix=MIXED, segments=4, dead=[1]), **{**RUN, "modes": 4})


def test_voltages_stop_and_energy_closes(held: cx.Response, tmp_path: Any) -> None:
    asked, given = held.solution.segment_voltage, held.actuator_voltage("outer", [0.0, 90.0, 180.0, 270.0]).to_numpy()
    assert np.abs(asked).max() > 1.0
    np.testing.assert_allclose(given, np.clip(asked[1].T, -0.45, 0.45), atol=1e-12)
    assert not given[:, 1].any()
    energy = held.energy()
    assert float(np.abs(energy.closure_relative).max()) < 2e-4
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert float(np.abs(electrical).max()) < 1e-9 * float(np.abs(energy.actuator_work).max())
    assert 0.0 < held.solution.estimates.march.max() < 0.5
    again = spectra_of(cx.load_response(held.save(tmp_path / "run.nc")).solution)
    np.testing.assert_allclose(again.voltage, held.solution.spectra.voltage, rtol=0, atol=1e-9 * np.abs(again.voltage).max())


def test_a_limit_out_of_reach_leaves_the_linear_answer_digit_by_digit() -> None:
    quiet, free = (
        cx.simulate(system("elastic", **law), **RUN) for law in ({"field_limit": 1e9}, {"saturation": False, "field_limit": 1e9})
    )
    np.testing.assert_array_equal(quiet.solution.normal, free.solution.normal)


def test_a_limit_that_is_just_reached_leaves_almost_the_linear_answer() -> None:
    free = cx.simulate(system("elastic", saturation=False), **RUN)
    most = max(np.abs(free.actuator_voltage(one, np.arange(0.0, 360.0, 2.0)).to_numpy()).max() for one in ("inner", "outer"))
    just = cx.simulate(system("elastic", field_limit=0.999 * most / 3e-3), **RUN)
    assert just.solution.spectra.asked is not None
    assert off(just, free) < 1e-4


CUT = {"segments": 4, "saturation": False}


@pytest.mark.slow_except("thin-linear", "elastic-cubic")
@pytest.mark.parametrize("absorbers", [LINEAR, CUBIC], ids=["linear", "cubic"])
@pytest.mark.parametrize("theory", ["thin", "elastic"])
def test_currents_stop_beside_absorbers(theory: str, absorbers: Any, tmp_path: Any) -> None:
    few = {**RUN, "modes": 4}
    limit = {**CUT, "current_limit": "1 A/m^2"}
    others = (CUT, {**CUT, "current_limit": 1e6, "current_saturation": True})
    free, wide = (cx.simulate(system(theory, absorbers, **law), **few) for law in others)
    np.testing.assert_array_equal(wide.solution.normal, free.solution.normal)
    runs = [cx.simulate(system(theory, absorbers, **limit, current_saturation=True), **few, refinement=refined) for refined in (1, 2, 4)]
    held, finer, finest = runs
    assert off(held, free) > 3e-3
    assert off(held, finest) > 3.0 * off(finer, finest)
    assert free.control_effort()["outer"].current > 2.0
    assert any("the current was held at 1.000 A/m^2" in told for told in held.warnings)
    energy = held.energy()
    assert float(np.abs(energy.closure_relative).max()) < 2e-4
    electrical = energy.amplifier_work - (energy.actuator_field - energy.actuator_work)
    assert float(np.abs(electrical).max()) < 1e-9 * float(np.abs(energy.actuator_work).max())
    again = spectra_of(cx.load_response(held.save(tmp_path / "run.nc")).solution)
    np.testing.assert_allclose(again.voltage, held.solution.spectra.voltage, rtol=0, atol=1e-9 * np.abs(again.voltage).max())


def test_currents_beside_next_to_no_absorber_are_those_without() -> None:
    law = {**CUT, "current_limit": "1 A/m^2", "current_saturation": True}
    nothing = cx.Absorber(angle=0.0, mass=1e-9, damping=1e-6, linear_stiffness=1e-3)
    beside, alone = (cx.simulate(system("thin", one, **law), **{**RUN, "modes": 4}) for one in ([nothing], None))
    assert off(beside, alone) < 1e-9
