"""The springs' energy of a run with stiff cubic springs, by hand from the motion in SI, and the balance that it must close."""

from __future__ import annotations

import numpy as np

import coaxshell as cx

LINEAR, CUBIC = 2e7, 1e20


def test_springs_by_hand_and_in_the_balance() -> None:
    absorbers = [cx.Absorber(angle=angle, mass=5, damping=0, linear_stiffness=LINEAR, cubic_stiffness=CUBIC) for angle in (0, 60, -60)]
    system = cx.presets.load("bare").replace(absorbers=absorbers)
    response = cx.simulate(system, duration=2.0, time_step=4e-3, modes=12)
    every = 10
    balance = response.energy(every=every)
    q = response.absorber_displacement().values
    stretch = np.stack([q - response.displacement(shell, angle=[0, 60, -60]).values.T for shell in ("inner", "outer")])
    linear, cubic = LINEAR * stretch**2 / 2, CUBIC * stretch**4 / 4
    expected = (linear + cubic).sum(axis=(0, 1))[::every]
    found = balance["absorber_spring"].values
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-12 * expected.max())
    assert cubic.sum() > linear.sum()
    assert found.max() > 20.0 * np.abs(balance["closure_residual"]).max()
