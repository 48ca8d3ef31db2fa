"""The design of a control law: its plant against the determinants of stability and against runs, limits that are kept, refusals."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.numerics.modes import Modes
from coaxshell.solver.plant import Plant, diagonal, loci
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.settings import Settings
from coaxshell.solver.stability import opened, unstable_poles
from coaxshell.structure.control_law import ControlGains
from coaxshell.studies.control_design.bench import Bench
from coaxshell.studies.control_design.design import design_control

PAIRS = cx.presets.load("electrodes")
SMALL = {"duration": 1.0, "time_step": 2.5e-2, "modes": 2}
NODES = np.array([0.5 + 0.3j, 0.5 + 4.0j, 0.5 + 60.0j])


@pytest.fixture(scope="module")
def design():
    return design_control(PAIRS, delay="5 us", bandwidth="100 kHz", kinds="rate", **SMALL)


@pytest.mark.parametrize("name", ["electrodes", "active"])
def test_the_plant_has_the_determinants_of_stability(name):
    problem, modes = dimensionless(cx.presets.load(name)), Modes.up_to(5)
    plant, law = Plant.of(problem, modes, NODES), problem.shells[0].gains.at(NODES, modes)
    closed = np.prod(1.0 - loci(plant.transfer, diagonal(np.broadcast_to(law, (6, 3)), 2)), axis=0)
    expected = opened(problem, problem.open_loop, NODES, modes, None).closed(problem, NODES, modes)
    np.testing.assert_allclose(closed, expected, rtol=1e-8)


def test_the_bench_does_what_a_run_does():
    law, settings = ControlGains(3.0, 2.0), Settings(**SMALL)
    control = cx.PDControl(proportional=3, derivative=2, transducers="electrodes")
    run = cx.simulate(PAIRS.replace(control=control), settings=settings)
    bench = Bench(dimensionless(PAIRS, settings=settings), settings)
    found = bench.effect(law)
    for shell in (0, 1):
        places = np.arange(0.0, 181.0, 10.0)
        volts = run.actuator_voltage(shell, places)
        assert found.volts[shell] == pytest.approx(float(abs(volts).max()), rel=1e-6)
        faces = [run.stress(shell, places, depth=z) for z in (-2.9994e-3, 2.9994e-3)]
        assert found.core[shell] == pytest.approx(max(float(abs(one).max()) for one in faces), rel=1e-4)
        # Ceramics are 3 mm beside a core of 6: each carries the most at its outer face, the actuator also by its own field.
        ceramics = [run.stress(shell, places, depth=z) for z in (-3.0003e-3, 5.9997e-3)]
        assert found.ceramic[shell] == pytest.approx(max(float(abs(one).max()) for one in ceramics), rel=1e-4)
    assert (found.core < bench.without.core).all()


def test_the_law_keeps_its_margins_and_lowers_the_stress(design):
    assert design.law.delay == pytest.approx(5e-6)
    assert design.law.amplifier_corner == pytest.approx(1e5)
    assert all(one.share > 0.05 for one in design.reductions)
    assert design.alternatives[0].kind == design.kind
    problem = dimensionless(design.system, settings=design.settings)
    more = [wall.with_gains(wall.gains.times(1.95)) for wall in problem.shells]  # the gain margin asked for is 2
    assert unstable_poles(replace(problem, shells=tuple(more)), 2, 1.0).orders.size == 0
    assert float(design.margins["phase_margin"].min()) > 25.0
    assert design.effort.within


def test_it_reads_as_text_and_as_plain_data(design):
    told = str(design)
    assert "margins: gain" in told
    assert "ceramics without" in told
    assert design.to_dict()["law"]["weights"] == design.law.weights
    assert cx.Feedback.model_validate(design.to_dict()["law"]) == design.law


def test_less_voltage_is_kept(design):
    most = 0.3 * max(float(abs(design.response.actuator_voltage(i, np.arange(0.0, 181.0, 10.0))).max()) for i in (0, 1))
    weak = design_control(PAIRS, delay="5 us", bandwidth="100 kHz", kinds="rate", voltage=most, **SMALL)
    assert max(float(abs(weak.response.actuator_voltage(i, np.arange(0.0, 181.0, 10.0))).max()) for i in (0, 1)) <= 1.01 * most
    assert weak.reductions[0].share < design.reductions[0].share


OPPOSITE = {f"shells[{i}].layers[{j}].role": role for i in (0, 1) for j, role in ((0, "sensor"), (2, "actuator"))}


@pytest.mark.parametrize(
    ("system", "keywords", "where", "words"),
    [
        (PAIRS, {"kinds": "bang-bang"}, "kinds", "unknown"),
        (PAIRS, {"delay": -1e-6}, "delay", "at least 0"),
        (PAIRS, {"bandwidth": 0}, "bandwidth", "above 0"),
        (PAIRS, {"gain_margin": 0.5}, "gain_margin", "at least 1"),
        (PAIRS, {"voltage": 1e-9}, "voltage", "needs"),
        (PAIRS, {"shells": ["inner"], "of": "outer"}, "of", "not controlled"),
        (PAIRS.with_overrides({"shells[0].theory": "elastic"}), {}, "shells", "no plant"),
        (PAIRS, {"dimensions": 3}, "settings", "two dimensions"),
    ],
)
def test_what_is_refused(system, keywords, where, words):
    with pytest.raises(InputError, match=words) as caught:
        design_control(system, **{"kinds": "rate", **SMALL, "modes": 2, **keywords})
    assert caught.value.where == where
