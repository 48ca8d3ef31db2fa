"""The search methods on functions whose optima and fronts are known, through all of an optimisation but the solver."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

import coaxshell as cx
from coaxshell.studies.optimisation.targets import energy

SINGLE = ["cma-es", "differential-evolution"]
EACH = [*SINGLE, "gradient"]
THREE = {
    "absorbers.mass": cx.Range("1 kg", "20 kg"),
    "absorbers.damping": cx.Range(1e4, 1e8, "log"),
    "absorbers.linear_stiffness": cx.Range(1e6, 1e11, "log"),
}


def ring():
    return cx.presets.load("absorbers")


def bowl(system):
    """Smallest, 3, at a mass of 7, a damping of 3e5 and a stiffness of 2e8; narrow and turned."""
    one = system.absorbers
    x = (one.mass - 7.0) / 5.0
    y, z = math.log10(one.damping / 3e5), math.log10(one.linear_stiffness / 2e8)
    return 3.0 + (x + y) ** 2 + 10.0 * (x - y) ** 2 + (z - x) ** 2


@pytest.mark.slow_for("0-gradient")
@pytest.mark.parametrize("method", EACH)
@pytest.mark.parametrize("seed", [0, 3])
def test_the_smallest_value_is_found(analytic, method, seed):
    analytic(inner=bowl)
    found = cx.optimise(ring(), variables=THREE, objectives="inner.peak_stress", method=method, evaluations=700, seed=seed)
    assert_allclose(found.best.objectives[0], 3.0, rtol=1e-5)
    assert_allclose(found.system.absorbers.mass, 7.0, rtol=5e-3)
    assert_allclose(found.system.absorbers.damping, 3e5, rtol=1e-2)
    assert_allclose(found.system.absorbers.linear_stiffness, 2e8, rtol=2e-2)
    assert len(found.history) == 700


@pytest.mark.slow_for("gradient")
@pytest.mark.parametrize("method", EACH)
def test_a_maximum_is_found(analytic, method):
    goal = cx.Objective("inner.peak_stress", maximise=True)
    analytic(inner=lambda system: 10.0 - bowl(system))
    found = cx.optimise(ring(), variables=THREE, objectives=goal, method=method, evaluations=700)
    assert_allclose(found.best.targets["inner.peak_stress"], 7.0, rtol=2e-6)


@pytest.mark.parametrize("method", EACH)
def test_an_active_limit_of_a_run_is_met_from_inside(analytic, method):
    """min x^2 + y^2 where x + y >= 1: 1/2, at x = y = 1/2 (x, y are mass/10 and damping/1e6)."""
    x, y = (lambda s: s.absorbers.mass / 10.0), (lambda s: s.absorbers.damping / 1e6)
    variables = {"absorbers.mass": cx.Range(0.1, 20), "absorbers.damping": cx.Range(1e4, 2e6)}
    analytic(inner=lambda s: x(s) ** 2 + y(s) ** 2, outer=lambda s: x(s) + y(s))
    found = cx.optimise(
        ring(), variables=variables, objectives="inner.peak_stress", constraints="outer.peak_stress >= 1 Pa", method=method, evaluations=700
    )
    assert found.best.feasible
    assert found.best.targets["outer.peak_stress"] >= 1.0
    assert_allclose(found.best.objectives[0], 0.5, rtol=5e-5)


@pytest.mark.slow_for("cma-es")
@pytest.mark.parametrize("method", SINGLE)
def test_an_active_limit_of_the_design_is_met_without_runs_beyond_it(analytic, method):
    """The more mass the better, at most 125 kg/m in 25 absorbers: 5 kg/m each; nothing heavier is run."""
    variables = {"absorbers.mass": cx.Range(1, 20), "absorbers.damping": cx.Range(1e4, 1e6)}
    crew = analytic(inner=lambda s: 30.0 - s.absorbers.mass + (s.absorbers.damping / 1e6) ** 2)
    found = cx.optimise(
        ring(), variables=variables, objectives="inner.peak_stress", constraints="absorbers.mass <= 125 kg", method=method, evaluations=600
    )
    assert_allclose(found.system.absorbers.mass, 5.0, rtol=5e-5)
    assert all(system.absorbers.mass <= 5.0 for system in crew.systems[1:])  # the first one is the baseline
    assert max(one.values[0] for one in found.history) > 5.0


@pytest.mark.parametrize("method", SINGLE)
def test_whole_numbers_and_choices(analytic, method):
    def value(system):
        return (system.absorbers.count - 17) ** 2 + (system.absorbers.mass - 4.0) ** 2 + (0.0 if system.source.decay_time == 2e-4 else 5.0)

    variables = {
        "absorbers.count": cx.Integer(2, 50),
        "absorbers.mass": cx.Range(1, 20),
        "source.decay_time": ["0.1 ms", "0.2 ms", "0.3 ms"],
    }
    analytic(inner=value)
    found = cx.optimise(ring(), variables=variables, objectives="inner.peak_stress", method=method, evaluations=700, seed=2)
    assert found.system.absorbers.count == 17
    assert found.system.source.decay_time == 2e-4
    assert_allclose(found.system.absorbers.mass, 4.0, rtol=1e-5)


def test_one_variable(analytic):
    for method in ("auto", "cma-es"):
        analytic(inner=lambda s: (s.absorbers.mass - 6.0) ** 2 + 1.0)
        found = cx.optimise(
            ring(), variables={"absorbers.mass": (1.0, 20.0)}, objectives="inner.peak_stress", evaluations=4, method=method, population=4
        )
        assert len(found.history) == 4
        found = cx.optimise(
            ring(), variables={"absorbers.mass": cx.Range(1, 20)}, objectives="inner.peak_stress", evaluations=300, method=method
        )
        assert_allclose(found.system.absorbers.mass, 6.0, rtol=5e-5)


@pytest.mark.slow_for("constraints0-0.0")
@pytest.mark.parametrize(("constraints", "low"), [((), 0.0), (("interior.rms_pressure >= 0.5 Pa",), 0.5)])
def test_a_known_front(analytic, constraints, low):
    """Schaffer's f1 = x^2, f2 = (x - 2)^2: the front is 0 <= x <= 2, from x = 1/2 where that is asked."""
    x = lambda s: s.absorbers.mass - 10.0  # noqa: E731
    functions = {"inner": lambda s: x(s) ** 2, "outer": lambda s: (x(s) - 2.0) ** 2 + (s.absorbers.damping / 1e6) ** 2, "interior": x}
    variables = {"absorbers.mass": cx.Range(0, 20), "absorbers.damping": cx.Range(0, 1e6)}
    analytic(**functions)
    found = cx.optimise(
        ring(),
        variables=variables,
        objectives=["inner.peak_stress", "outer.peak_stress"],
        constraints=constraints,
        evaluations=1200,
        population=40,
        seed=1,
    )
    assert found.method == "nsga2"
    front = np.array([one.objectives for one in found.front])
    places = np.sqrt(front[:, 0])
    beyond = front[:, 1] - (places - 2.0) ** 2
    assert beyond.min() >= -1e-12
    assert beyond.max() < 0.1
    assert np.median(beyond) < 5e-3
    assert places.min() >= low
    assert_allclose([places.min(), places.max()], [low, 2.0], atol=0.02)
    assert np.diff(places).max() < 0.2
    assert all(one.feasible for one in found.front)


