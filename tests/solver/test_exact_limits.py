"""Segments and limits of voltages on walls of elastic solids: against the loops of the walls themselves, thin walls, whole electrodes."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.acoustics.basis import Modes
from coaxshell.solver.electrode_loops import ElectrodeLoops
from coaxshell.solver.electrode_patterns import patterns_of
from coaxshell.solver.limited_step import LimitedStep
from coaxshell.solver.recompute import spectra_of
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.solve import prepare
from coaxshell.solver.tied_stability import growing
from coaxshell.solver.voltage_response import driven, of_all, read_without, response_of

PAIRS, PAPER = cx.presets.load("electrodes"), cx.presets.load("active")
SOURCE = cx.PlaneShock(peak_pressure=25e3, decay_time=1.314e-4)
RUN: dict[str, Any] = {"duration": 0.8, "time_step": 2e-2, "modes": 12}


def system(theory: tuple[str, str] | str = "elastic", scale: float = 1.0, base: cx.System = PAIRS, **control: Any) -> cx.System:
    """Return a preset with walls of a theory, all layers *scale* times as thick, ceramics without printed slips, other control."""
    shells = []
    for shell, kind in zip(base.shells, (theory, theory) if isinstance(theory, str) else theory, strict=True):
        layers = []
        for layer in shell.layers:
            material = layer.material
            if isinstance(material, cx.Piezoelectric):
                material = material.replace(permittivity_reduction="standard")
            layers.append(layer.replace(thickness=scale * layer.thickness, material=material))
        shells.append(shell.replace(layers=layers, theory=kind, **({"wetted": "faces"} if kind == "thin" else {})))
    return base.replace(shells=shells, source=SOURCE, control=base.control.replace(**control))


@cache
def run(theory: str = "elastic", scale: float = 1.0, **control: Any) -> cx.Response:
    return cx.simulate(system(theory, scale, **control), **RUN)


def apart(one: cx.Response, other: cx.Response) -> float:
    return float(np.linalg.norm(one.solution.normal - other.solution.normal) / np.linalg.norm(other.solution.normal))


@pytest.mark.parametrize(
    ("theory", "base", "role"),
    [("elastic", PAIRS, "charge-sensor"), (("thin", "elastic"), PAIRS, "sensor"), ("elastic", PAPER, None)],
)
def test_voltages_from_outside_close_the_loop_as_the_walls_themselves_do(theory: Any, base: cx.System, role: str | None) -> None:
    """u = (1 - H C)^-1 H phi and what it moves, beside receptances that have the loop within them."""
    described, settings = system(theory, base=base), Settings(**RUN)
    if role is not None:
        described = described.with_overrides({"shells[1].layers[0].role": role})
    structure = prepare(dimensionless(described, settings=settings), settings)
    response, without = response_of(structure), read_without(structure)
    patterns = patterns_of(structure.problem, response.shells, structure.modes.orders, without.shape[1])
    loops = ElectrodeLoops.of(structure.problem, response, patterns, structure.grid.nodes)
    voltage = patterns.in_orders(loops.voltages(patterns.readings(without)))
    found, expected = driven(structure, response, of_all(structure.problem, response, voltage)).solid, structure.solid
    assert found is not None
    assert expected is not None
    for name in ("normal", "tangential", "hoop", "faces", "loads", "potentials"):
        there = getattr(expected, name)
        np.testing.assert_allclose(getattr(found, name), there, rtol=0, atol=1e-8 * np.abs(there).max(), err_msg=name)
    bare = structure.open_loop.normal
    assert np.abs(bare - expected.normal).max() > 1e-3 * np.abs(bare).max()


def test_segments_tend_to_the_whole_electrode() -> None:
    """As N^-2 where orders suffice, and here as on thin walls, whose rate is known."""
    errors, of_thin = ([apart(run(theory, segments=count), run(theory)) for count in (4, 12)] for theory in ("elastic", "thin"))
    np.testing.assert_allclose(errors, of_thin, rtol=0.1)
    assert errors[0] / errors[1] > 5.0


def test_segments_and_limits_tend_to_those_of_thin_walls() -> None:
    for control in ({"segments": 5, "segment_gap": 0.02, "dead": (1,)}, {"saturation": True, "field_limit": 5e3}):
        errors = [apart(run("elastic", scale, **control), run("thin", scale, **control)) for scale in (1.0, 0.25)]
        assert errors[1] < 1.2e-3
        assert errors[0] / errors[1] > 3.5


@pytest.fixture(scope="module")
def held() -> cx.Response:
    described = system(segments=6, segment_gap=0.01, dead=(2,), saturation=True, field_limit=3e3)
    return cx.simulate(described, **{**RUN, "duration": 0.6, "modes": 6})


def test_energies_close_where_cut_voltages_are_held(held: cx.Response, tmp_path: Any) -> None:
    asked, angles = held.solution.segment_voltage, np.arange(0.0, 360.0, 60.0)
    given = held.actuator_voltage("outer", angles).to_numpy()
    assert np.abs(asked).max() > 10.0
    np.testing.assert_allclose(np.abs(given).max(), 9.0, rtol=1e-9)
    np.testing.assert_allclose(given, np.clip(asked[1].T, -9.0, 9.0))
    assert not given[:, 2].any()
    energy = held.energy(every=5)
    assert float(np.abs(energy.closure_relative).max()) < 1e-4
    electrical = energy.amplifier_work - energy.actuator_field + energy.actuator_work
    assert float(np.abs(electrical).max()) < 1e-9 * float(np.abs(energy.amplifier_work).max())
    kept = cx.load_response(held.save(tmp_path / "run.nc"))
    np.testing.assert_allclose(spectra_of(kept.solution).voltage, held.solution.spectra.voltage, rtol=1e-9, atol=1e-12)


def test_what_stands_within_a_wall_is_that_of_the_loop_within_it() -> None:
    """At a depth, from loads and given voltages; where a limit is just reached almost the linear answer, from loads alone."""
    free = run()
    volts = free.actuator_voltage("inner", np.arange(0.0, 361.0, 2.0)).to_numpy()
    just = run(saturation=True, field_limit=0.999 * float(np.abs(volts).max()) / 3e-3)
    assert just.solution.spectra.voltage is not None
    for depth in ("inner", 0.0):
        one, other = (np.asarray(each.stress("inner", [0.0, 70.0], depth=depth)) for each in (just, free))
        np.testing.assert_allclose(one, other, rtol=0, atol=2e-3 * np.abs(other).max())


def test_a_limit_that_is_not_reached_leaves_the_linear_answer_of_the_papers_law_too() -> None:
    quiet, loud = (cx.simulate(system(base=PAPER, saturation=True, field_limit=limit), **RUN) for limit in (1e9, 5e4))
    free = cx.simulate(system(base=PAPER), **RUN)
    np.testing.assert_array_equal(quiet.solution.normal, free.solution.normal)
    angles = np.arange(0.0, 361.0, 5.0)
    assert np.abs(loud.actuator_voltage("inner", angles).to_numpy()).max() == pytest.approx(150.0, rel=1e-9)
    assert apart(loud, free) > 1e-3


def test_late_loops_of_segments_grow_as_on_thin_walls() -> None:
    law = cx.Feedback(numerator=[1.4e-3, 0], amplifier_corner=5e3, delay="20 us", transducers="electrodes", segments=6)
    found = [growing(dimensionless(system(theory, 0.5).replace(control=law)), 8, 1.0) for theory in ("elastic", "thin")]
    assert found[0] is not None
    assert found[1] is not None
    np.testing.assert_array_equal(found[0].patterns, found[1].patterns)
    strong = system(proportional=50.0, derivative=10.0, segments=7, dead=(0,))
    assert growing(dimensionless(strong), 8, 0.5) is None  # what pushes reads: counted, no pole


def test_a_step_that_turns_in_circles_is_solved_by_parts_of_corrections(monkeypatch: pytest.MonkeyPatch) -> None:
    """Many orders close to a limit, of strong feedback, where whole corrections do not settle: the conditions of a step hold."""
    rng, modes = np.random.default_rng(3), Modes.up_to(40)
    patterns = patterns_of(dimensionless(system()), (0, 1), modes.orders, 1)
    kappa = 0.98 * rng.uniform(0.5, 1.0, 41)
    limits = np.ones((1, len(patterns.evaluate)))
    monkeypatch.setattr(LimitedStep, "_safely", None)
    for _ in range(10):
        known = np.where(modes.orders == 0, 2.5, 0.4 * rng.normal(size=41))[None]
        delta, _ = LimitedStep(patterns, limits, -kappa[None, None]).solve(known)
        volts = (known - kappa * delta) @ patterns.evaluate.T
        np.testing.assert_allclose(delta, (np.clip(volts, -limits, limits) - volts) @ patterns.project.T, atol=1e-8)
