"""Runs with losses: energy, stresses, causality, marches, files, and what a loss factor takes off the peaks."""

from __future__ import annotations

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.modal import amplitudes, stress_gain_of

BARE = cx.presets.load("bare")
RUBBER = cx.Viscoelastic(density=1100, long_term_modulus="50 MPa", poisson_ratio=0.48, prony=[("200 MPa", "1e-4 s"), ("30 MPa", "2 ms")])
RUN = {"duration": 3.0, "time_step": 4e-3, "modes": 10}
ALONG = {"duration": 1.2, "time_step": 1e-2, "modes": 6, "dimensions": 3, "stations": [0.0, 0.3]}


def with_losses(eta, system=BARE, layers=(), **options):
    """Return the paper's shells with losses in all layers, and further layers on the outside of the outer one."""
    shells = [
        shell.replace(layers=[layer.replace(material=layer.material.replace(loss_factor=eta, **options)) for layer in shell.layers])
        for shell in system.shells
    ]
    shells[-1] = shells[-1].replace(layers=[*shells[-1].layers, *layers])
    return system.replace(shells=shells)


@pytest.fixture(scope="module")
def coated():
    """Return a run of shells with losses and a rubber coating."""
    return cx.simulate(with_losses(0.1, layers=[cx.Layer(RUBBER, "8 mm")]), **RUN)


@pytest.mark.slow_for("constant-q")
@pytest.mark.parametrize("loss_model", ["prony", "constant-q"])
def test_energy_closes_with_what_the_walls_dissipate(coated, loss_model):
    response = coated if loss_model == "prony" else cx.simulate(with_losses(0.1, loss_model=loss_model), **RUN)
    energy = response.energy(every=25)
    assert float(np.abs(energy["closure_relative"]).max()) < 1e-5
    for name in ("inner", "outer"):
        lost = energy[f"{name}_dissipation"]
        assert lost.attrs["role"] == "loss"
        assert float(lost[-1]) > 0.01 * float(np.abs(energy["exterior_work"]).max())
        assert np.all(np.diff(lost) > -1e-9 * float(lost[-1]))


@pytest.mark.slow
def test_energy_closes_over_the_whole_length():
    energy = cx.simulate(with_losses(0.1, layers=[cx.Layer(RUBBER, "8 mm")]), **ALONG).energy(every=40)
    assert float(np.abs(energy["closure_relative"]).max()) < 1e-5
    assert float(energy["outer_dissipation"][-1]) > 0.01 * float(np.abs(energy["exterior_work"]).max())


def test_stress_is_the_relaxed_modulus_on_the_strain(coated):
    # On the transforms of the run itself; histories stop at its end, and with them what later fronts ring before their time: 1.6e-6 here.
    solution, spectra = coated.solution, coated.motion.spectra
    for shell, depth in ((0, None), (1, None), (1, 0.0135)):
        parts, expected = stress_gain_of(solution, shell, depth).parts, 0.0
        for factor, gain in parts:
            g = 1.0 if factor is None else factor.at(spectra.grid.nodes)
            strain = gain.w[:, None] * spectra.normal[shell] + gain.v[:, None] * spectra.tangential[shell]
            expected = expected + spectra.grid.invert(g * strain)
        found = amplitudes(solution, shell, stress_gain_of(solution, shell, depth))
        np.testing.assert_allclose(found, expected, rtol=0, atol=3e-6 * np.abs(expected).max())
        elastic = sum(gain.w[:, None] * solution.normal[shell] + gain.v[:, None] * solution.tangential[shell] for _, gain in parts)
        assert np.abs(found - elastic).max() > 0.01 * np.abs(expected).max()


def test_stations_know_the_losses():
    # A line source is uniform along the axis: the same shells in two dimensions and at a station.
    system = with_losses(0.2).replace(source=cx.LineShock(distance=5.0, peak_pressure=2.5e4, decay_time="0.2 ms"))
    settings = {"duration": 1.5, "time_step": 5e-3, "modes": 6}
    plane, station = cx.simulate(system, **settings), cx.simulate(system, dimensions=3, **settings)
    for depth in (None, "outer"):
        expected, found = plane.stress("outer", 30.0, depth), station.stress("outer", 30.0, depth, station=0.0)
        np.testing.assert_allclose(np.squeeze(found), np.squeeze(expected), rtol=0, atol=2e-5 * float(np.abs(expected).max()))


