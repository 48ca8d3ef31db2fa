"""The claims: every one gives finite numbers and a verdict, and the verdicts turn when the runs say otherwise."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from coaxshell.apps.paper.claims import claims, judge
from coaxshell.apps.paper.claims.systems import preset
from coaxshell.apps.paper.known_runs import CORRECTED, Runs, packed, unpacked
from coaxshell.errors import InputError
from coaxshell.solver.settings import Settings
from coaxshell.studies.store import Store

SMALL = Settings(duration=2.5, time_step=1e-2, modes=16)
BY_NAME = {claim.name: claim for claim in claims()}


def found(name, runs):
    return judge(BY_NAME[name], {CORRECTED: runs}).corrected


def test_there_are_many_claims_with_names_places_and_criteria():
    assert len(BY_NAME) == len(claims()) >= 45
    assert [claim.number for claim in claims()] == list(range(1, len(BY_NAME) + 1))
    for claim in claims():
        assert claim.place
        assert claim.statement.endswith(".")
        assert claim.criterion


@pytest.mark.slow_for(
    "more-absorbers-lower-the-rms",
    "more-absorbers-stop-helping",
    "three-degrees-matter",
    "outer-shell-barely-weakens-the-wave",
    "inner-fields-differ-most-at-1",
)
@pytest.mark.parametrize("name", BY_NAME)
def test_a_claim_gives_finite_numbers_a_verdict_and_a_reason(runs, name):
    finding = found(name, runs)
    assert finding.verdict in ("holds", "holds in part", "does not hold")
    assert finding.measured
    assert all(math.isfinite(value) for value in finding.measured.values())
    assert finding.why.endswith(".")


def with_shell(run, shell, **changes):
    return replace(run, shells={**run.shells, shell: replace(run.shells[shell], **changes)})


def test_the_peak_at_the_head_turns_the_claim_about_the_tail(runs, changed):
    def swap(name, run):
        inner = run.shells["inner"]
        return with_shell(run, "inner", stress_head=inner.stress_tail, stress_tail=inner.stress_head)

    assert found("tail-bears-the-peak", runs).verdict == "holds"
    assert found("tail-bears-the-peak", changed(swap)).verdict == "holds in part"


def test_an_effect_of_a_soft_link_turns_the_claim_that_there_is_none(runs, changed, scaled):
    finding = found("soft-link-has-no-effect", changed(lambda name, run: run if name == "bare" else scaled(run, 1.2)))
    assert finding.verdict == "does not hold"
    assert min(finding.measured.values()) > 15.0


def test_a_fifth_less_stress_makes_the_claim_about_25_hold(runs, changed):
    bare = runs(preset("bare")).shells["inner"]

    def lowered(name, run):
        stress = replace(bare.stress, value=0.8 * bare.stress.value)
        return with_shell(run, "inner", stress=stress, stress_rms=0.8 * bare.stress_rms) if name == "25" else run

    finding = found("twenty-per-cent-at-25", changed(lowered))
    assert finding.verdict == "holds"
    np.testing.assert_allclose(list(finding.measured.values()), 20.0, rtol=1e-12)


def test_voltages_within_the_limit_make_the_claim_hold(runs, changed):
    def weak(name, run):
        for shell, summary in run.shells.items():
            if summary.actuator_voltage:
                run = with_shell(run, shell, actuator_voltage=replace(summary.actuator_voltage, value=100.0))
        return run

    assert found("voltage-is-within-the-limit", runs).verdict == "does not hold"
    assert found("voltage-is-within-the-limit", changed(weak)).verdict == "holds"


def test_a_stronger_outer_shell_turns_the_claim_about_the_inner_one(runs, changed, scaled):
    assert found("inner-shell-is-stressed-more", changed(lambda name, run: scaled(run, 2.0, "outer"))).verdict == "does not hold"


def test_a_late_start_turns_the_claim_about_arrival(runs, changed):
    late = changed(lambda name, run: replace(run, time=run.time + 0.3))
    assert found("inner-head-begins-at-0-5", late).verdict == "does not hold"


def test_runs_are_solved_once_and_read_back_alike(tmp_path):
    from coaxshell.studies import solve_each

    solved = []

    def solver(systems, resolution, progress):
        solved.extend(systems)
        return solve_each(systems, resolution, progress)

    first = Runs(SMALL, solver=solver, store=Store(tmp_path))
    systems = {"bare": preset("bare"), "absorbers": preset("absorbers")}
    peaks = dict(first.each(systems, peaks_only=True))
    assert not peaks["bare"].histories
    whole = dict(first.each(systems))
    assert whole["bare"].histories
    for name, run in whole.items():  # the same numbers, those of the stress alone
        for shell, stress in peaks[name].shells.items():
            assert vars(stress).items() <= vars(run.shells[shell]).items()
        assert not peaks[name].summaries
    kept = dict(Runs(SMALL, solver=solver, store=Store(tmp_path / "peaks")).each({"bare": preset("bare")}, peaks_only=True))
    stored = Runs(SMALL, solver=solver, store=Store(tmp_path / "peaks"))
    assert next(stored.each({"bare": preset("bare")}, peaks_only=True))[1].shells == kept["bare"].shells
    again = dict(Runs(SMALL, solver=solver, store=Store(tmp_path)).each(systems))
    assert solved == [*systems, *systems, "bare"]
    for name, run in whole.items():
        assert again[name].shells == run.shells
        assert again[name].warnings == run.warnings
        for kept in (unpacked(*packed(run)), again[name]):
            np.testing.assert_array_equal(kept.absorber, run.absorber)
            assert kept.histories.keys() == run.histories.keys()
            for key, values in run.histories.items():
                np.testing.assert_array_equal(kept.histories[key], values)
    Runs(replace(SMALL, modes=8), solver=solver, store=Store(tmp_path))(preset("bare"))
    assert len(solved) == 6


@pytest.mark.slow
def test_runs_on_several_processes_are_those_in_turn(monkeypatch):
    from coaxshell.apps.paper import cases, known_runs

    monkeypatch.setattr(known_runs, "FEWEST", 4)
    systems, told = cases.count(preset("bare"), (0, 1, 2, 3, 5)), []
    shared = dict(Runs(SMALL, workers=2).each(systems, lambda fraction, stage: told.append(fraction), peaks_only=True))
    assert list(shared) == list(systems)
    assert told[-1] == 1.0
    for name, run in Runs(SMALL).each(systems, peaks_only=True):
        assert (shared[name].shells, shared[name].warnings) == (run.shells, run.warnings)


def test_a_run_that_fails_in_another_process_says_what_is_wrong(monkeypatch):
    from coaxshell.apps.paper import known_runs

    monkeypatch.setattr(known_runs, "FEWEST", 2)
    systems = {str(n): preset("absorbers").with_overrides({"absorbers.count": n}) for n in (3, 4)}
    with pytest.raises(InputError, match=r"^time_step: ") as caught:
        list(Runs(replace(SMALL, time_step=-1.0), workers=2).each(systems))
    assert caught.value.remedy


def test_a_broken_piece_counts_as_absent(tmp_path):
    store = Store(tmp_path)
    store.put("a", {"x": np.arange(3.0)}, {"y": 1})
    arrays, values = store.get("a")
    assert values == {"y": 1}
    np.testing.assert_array_equal(arrays["x"], np.arange(3.0))
    (tmp_path / "a.npz").write_bytes(b"PK\x03\x04 cut off")
    assert store.get("a") is None
    assert store.get("b") is None
    assert not list(tmp_path.glob(".*"))
