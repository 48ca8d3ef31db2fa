"""Feedback by any rational law: the limit of PD control, roots of dry walls in closed form, modal filters, energy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.numerics.modes import Modes
from coaxshell.solver.scaling import dimensionless
from coaxshell.solver.stability import fastest_growth, unstable_poles
from coaxshell.structure.control_law import ControlGains, RationalLaw

BARE = cx.presets.load("bare")
TIME = BARE.transit_time
PAIRS = BARE.with_overrides({f"shells[{i}].layers[{j}].role": "self-sensing" for i in (0, 1) for j in (0, 2)})
RUN = {"duration": 0.8, "time_step": 0.01, "modes": 6}


def pairs(**law) -> cx.System:
    return PAIRS.replace(control=cx.Feedback(transducers="electrodes", **law))


def dry(**law) -> cx.System:
    """Return the outer shell alone, beside a fluid too light to matter."""
    system = pairs(**law)
    return system.replace(shells=[system.shells[1]], fluids=["vacuum", cx.Fluid(density=1e-6, sound_speed=1400)])


@pytest.fixture(scope="module")
def proportional_derivative():
    control = cx.PDControl(proportional=3.0, derivative=2.0, transducers="electrodes")
    return cx.simulate(PAIRS.replace(control=control), **RUN)


def difference(one, other) -> float:
    return float(np.abs(one - other).max() / np.abs(other).max())


def test_the_same_law_gives_the_same_answer(proportional_derivative):
    alike = cx.simulate(pairs(numerator=[4.0 * TIME, 6.0], denominator=[2.0], weights=[1.0] * 7), **RUN)
    assert difference(alike.solution.normal, proportional_derivative.solution.normal) < 1e-12
    volts = [x.actuator_voltage("outer", angle=[0, 70]).to_numpy() for x in (alike, proportional_derivative)]
    assert difference(*volts) < 1e-10
    peaks = [x.summary().shells[0].actuator_voltage.value for x in (alike, proportional_derivative)]
    assert peaks[0] == pytest.approx(peaks[1], rel=1e-10)


def test_the_papers_law_too():
    paper = cx.simulate(BARE.replace(control=cx.PDControl(proportional=-2e4, derivative=-150)), **RUN)
    alike = cx.simulate(BARE.replace(control=cx.Feedback(numerator=[-150 * TIME, -2e4])), **RUN)
    assert difference(alike.solution.tangential, paper.solution.tangential) < 1e-12


def test_delay_and_corner_tend_to_none(proportional_derivative):
    plain = proportional_derivative.solution.normal
    late = [cx.simulate(pairs(numerator=[2 * TIME, 3], delay=delay), **RUN).solution.normal for delay in (4e-9, 1e-9)]
    errors = [difference(one, plain) for one in late]
    assert errors[0] == pytest.approx(4 * errors[1], rel=0.02)
    assert errors[1] < 1e-5
    high = cx.simulate(pairs(numerator=[2 * TIME, 3], amplifier_corner="1 GHz"), **RUN)
    assert difference(high.solution.normal, plain) < 1e-4


def test_a_modal_filter_leaves_the_other_orders_alone(proportional_derivative):
    filtered = cx.simulate(pairs(numerator=[2 * TIME, 3], weights=2), **RUN).solution.normal
    none = cx.simulate(pairs(numerator=[0.0]), **RUN).solution.normal
    plain = proportional_derivative.solution.normal
    np.testing.assert_allclose(filtered[:, :, :3], plain[:, :, :3], rtol=0, atol=1e-13 * np.abs(plain).max())
    np.testing.assert_allclose(filtered[:, :, 3:], none[:, :, 3:], rtol=0, atol=1e-13 * np.abs(none).max())
    assert difference(filtered, plain) > 1e-3


def test_energy_closes_with_delay_and_corner():
    energy = cx.simulate(pairs(numerator=[0.2 * TIME, 3], denominator=[1e-6, 1], delay="0.2 us", weights=3), **RUN).energy()
    assert float(np.abs(energy["closure_relative"]).max()) < 1e-5
    supply = energy["amplifier_work"] + energy["actuator_work"] - energy["actuator_field"]
    assert float(np.abs(supply).max()) < 1e-6 * float(np.abs(energy["amplifier_work"]).max())


class TestRoots:
    """Of a dry shell breathing, M s^2 + K - H(s) P S = 0."""

    @pytest.mark.parametrize(
        ("law", "corner"),
        [
            ({"numerator": [8e7], "denominator": [1.0, 4e2, 3e7]}, None),  # a resonator that drives
            ({"numerator": [-20.0], "denominator": [1e-4, 1.0]}, "3 kHz"),  # softer than nothing
            ({"numerator": [1e5], "denominator": [1.0, 0.0]}, None),  # integral feedback
        ],
    )
    def test_rational(self, law, corner):
        problem = dimensionless(dry(**law, sensor_corner=corner))
        wall, modes = problem.shells[0], Modes.up_to(0)
        stiffness, fed = wall.stiffness(modes).ww[0], (wall.drive(modes).w * wall.sensor_gain(modes).w)[0]
        numerator, denominator = law["numerator"], np.asarray(law["denominator"])
        if corner:
            denominator = np.polymul(denominator, [1 / (2 * np.pi * 3e3), 1.0])
        seconds = np.polysub(np.polymul([wall.mass / TIME**-2, 0.0, stiffness], denominator), np.multiply(fed, numerator))
        roots = np.roots(seconds) * TIME
        expected = roots[roots.real.argmax()]
        assert expected.real > 0.05
        assert unstable_poles(problem, 0, 40.0).counts.tolist() == [2.0 if abs(expected.imag) > 0 else 1.0]
        growth = fastest_growth(problem, np.zeros(1), 0.025)
        assert (growth.rate, growth.frequency) == pytest.approx((expected.real, abs(expected.imag)), rel=1e-6)

    def test_delayed(self):
        problem = dimensionless(dry(numerator=[0.5 * TIME, 0.0], delay="600 us"))
        wall, modes = problem.shells[0], Modes.up_to(0)
        stiffness, fed = wall.stiffness(modes).ww[0], (wall.drive(modes).w * wall.sensor_gain(modes).w)[0]
        late = 600e-6 / TIME
        growth = fastest_growth(problem, np.zeros(1), 0.025)

        def equation(parts):
            s = complex(*parts)
            left = s * s + (stiffness - 0.5 * s * np.exp(-s * late) * fed) / wall.mass
            return [left.real, left.imag]

        root = optimize.fsolve(equation, [growth.rate, growth.frequency])
        assert root[0] > 0.1
        assert (growth.rate, growth.frequency) == pytest.approx(tuple(root), rel=1e-6)


@pytest.mark.parametrize(
    ("law", "words"),
    [
        ({"numerator": [5 * TIME, 0.0], "delay": "20 us"}, ("control.delay: 20.00 µs makes the closed loop unstable: order", "Hz")),
        ({"numerator": [-5 * TIME, 0.0]}, ("control.numerator: [-0.0035", "makes the closed loop unstable: order", "Hz")),
    ],
)
def test_unstable_loops_are_refused(law, words):
    with pytest.raises(InputError) as caught:
        cx.simulate(pairs(**law), duration=2.0, time_step=0.02, modes=8)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"engine": "direct"}, ("control: Feedback", "direct engine", 'engine="spectral"')),
    ],
)
def test_refused_elsewhere(changes, words):
    with pytest.raises(InputError) as caught:
        cx.simulate(BARE.replace(control=cx.Feedback(numerator=[-1.0])), duration=1, time_step=0.02, modes=4, **changes)
    for word in words:
        assert word in str(caught.value)


def test_a_saved_run_keeps_its_voltage(tmp_path):
    response = cx.simulate(pairs(numerator=[TIME, 3], denominator=[1e-6, 1], weights=3), duration=0.6, time_step=0.02, modes=4)
    response.save(tmp_path / "run.nc")
    again = cx.load_response(tmp_path / "run.nc")
    np.testing.assert_array_equal(again.actuator_voltage("inner", angle=30), response.actuator_voltage("inner", angle=30))
    assert float(np.abs(again.actuator_voltage("inner", angle=30)).max()) > 1.0


def test_reach_of_a_law():
    size = np.array([0.5, 3.0])
    simple = RationalLaw((0.0, 8.0), (1.0,))
    np.testing.assert_allclose(simple.rate(size), np.sqrt(8.0 * size), rtol=0.03)
    assert simple.fades(size) >= np.sqrt(2 * 8.0 * 3.0)
    derivative = RationalLaw((5.0, 0.0), (1.0,))
    np.testing.assert_allclose(derivative.rate(size), ControlGains(0.0, 5.0).rate(size), rtol=0.03)
    assert RationalLaw((1.0,), (1.0,), weights=(0.0, 0.0)).zero
