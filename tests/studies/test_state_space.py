"""State-space models against the true transfer functions, LQG against Riccati's own promise, and spill-over counted in two ways."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.io import loadmat

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.numerics.modes import Modes
from coaxshell.numerics.vector_fitting import vector_fit
from coaxshell.solver.plant import Plant
from coaxshell.studies.control_design.state_space import to_state_space, transfer_functions


@pytest.fixture(scope="module")
def model():
    return to_state_space("electrodes", orders=[0, 2], frequency="3 kHz", duration=4.0)


def test_poles_and_residues_of_a_rational_function_are_found():
    s = 0.1 + 1j * np.linspace(0.0, 10.0, 60)
    poles, residues = np.array([-0.5, -0.1 + 3j, -0.3 + 7j]), np.array([[2.0, 1 - 2j, 0.5j], [-1.0, 0.1, 3.0]])
    values = 0.7 + residues @ (1 / (s - poles[:, None])) + residues[:, 1:].conj() @ (1 / (s - poles[1:, None].conj()))
    fit = vector_fit(s, values, 5)
    found = np.argsort(fit.poles.imag)
    np.testing.assert_allclose(fit.poles[found], poles, rtol=1e-8)
    np.testing.assert_allclose(fit.residues[:, found], residues, rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(fit.constant, 0.7, rtol=1e-8)
    np.testing.assert_allclose(fit.at(s), values, rtol=1e-9)


def test_models_meet_the_true_transfer_functions(model):
    time = model.problem.scales.time
    s = np.array([0.25 + 1.7j, 0.25 + 6.1j, 0.25 + 2 * np.pi * 2900 * time * 1j])
    for one in model.orders:
        plant = Plant.of(model.problem, Modes(np.array([float(one.order)])), s)
        true = transfer_functions(plant)[:, :, 0]
        largest = np.abs(one.at(2j * np.pi * np.linspace(1.0, 3000.0, 300))).max(axis=2)
        assert (np.abs(one.at(s / time) - true) < 2e-3 * largest[..., None] + 1e-30).all()
        assert one.error < 1e-3
        assert np.linalg.eigvals(one.a).real.max() < 0.0
    assert model.inputs == ("inner actuator", "outer actuator", "pressure outside")


def test_other_forms(model, tmp_path):
    assert model[2].scipy.A.shape == model[2].a.shape
    found = loadmat(model.save(tmp_path / "plant.mat"), simplify_cells=True)
    np.testing.assert_array_equal(found["orders"][1]["A"], model[2].a)
    assert "largest error" in str(model)


def test_what_a_model_leaves_out_is_driven(model):
    # The controller of a model to 3 kHz in the model to 9 kHz has as many growing eigenvalues as the count of the true loop.
    whole = to_state_space("electrodes", orders=[0], frequency="9 kHz", duration=4.0)[0]
    weak, strong = (model.lqg(effort=effort).controllers[0] for effort in (0.3, 0.02))
    assert (weak.modelled, weak.unstable, strong.modelled) == (0, 0, 0)
    assert weak.gain_margin > 1.5
    for one in (weak, strong):
        read, push = whole.c[:2], whole.b[:, :2]
        driven = np.block([[whole.a, push @ one.c], [one.b @ read, one.a + one.b @ whole.d[:2, :2] @ one.c]])
        growing = np.linalg.eigvals(driven).real > 0.25 / cx.presets.load("electrodes").transit_time
        assert growing.sum() == one.unstable
    assert strong.unstable > 0
    assert not model.lqg(effort=0.02).stable


@pytest.mark.parametrize(
    ("keywords", "where"),
    [
        ({"frequency": -1.0}, "frequency"),
        ({"orders": []}, "orders"),
        ({"orders": [-1]}, "orders"),
        ({"error": 2.0}, "error"),
    ],
)
def test_what_is_refused(keywords, where):
    with pytest.raises(InputError) as caught:
        to_state_space("electrodes", **{"frequency": 1e3, "orders": [0], **keywords})
    assert caught.value.where == where


def test_gains_are_refused(model):
    with pytest.raises(InputError, match="above 0"):
        model.lqg(effort=0.0)
    with pytest.raises(InputError, match="not fitted"):
        model[7]