def test_small_losses_tend_to_none():
    elastic = np.asarray(cx.simulate(BARE, **RUN).stress("outer"))
    changes = [np.abs(np.asarray(cx.simulate(with_losses(eta), **RUN).stress("outer")) - elastic).max() for eta in (1e-3, 1e-4)]
    assert changes[0] < 0.01 * np.abs(elastic).max()
    assert changes[0] / changes[1] == pytest.approx(10.0, rel=0.05)


@pytest.mark.parametrize("loss_model", ["prony", "constant-q"])
def test_nothing_comes_before_the_front(loss_model):
    # A smooth pulse; a membrane wave of the wall at its stiffest, and the gap, are the fastest way to the tail of the inner shell.
    smooth = cx.PlaneWave(pulse=cx.Gaussian(peak_pressure=2.5e4, width="40 us", centre="0.3 ms"))
    response = cx.simulate(with_losses(0.3, loss_model=loss_model).replace(source=smooth), duration=3.0, time_step=4e-3, modes=12)
    tail = np.abs(np.asarray(response.stress("inner", 180.0)).ravel())
    fastest = max(wall.stiffest.membrane / wall.mass for wall in response.solution.problem.shells) ** 0.5
    earliest = (0.3e-3 - 6 * 40e-6) / response.solution.problem.scales.time + 0.25 * np.pi / fastest
    assert tail[response.time < earliest].max() < 1e-4 * tail.max()


def test_a_nonlinear_absorber_marches_on_walls_with_losses():
    one = cx.Absorber(angle=0, mass=10, damping=1e5, linear_stiffness=1e9, cubic_stiffness=1e21)
    system = with_losses(0.1, BARE.replace(absorbers=[one]))
    coarse, fine = (cx.simulate(system, duration=1.5, time_step=step, modes=8) for step in (8e-3, 4e-3))
    x, y = (np.asarray(run.displacement("outer", 0.0)) for run in (coarse, fine))
    assert np.abs(x - y[::2]).max() < 5e-3 * np.abs(y).max()
    assert float(np.abs(fine.energy(every=25)["closure_relative"]).max()) < 1e-4


def test_feedback_on_walls_with_losses():
    system = with_losses(0.05, BARE.replace(control=cx.PDControl(proportional=-2e4, derivative=-150)))
    response = cx.simulate(system, duration=1.5, time_step=5e-3, modes=8)
    assert float(np.abs(response.energy(every=25)["closure_relative"]).max()) < 1e-5
    with pytest.raises(cx.InputError, match="unstable"):
        cx.simulate(system.replace(control=cx.PDControl(proportional=2e6, derivative=0)), duration=1.5, time_step=5e-3, modes=8)


def test_files_hold_them(coated, tmp_path):
    again = cx.load_response(coated.save(tmp_path / "run.nc"))
    np.testing.assert_array_equal(again.stress("outer"), coated.stress("outer"))
    thinned = coated.thin(3)
    with pytest.raises(cx.InputError, match="losses"):
        thinned.stress("outer")
    assert thinned.summary().shells[0].stress is None
    assert "inner" in str(thinned.summary())


def test_a_loss_factor_of_a_tenth_takes_15_to_30_percent_off_the_peaks():
    # theory-beyond, section 11, on its bare case; the orders that count are the lower ones.
    largest = [cx.simulate(with_losses(eta), duration=4.0, time_step=4e-3, modes=24).summary().shells for eta in (0.0, 0.1)]
    for plain, lossy in zip(*largest, strict=True):
        for where in ("stress_head", "stress_tail"):
            assert 0.14 < 1.0 - getattr(lossy, where).value / getattr(plain, where).value < 0.33
