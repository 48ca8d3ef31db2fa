"""Which natural modes carry a peak: what rings late is the sum of the modes, a shell alone is one oscillator an order, the rest is told."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx

LONG = {"duration": 5.0, "time_step": 0.02, "modes": 4}
STEEL = cx.Elastic(name="steel", density=7800, youngs_modulus=210e9, poisson_ratio=0.3)


def late_rest(found, order):
    """Return the largest of what no mode carries over the last fifth of a run, over that of the whole order."""
    whole = found["order_history"].sel(order=order).to_numpy()
    rest = whole - np.nansum(found["history"].sel(order=order).to_numpy(), axis=0)
    late = slice(4 * whole.size // 5, None)
    return np.abs(rest[late]).max() / np.abs(whole[late]).max()


@pytest.fixture(scope="module")
def bare():
    return cx.simulate("bare", **LONG)


def test_late_histories_are_sums_of_modes(bare):
    found = bare.participation("inner", "stress", order=3, up_to="13 kHz")
    assert late_rest(found, 3) < 0.03
    assert float(abs(found["rest_share"][0])) < 0.01


def test_what_absorbers_exert_counts_as_load():
    """Marched, with feedback: absorbers pull to the end, and the modes of what is left ring under them."""
    response = cx.simulate("hybrid", **LONG)
    found = response.participation("inner", "stress", order=3, up_to="13 kHz")
    assert late_rest(found, 3) < 0.03


def test_a_shell_alone_is_one_oscillator_of_order_0_and_two_of_others():
    nothing = cx.Fluid(density=1e-3, sound_speed=1400)
    shell = cx.Shell(radius=1.0, layers=[cx.Layer(STEEL.replace(loss_factor=0.02), 0.02)])
    source = cx.PlaneShock(peak_pressure=1.0, decay_time=3e-4)
    alone = cx.System(shells=[shell], fluids=[cx.VACUUM, nothing], source=source)
    response = cx.simulate(alone, duration=4.0, time_step=0.02, modes=2)
    for quantity in ("stress", "shell_velocity"):
        found = response.participation("shell", quantity, angle=0.0, order=[0, 2])
        counts = np.isfinite(found["frequency"].to_numpy()).sum(axis=1).tolist()
        assert counts == [1, 2]
        for order in (0, 2):
            whole = found["order_history"].sel(order=order).to_numpy()
            modes = np.nansum(found["history"].sel(order=order).to_numpy(), axis=0)
            assert np.abs(modes - whole).max() < 0.02 * np.abs(whole).max(), (quantity, order)


def test_shares_add_up_to_the_value_of_the_history(bare):
    found = bare.participation("outer", "displacement", angle=90.0, time=2.0, up_to="2 kHz")
    history = bare.displacement("outer", [90.0]).sel(time=2.0, method="nearest")
    assert found.attrs["value"] == pytest.approx(float(history[0]), rel=1e-9)
    orders = found["order_contribution"].to_numpy()
    modes = found["contribution"].sum("mode").to_numpy() + found["rest_share"].to_numpy() * found.attrs["value"]
    np.testing.assert_allclose(modes, orders, rtol=1e-9, atol=1e-12 * abs(found.attrs["value"]))
    assert found["order_share"].sum() + found.attrs["other_orders"] == pytest.approx(1.0)


def test_the_peak_is_the_largest_of_the_summary(bare):
    found = bare.participation("inner", order=0, up_to="1 kHz")
    peak = bare.summary().shells[0].stress
    assert (abs(found.attrs["value"]), found.attrs["angle"]) == pytest.approx((peak.value, peak.angle))


def test_what_is_refused(bare):
    for options, words in (
        ({"quantity": "von_mises_stress"}, "quantity: "),
        ({"time": 9.0}, "time: 9.0 is not within the run"),
        ({"order": 99}, "order: 99 is above the run's 4"),
        ({"up_to": "0 Hz"}, "up_to: 0 Hz is not allowed"),
        ({"quantity": "actuator_voltage"}, "quantity: "),
    ):
        with pytest.raises(cx.InputError, match=words):
            bare.participation("inner", **options)
    space = cx.simulate("bare", duration=0.5, time_step=0.05, modes=2, dimensions=3)
    with pytest.raises(cx.InputError, match="participation: is told in two dimensions"):
        space.participation("inner")
    shells = bare.system.shells
    solid = cx.simulate(bare.system.replace(shells=[shells[0].replace(theory="elastic"), shells[1]]), duration=0.5, time_step=0.05, modes=2)
    with pytest.raises(cx.InputError, match=r"shells\[0\].theory: participation is told of thin walls"):
        solid.participation("outer")
