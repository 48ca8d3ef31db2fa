"""What actuators that saturate give the orders left out, and what those change: means over a normal distribution, harmonics."""

from __future__ import annotations

import numpy as np
import pytest

from coaxshell.solver.interface.saturation import circle
from coaxshell.solver.limited_orders import LimitedActuator, limited_means


@pytest.mark.parametrize("deviation", [1e-3, 0.3, 2.0, 30.0])
def test_means_are_those_of_many_draws(deviation: float) -> None:
    a, mean, work, spread = limited_means(3.0, deviation)
    normal = np.random.default_rng(0).normal(size=400_000)
    for i in (0, 60, 85, 200):
        x = a[i] + deviation * normal
        cut, free = np.clip(x, -1.0, 1.0), float(np.mean(np.abs(x) < 1.0))
        assert mean[i] == pytest.approx(float(cut.mean()), abs=0.01)
        assert work[i] == pytest.approx(float((cut * x).mean()), rel=0.02, abs=0.01)
        assert spread[i] == pytest.approx(float(cut.var() - (free * deviation) ** 2), abs=0.01)


@pytest.mark.parametrize("parities", [1, 2])
def test_without_further_pressures_the_run_itself_is_cut(parities: int) -> None:
    asked = np.zeros((parities, 6, 4))
    asked[-1, 3] = [0.0, 1.0, 5.0, -20.0]
    limit, orders = 2.0, np.array([6.0, 9.0, 15.0])
    found = LimitedActuator.of(0, limit, asked, orders, 0.0)
    evaluate, _ = circle(41, parities)
    wide = np.zeros((parities, 41, 4))
    wide[:, :6] = asked
    volts = evaluate @ wide.reshape(-1, 4)
    given = (circle(41, parities)[1] @ np.clip(volts, -limit, limit)).reshape(parities, 41, 4)
    np.testing.assert_allclose(found.above, given[:, orders.astype(int)], rtol=0, atol=2e-3 * limit)
    np.testing.assert_allclose(found.kept, 0.0, rtol=0, atol=1e-4 * limit)
    assert found.spread.max() < 1e-3
    assert found.gain == pytest.approx(float((np.clip(volts, -limit, limit) * volts).sum() / (volts**2).sum()), rel=1e-2)
