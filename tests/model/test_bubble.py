"""Bubble pulses: the model, of which only the largest radius is an input, against measured periods and peaks; what cannot be is refused."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.model.bubble import ADIABAT, DENSITY, first_pulse, oscillation, similitude_period
from coaxshell.model.sea import ATMOSPHERE, GRAVITY

CHARGE = cx.UnderwaterExplosion(charge_mass=10, stand_off=8, bubble_pulses=2, charge_depth=20)


@pytest.mark.parametrize(("mass", "depth"), [(1.0, 10.0), (10.0, 20.0), (500.0, 100.0)])
def test_period_and_first_pulse_are_those_measured(mass: float, depth: float) -> None:
    """K5 = 2.11 (Swisdak), and 2590 psi ft/lb^(1/3) = 7.08 MPa m/kg^(1/3) (Cole): neither is an input."""
    time, strength = oscillation(mass, depth, 3.50, 2)
    period = 2.11 * mass ** (1 / 3) / (depth + 10.0) ** (5 / 6)
    first = np.where(time > 0.6 * period, strength, -np.inf).argmax()
    assert time[first] == pytest.approx(period, rel=0.05)
    assert strength[first] / mass ** (1 / 3) == pytest.approx(7.08e6, rel=0.25)
    second = np.where(time > 1.4 * period, strength, -np.inf).argmax()
    assert time[second] - time[first] < time[first]
    assert 0.3 < strength[second] / strength[first] < 0.6


@pytest.mark.parametrize("name", ["HBX-1", "PETN"])
def test_other_explosives_are_consistent(name: str) -> None:
    """Their K5 and K6 are fits of their own: a bubble without gas has K5/K6 = 1.829/sqrt(g) = 0.584 (Rayleigh), gas adds a few percent."""
    explosive = cx.EXPLOSIVES[name]
    assert 0.584 < explosive.bubble_period / explosive.bubble_radius < 1.06 * 0.584
    for mass, depth in ((1.0, 10.0), (500.0, 100.0)):
        period = similitude_period(mass, depth, explosive.bubble_period)
        assert first_pulse(mass, depth, explosive.bubble_radius) == pytest.approx(period, rel=0.05)
    lb, foot = 0.45359237, 0.3048  # the table in its own units
    k5, k6 = {"HBX-1": (4.761, 14.14), "PETN": (4.339, 12.88)}[name]
    assert explosive.bubble_period == pytest.approx(k5 * foot ** (5 / 6) / lb ** (1 / 3), rel=1e-3)
    assert explosive.bubble_radius == pytest.approx(k6 * foot ** (4 / 3) / lb ** (1 / 3), rel=1e-3)


def test_where_model_and_similitude_disagree_a_run_warns() -> None:
    deep = CHARGE.replace(charge_mass=1.0, charge_depth=2000.0)
    system = cx.presets.load("bare").replace(source=deep)
    told = " ".join(cx.simulate(system, duration=0.2, time_step=2e-2, modes=2).warnings)
    assert "the first bubble pulse comes 4.286 ms after the shock wave, 3.729 ms by the similitude of TNT" in told


def test_where_the_bubble_is_largest_it_pulls_with_the_pressure_at_rest() -> None:
    """At rest at a = A: rho V''/(4 pi) = A (p_g - p_0)."""
    mass, depth, factor = 10.0, 20.0, 3.5
    time, strength = oscillation(mass, depth, factor, 1)
    largest = factor * (mass / 30.0) ** (1 / 3)
    gas = ADIABAT * (1e3 * 4 / 3 * np.pi * largest**3 / mass) ** -1.25
    rest = ATMOSPHERE + DENSITY * GRAVITY * depth
    middle = np.abs(time - 0.5 * 2.11 * mass ** (1 / 3) / 30.0 ** (5 / 6)).argmin()
    assert strength[middle] == pytest.approx(largest * (gas - rest), rel=1e-2)


def test_the_pulse_begins_as_the_shock_wave_and_goes_on_as_the_bubble() -> None:
    pulse, shock = CHARGE.pulse, CHARGE.replace(bubble_pulses=0, charge_depth=None).pulse
    time, pressure = pulse.curve
    early = time < 1.4 * shock.decay_time
    np.testing.assert_allclose(pressure[early], shock.peak_pressure * np.exp(-time[early] / shock.decay_time), rtol=1e-12)
    assert pulse.peak == pytest.approx(shock.peak)
    later = (time > 0.2) & (time < 0.35)
    assert 5e5 < pressure[later].max() < 3e6
    assert pressure.min() > -2e5
    assert CHARGE.replace(stand_off=16.0).pulse.curve[1][later].max() == pytest.approx(0.5 * pressure[later].max())
    assert CHARGE.bubble.largest_radius == pytest.approx(2.427, rel=1e-3)


@pytest.mark.parametrize(
    ("changes", "where", "words"),
    [
        ({"charge_depth": None}, "charge_depth", "a bubble depends on it"),
        ({"bubble_pulses": 0}, "charge_depth", "has no effect without a bubble"),
        ({"explosive": "pentolite"}, "bubble_pulses", "no sourced constants"),
        ({"charge_depth": "2 m"}, "charge_depth", "break through the surface"),
        ({"bubble_pulses": 11}, "bubble_pulses", "11"),
        ({"bubble_pulses": True}, "bubble_pulses", "not a count"),
    ],
)
def test_what_cannot_be_is_refused(changes: dict[str, object], where: str, words: str) -> None:
    with pytest.raises(InputError) as found:
        CHARGE.replace(**changes)
    assert found.value.where == where
    assert words in str(found.value)


def test_sea_and_charge_tell_one_depth() -> None:
    bare = cx.presets.load("bare")
    with pytest.raises(InputError, match="it lies 30 m below the surface"):
        bare.replace(source=CHARGE, sea=cx.Sea(depth=30.0))
    system = bare.replace(source=CHARGE, sea=cx.Sea(depth=20.0))
    assert cx.System.from_toml_string(system.to_toml_string()) == system
    assert "bubble of 2.427 m, first pulse after 267.1 ms" in system._repr_html_()
    plain = bare.replace(source=CHARGE.replace(bubble_pulses=0, charge_depth=None))
    assert "bubble" not in plain.to_toml_string()


def test_it_is_solved_with_its_image() -> None:
    """Long before the first bubble pulse the answer is the shock wave's, but for what the bubble adds after it."""
    bare = cx.presets.load("bare")
    settings = {"duration": 0.6, "time_step": 1e-2, "modes": 4}
    with_bubble, without = (
        cx.simulate(bare.replace(source=source, sea=cx.Sea(depth=20.0)), **settings).displacement("outer", angle=0.0)
        for source in (CHARGE, CHARGE.replace(bubble_pulses=0, charge_depth=None))
    )
    np.testing.assert_allclose(with_bubble, without, rtol=0, atol=2e-2 * float(np.abs(without).max()))
