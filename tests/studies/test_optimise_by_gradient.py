"""Optimisations by gradients: fewer runs than a search by values alone, repeatable, resumable, within their limits."""

from __future__ import annotations

import pytest

import coaxshell as cx

RING = cx.presets.load("absorbers")
LISTED = RING.replace(absorbers=[one.replace(cubic_stiffness=1e20) for one in RING.absorber_list[::5]])
VARIABLES = {
    "absorbers[*].mass": cx.Range("1 kg", "40 kg", each="mirror"),
    "absorbers[*].damping": cx.Range(1e4, 1e8, "log", each="mirror"),
    "absorbers[*].angle": cx.Range(-180, 180, each="mirror"),
}


def searched(quick, **more):
    arguments = {
        "variables": VARIABLES,
        "objectives": "inner.peak_stress",
        "method": "gradient",
        "evaluations": 24,
        "workers": 1,
        "population": 1,
    }
    return cx.optimise(LISTED, **{**arguments, "constraints": "absorbers.mass <= 50 kg/m", **quick, **more})


@pytest.fixture(scope="module")
def found(quick):
    return searched(quick)


def test_few_evaluations_reach_what_many_by_values_do_not(quick, found):
    by_values = searched(quick, method="cma-es", evaluations=48, population=8)
    assert found.best.feasible
    assert found.best.objectives[0] < by_values.best.objectives[0] < found.baseline.objectives[0]
    assert found.best.targets["absorbers.mass"] <= 50.0
    assert len(found.space.variables) == 8


def test_the_history_is_the_same_again_and_goes_on_from_a_journal(quick, found, tmp_path):
    searched(quick, journal=tmp_path / "kept", evaluations=10)
    again = searched(quick, journal=tmp_path / "kept", resume=True)
    assert [one.values for one in again.history] == [one.values for one in found.history]
    assert [one.targets for one in again.history] == [one.targets for one in found.history]


def test_starts_side_by_side_take_their_steps_together(quick, found):
    together = searched(quick, population=2, evaluations=8)
    assert [one.generation for one in together.history] == [k // 2 for k in range(8)]
    assert [one.values for one in together.history[::2]] == [one.values for one in found.history[:4]]


@pytest.mark.slow
def test_robust_objectives_have_gradients(quick):
    arguments = {"variables": {"absorbers[*].damping": VARIABLES["absorbers[*].damping"]}, "evaluations": 4}
    chance = {"uncertain": {"source.distance": cx.Uniform("4 m", "6 m")}, "samples": 2}
    for objective in ("mean(inner.rms_stress)", "worst(inner.peak_stress)"):
        robust = searched(quick, objectives=objective, **arguments, **chance)
        assert robust.best.objectives[0] < 0.99 * robust.history[0].objectives[0]


def test_absorbers_are_held_apart(quick):
    """All neighbours are as near as they may be to begin with: each of them has a limit of its own."""
    limit = "absorbers.spacing >= 0.62 m"
    held = searched(quick, variables={"absorbers[*].angle": VARIABLES["absorbers[*].angle"]}, constraints=limit, evaluations=8)
    assert held.best.feasible
    assert held.best.objectives[0] < held.baseline.objectives[0]
    assert held.best.targets["absorbers.spacing"] >= 0.62


def test_limits_of_a_run_are_held_by_the_peak_itself(quick):
    limit = 110e3
    held = searched(quick, objectives="absorbers.mass", constraints=f"inner.peak_stress <= {limit} Pa", evaluations=14)
    assert held.best.feasible
    assert held.best.targets["inner.peak_stress"] <= limit
    assert held.best.targets["absorbers.mass"] < held.baseline.targets["absorbers.mass"]


def test_gains_and_layers_are_variables_too(quick):
    variables = {"control.derivative": cx.Range(-100, -1), "shells[0].layers[1].thickness": cx.Range("4 mm", "8 mm")}
    arguments = {"objectives": "inner.rms_stress", "constraints": "outer.actuator_field_ratio <= 0.33", "evaluations": 8, "workers": 1}
    held = cx.optimise(cx.presets.load("hybrid"), variables=variables, method="gradient", population=1, **arguments, **quick)
    assert held.best.feasible
    assert held.best.objectives[0] < held.baseline.objectives[0]
    assert held.best.targets["outer.actuator_field_ratio"] <= 0.33


def test_counts_are_an_outer_loop(quick):
    variables = {"absorbers.count": cx.Integer(3, 5), "absorbers.damping": cx.Range(1e4, 1e8, "log"), "absorbers.mass": cx.Range(1, 40)}
    arguments = {"objectives": "inner.peak_stress", "constraints": "absorbers.mass <= 60 kg/m", "workers": 1}
    found = cx.optimise(RING, variables=variables, method="gradient", evaluations=3 * 6 + 2 * 3, **arguments, **quick)
    counts = [one.values[0] for one in found.history]
    assert counts[:18] == [3, 4, 5] * 6
    better = {n: min(one.objectives[0] for one in found.history[:18] if one.values[0] == n and one.feasible) for n in (3, 4, 5)}
    assert set(counts[18:]) == set(sorted(better, key=lambda n: better[n])[:2])
    assert found.best.feasible
    assert found.best.objectives[0] <= min(better.values())


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"variables": {"absorbers[*].mass": [1.0, 2.0]}}, "method: .*needs a variable that varies continuously"),
        ({"variables": {**VARIABLES, "absorbers[*].linear_stiffness": list(range(1, 7))}}, "method: .*every combination"),
        ({"objectives": "absorbers.dissipated_energy"}, "method: .*dissipated_energy has none"),
        ({"objectives": ["inner.peak_stress", "absorbers.mass"]}, "method"),
        ({"engine": "direct"}, "engine"),
        ({"objectives": "p95(inner.peak_stress)", "uncertain": {"source.distance": cx.Uniform(4, 6)}}, "method: .*mean and worst"),
        ({"uncertain": {"absorbers.mass": cx.Uniform(0.5, 2, relative=True)}}, "method: .*uncertain too"),
    ],
)
def test_what_has_no_gradient_is_refused_before_any_run(quick, changes, told):
    with pytest.raises(cx.InputError, match=told):
        searched(quick, **changes)
