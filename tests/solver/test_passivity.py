"""Walls that stay passive with their feedback: against the count of poles, closed forms and finer nodes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from electrode_pairs import pairs

import coaxshell as cx
from coaxshell.numerics.modes import Modes
from coaxshell.solver import contour, passivity, stability
from coaxshell.solver.contour import along_alone
from coaxshell.solver.passivity import passive_orders
from coaxshell.solver.scaling import FluidRegion, dimensionless
from coaxshell.solver.stability import unstable_poles

BARE = cx.presets.load("bare")
TIME = BARE.transit_time
PAIRS = BARE.with_overrides({f"shells[{i}].layers[{j}].role": "self-sensing" for i in (0, 1) for j in (0, 2)})
MODES = Modes.up_to(10)
CORNER = 2.0 * np.pi * 5e4 * TIME


def paper(proportional: float, derivative: float) -> cx.System:
    return BARE.replace(control=cx.PDControl(proportional=proportional, derivative=derivative))


def electrodes(**law) -> cx.System:
    return PAIRS.replace(control=cx.Feedback(transducers="electrodes", **law))


LOSSY = {"materials.aluminium.loss_factor": 0.05, "materials.PZT-4.loss_factor": 0.05}
LAWS = {
    "the paper's": paper(-2e4, -150.0),
    "the paper's, derivative alone": paper(0.0, -150.0),
    "the other sign": paper(2e4, 0.0),
    "electrodes": electrodes(numerator=[10 * TIME, 100.0]),
    "a corner": electrodes(numerator=[2 * TIME, 3.0], amplifier_corner="50 kHz"),
    "a low corner": electrodes(numerator=[2 * TIME, 300.0], amplifier_corner="10 kHz"),
    "a delay": electrodes(numerator=[10 * TIME, 0.0], delay="5 us"),
    "few orders late": electrodes(numerator=[TIME, 0.0], delay="1 us", weights=2),
    "weak and late": electrodes(numerator=[1e-5 * TIME, 0.0], delay="2 us"),
    "losses": electrodes(numerator=[2 * TIME, 3.0]).with_overrides(LOSSY),
    "losses and a short delay": electrodes(numerator=[0.01 * TIME, 0.0], delay="0.5 us").with_overrides(LOSSY),
    "a resonator": electrodes(numerator=[5.0, 0.0], denominator=[2.8e-9, 1e-6, 1.0]),
    "positive position feedback": electrodes(numerator=[-0.5], denominator=[2.8e-9, 1e-5, 1.0]),
    "apart": BARE.replace(control=cx.PDControl(proportional=0, derivative=1, transducers="electrodes")),
}


@pytest.fixture(scope="module")
def counted() -> dict[str, set[float]]:
    """Return the unstable orders of each law by counting all of them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stability, "passive_orders", lambda problem, modes, least: np.zeros(modes.count, dtype=bool))
        return {name: set(unstable_poles(dimensionless(system), 10, 4.0).orders.tolist()) for name, system in LAWS.items()}


@pytest.mark.parametrize("name", LAWS)
def test_no_order_found_passive_is_unstable(name, counted):
    passive = set(MODES.orders[passive_orders(dimensionless(LAWS[name]), MODES, 0.25)].tolist())
    assert not passive & counted[name]
    assert set(unstable_poles(dimensionless(LAWS[name]), 10, 4.0).orders.tolist()) == counted[name]


def test_usual_laws_need_no_count(monkeypatch):
    monkeypatch.setattr(stability, "turned", lambda *_: pytest.fail("poles were counted"))
    for name in ("the paper's", "the paper's, derivative alone", "electrodes", "a corner", "losses"):
        assert unstable_poles(dimensionless(LAWS[name]), 10, 4.0).orders.size == 0


@pytest.mark.parametrize(("proportional", "passive"), [(0.9, True), (1.1, False)])
def test_a_corner_is_harmless_up_to_the_gain_that_it_turns(proportional, passive):
    # (k_p + k_d s)/(1 + s/w) has a positive real part over s, for Re s = 0, as long as k_p < k_d w.
    system = electrodes(numerator=[40.0 * TIME, 40.0 * proportional * CORNER], amplifier_corner=5e4)
    assert passive_orders(dimensionless(system), MODES, 1e-3).all() == passive


@pytest.mark.parametrize(("gains", "proven"), [((0.0, 2.0), range(31)), ((100.0, 10.0), range(6)), ((0.0, -2.0), range(1, 1))])
def test_layers_of_solid_walls_that_sense_and_act_are_passive_as_long_as_they_do_the_same(gains, proven, monkeypatch):
    # What they push and what they read part as the square of the order; a push of the wrong sign is counted, and grows.
    modes, law = Modes.up_to(30), cx.PDControl(proportional=gains[0], derivative=gains[1], transducers="electrodes")
    problem = dimensionless(pairs().replace(control=law))
    passive = set(modes.orders[passive_orders(along_alone(problem, modes), modes, 0.25)].tolist())
    assert passive >= set(proven)
    assert (len(passive) > 0) == (len(proven) > 0)
    monkeypatch.setattr(stability, "passive_orders", lambda problem, modes, least: np.zeros(modes.count, dtype=bool))
    counted = unstable_poles(problem, 30, 4.0).orders
    assert not passive & set(counted.tolist())
    assert (counted.size > 0) == (gains[1] < 0.0)


def test_a_filter_leaves_orders_as_they_are():
    found = passive_orders(dimensionless(electrodes(numerator=[-5.0, 0.0], weights=3, amplifier_corner=1e3)), MODES, 0.25)
    np.testing.assert_array_equal(found, MODES.orders > 3)


@pytest.mark.parametrize("name", ["the paper's", "a corner", "losses", "positive position feedback"])
def test_between_the_nodes_is_nothing_else(name):
    problem = dimensionless(LAWS[name])
    for wall in problem.shells:
        coarse = passivity._frequencies(wall, MODES, 0.25)
        parts = np.linspace(0.0, 1.0, 8, endpoint=False)
        fine = (coarse[:, :-1, None] + np.diff(coarse)[:, :, None] * parts).reshape(MODES.count, -1)
        least, finer = (wall.resistance(MODES, 0.25 + 1j * x).min(axis=1) for x in (coarse, fine))
        assert np.all(finer > least - 0.1 * wall.mass * 0.25)


def test_fluids_that_may_give_energy_are_not_trusted():
    class Giving(FluidRegion):
        """A fluid that may feel its walls otherwise than they move."""

    problem = dimensionless(LAWS["the paper's"])
    inside = Giving(problem.fluids[0].density, problem.fluids[0].slowness)
    assert not passive_orders(replace(problem, fluids=(inside, *problem.fluids[1:])), MODES, 0.25).any()


def test_the_contour_reaches_a_membrane_above_where_feedback_fades():
    # A weak push of the wrong sign grows at the membrane's frequency, far above |k_d| |P||S|/M of the paper's law.
    problem = dimensionless(paper(0.0, 2e-3))
    fades = contour.highest_frequency(problem, 10)
    assert fades < problem.shells[0].highest_frequency(MODES).max()
    walked = contour.Contour.of(problem, MODES, 0.25)
    assert walked.even[-1] > problem.shells[0].highest_frequency(MODES).max()
