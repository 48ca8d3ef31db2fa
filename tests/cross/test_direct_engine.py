"""The direct engine against the spectral one: two solution paths that share the model and the fluids' operators only."""

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.checks import engines

CASES = engines.configurations()


@pytest.mark.slow_for("saturated control", "unequal absorbers off the axis", "hybrid", "massless absorbers")
@pytest.mark.parametrize("name", CASES)
def test_direct_converges_to_spectral(name: str) -> None:
    rows = list(engines.judged(name, engines.errors(Bench(), CASES[name])))
    assert len(rows) == 4
    assert [row.cells for row in rows if row.verdict != "pass"] == []


def test_absorber_histories_agree() -> None:
    system = CASES["unequal absorbers off the axis"]
    direct, spectral = (cx.simulate(system, time_step=1e-3, engine=engine, **engines.SETTINGS) for engine in ("direct", "spectral"))
    for name, limit in (("absorber_force", 4e-3), ("absorber_displacement", 1.5e-3)):
        found, expected = (getattr(response, name)().values for response in (direct, spectral))
        assert np.linalg.norm(found - expected) / np.linalg.norm(expected) < limit


@pytest.mark.parametrize(
    ("changes", "settings", "named"),
    [
        ({}, {"modes": 400, "time_step": 2e-3}, "vibrates at up to"),
        ({"absorbers": cx.absorber_ring(3, mass=10, linear_stiffness=1e13)}, {"modes": 20, "time_step": 2e-3}, "stiffest absorber"),
    ],
)
def test_unstable_step_is_refused(changes: dict, settings: dict, named: str) -> None:
    with pytest.raises(cx.InputError, match=named) as caught:
        cx.simulate(cx.presets.load("bare").replace(**changes), engine="direct", duration=1.0, **settings)
    assert "time_step" in str(caught.value)
    assert "\n" not in str(caught.value)
