"""The factor g(s) of a modulus with losses: fits, the power law, rubbers, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.laplace_grid import LaplaceGrid
from coaxshell.structure.constituents import constituents
from coaxshell.structure.losses import Band, arm_count, constant_q, prony_fit, relaxing_sum

BAND = Band(1.0, 10.0**3.5)
RUBBER = cx.Viscoelastic(density=1100, long_term_modulus="5 MPa", poisson_ratio=0.49, prony=[("20 MPa", "1e-4 s"), ("3 MPa", "2 ms")])


def loss_factor(g: np.ndarray) -> np.ndarray:
    return g.imag / g.real


def along(band: Band, count: int = 1000) -> np.ndarray:
    return 1j * np.geomspace(*band, count)


def test_six_arms_over_three_and_a_half_decades_keep_a_tenth_within_four_percent():
    fit = prony_fit(0.1, 30.0, BAND, 6)
    assert len(fit.times) == 6
    eta = loss_factor(fit.at(along(BAND)))
    assert 0.096 <= eta.min() < 0.0965
    assert 0.1035 < eta.max() <= 0.104


@pytest.mark.parametrize(("wanted", "least", "most"), [(1e-3, 0.98, 1.02), (0.1, 0.98, 1.02), (0.3, 0.95, 1.05), (1.0, 0.95, 1.05)])
def test_the_usual_number_of_arms_keeps_the_loss_factor(wanted, least, most):
    fit = prony_fit(wanted, 30.0, BAND)
    eta = loss_factor(fit.at(along(BAND))) / wanted
    assert least < eta.min() < eta.max() < most
    assert arm_count(BAND) == 7
    assert min(fit.strengths) > 0
    assert abs(fit.at(np.array([30j]))[0]) == pytest.approx(1.0, rel=1e-12)
    assert fit.at_rest < abs(fit.at(np.array([BAND.low * 1j]))[0]) < 1.0 < fit.stiffest


def test_bands_of_similar_steps_are_one():
    assert Band.of(4.0, 2e-3) == Band.of(4.5, 1.8e-3) == pytest.approx((10**-0.5, 10**3.5))
    assert BAND.with_frequency(0.01) == (0.01, BAND.high)


def test_kjartansson_by_the_closed_forms():
    # theory-beyond, section 18, number 9.
    law = constant_q(0.1, 1.0, BAND)
    assert law.exponent / 2 == pytest.approx(0.03172551743, rel=1e-9)
    np.testing.assert_allclose(law.at(np.array([10j])), 1.151570015 + 0.1151570015j, rtol=1e-9)
    pole = np.array([-0.05144442955 + 0.9986758587j])
    np.testing.assert_allclose(pole**2 + law.at(pole), 0.0, atol=1e-9)


def test_a_breathing_ring_of_constant_q_answers_an_impulse_by_the_closed_form():
    # The impulse is spread over a few thousandths of a period: its transform times exp(-(s/400)^2) and back in time.
    law, grid = constant_q(0.1, 1.0, BAND), LaplaceGrid(1e-2, 2000)
    answer = grid.invert(1.0 / (grid.nodes**2 + law.at(grid.nodes)), np.ones(grid.nodes.size))
    np.testing.assert_allclose(answer[[100, 500, 2000]], [0.8296565626, -0.7645238651, 0.3281566592], atol=1e-5)


@pytest.mark.parametrize("wanted", [0.02, 0.1, 0.5])
def test_arms_stand_for_constant_q(wanted):
    law = constant_q(wanted, 30.0, BAND)
    s = along(BAND) + 0.2
    np.testing.assert_allclose(law.series.at(s), law.at(s), rtol=3e-6)
    assert law.stiffest == pytest.approx(abs(law.at(np.array([1j * BAND.high]))[0]))


def test_the_modulus_of_constant_q_grows_as_the_theory_says():
    growth = [abs(constant_q(eta, 1.0, BAND).at(np.array([3142j]))[0]) for eta in (0.02, 0.1, 0.5)]
    np.testing.assert_allclose(growth, [1.11, 1.67, 10.8], rtol=5e-3)


def test_one_over_a_prony_series_is_one():
    strengths, times, s = np.array([1.0, 5.0, 0.2]), np.array([1e-3, 0.1, 7.0]), np.array([0.3 + 2j, 40j, 1e4])
    whole = 2.0 + 3.0 + sum(x * s * t / (1 + s * t) for x, t in zip(strengths, times, strict=True))
    found = relaxing_sum(2.0, 3.0, strengths, times)
    np.testing.assert_allclose(found.at(s), -1.0 / whole, rtol=1e-12)
    assert min(found.strengths) > 0
    assert min(found.times) > 0


def test_a_rubber_relaxes_in_shear_alone():
    # Free of radial stress, by a 2 x 2 with G(s) and a bulk modulus that stays, at each s.
    shell = cx.Shell(radius=1.0, layers=[cx.Layer(RUBBER, 0.01, "core")])
    s, transit = np.array([0.4 + 2j, 5j, 300.0]), 7e-4
    parts = constituents(shell, transit, BAND)
    q11, q12, q22, q66 = (sum(part.factor.at(s) * part.stiffness[i] for part in parts) for i in range(4))
    shear = RUBBER.long_term_modulus + sum(e * s * t / transit / (1 + s * t / transit) for e, t in RUBBER.prony)
    shear = shear / (2 * 1.49)
    bulk, lame = 5e6 / (3 * 0.02), 5e6 / (3 * 0.02) - 2 * shear / 3
    np.testing.assert_allclose(q66, shear, rtol=1e-12)
    np.testing.assert_allclose(q11, lame + 2 * shear - lame**2 / (lame + 2 * shear), rtol=1e-10)
    np.testing.assert_allclose(q12, lame - lame**2 / (lame + 2 * shear), rtol=1e-8)
    np.testing.assert_allclose(q22, q11, rtol=1e-14)
    assert bulk == pytest.approx((lame + 2 * shear / 3)[0])
    for part in parts:
        assert min(part.factor.strengths) > 0
        assert part.factor.at(np.array([0.0]))[0] == pytest.approx(1.0)


def test_losses_that_change_nothing_are_not_written():
    plain, lossy = cx.materials.get("steel"), cx.materials.get("steel").replace(loss_factor=0.01)
    assert "loss_factor" not in plain.model_dump()
    assert "loss_factor" not in plain.replace(loss_model="constant-q").model_dump()
    assert lossy.model_dump()["loss_factor"] == 0.01
    bare = cx.presets.load("bare")
    layers = [cx.Layer(lossy, "10 mm"), cx.Layer(RUBBER, "10 mm")]
    system = bare.replace(shells=[shell.replace(layers=layers) for shell in bare.shells])
    assert cx.System.from_toml_string(system.to_toml_string()) == system
    assert "loss_factor" not in bare.to_toml_string()


@pytest.mark.parametrize(
    ("wrong", "where"),
    [
        ({"loss_factor": 1.5}, "loss_factor"),
        ({"loss_factor": -0.1}, "loss_factor"),
        ({"loss_model": "hysteretic"}, "loss_model"),
        ({"reference_frequency": "0 Hz"}, "reference_frequency"),
        ({"reference_frequency": "1 s"}, "reference_frequency"),
    ],
)
def test_bad_losses_are_named(wrong, where):
    with pytest.raises(cx.InputError) as told:
        cx.materials.get("steel").replace(**wrong)
    assert told.value.where == where


@pytest.mark.parametrize("prony", [[], [("20 MPa", "0 s")], [("20 s", "1 ms")], [(1e6,)], [(1e6, 1e-3)] * 51])
def test_bad_arms_are_named(prony):
    with pytest.raises(cx.InputError) as told:
        RUBBER.replace(prony=prony)
    assert told.value.where.startswith("prony")