def test_designs_are_ordered_by_feasibility_first():
    objective = np.array([5.0, -1e9, 1.0, np.nan, 2.0])
    violation = np.array([0.0, 0.2, 0.0, 1e6, 1e-12])
    assert np.argsort(energy(objective, violation)).tolist() == [2, 0, 4, 1, 3]


def test_the_same_seed_is_the_same_search_and_another_is_not(analytic):
    def histories(method, seed, goals):
        analytic(inner=bowl, outer=lambda s: s.absorbers.mass)
        found = cx.optimise(ring(), variables=THREE, objectives=goals, method=method, evaluations=120, seed=seed)
        return found.history

    for method, goals in [*((m, ["inner.peak_stress"]) for m in SINGLE), ("nsga2", ["inner.peak_stress", "outer.peak_stress"])]:
        assert histories(method, 5, goals) == histories(method, 5, goals)
        assert histories(method, 5, goals) != histories(method, 6, goals)


def test_a_robust_objective_is_the_statistic_over_the_same_points(analytic):
    """(m f - 10)^2, f from 0.8 to 1.2 with equal chance: its mean is (m - 10)^2 + m^2 var f, smallest at 10/(1 + var f)."""
    uncertain = {"absorbers.mass": {"uniform": [0.8, 1.2], "relative": True}}
    crew = analytic(inner=lambda s: (s.absorbers.mass - 10.0) ** 2)
    found = cx.optimise(
        ring(),
        variables={"absorbers.mass": cx.Range(5, 15)},
        objectives="mean(inner.peak_stress)",
        uncertain=uncertain,
        samples=64,
        evaluations=100,
    )
    assert_allclose(found.system.absorbers.mass, 10.0 / (1.0 + 0.4**2 / 12.0), rtol=4e-3)
    drawn = np.array([system.absorbers.mass for system in crew.systems]).reshape(-1, 65)
    assert_allclose(drawn[5, 1:] / drawn[5, 0], drawn[60, 1:] / drawn[60, 0], rtol=1e-12)
