"""An outcome depends on its case alone; structures are prepared once; failures carry reasons."""

from __future__ import annotations

import pickle
import sys
from types import ModuleType

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.errors import InputError
from coaxshell.response.storage import info
from coaxshell.studies import structures
from coaxshell.studies.evaluation import Case, batches, evaluate, forget
from coaxshell.studies.executors import WorkerDiedError, completed
from coaxshell.studies.metrics import metrics_of
from coaxshell.studies.store import Store, StudyStore
from coaxshell.studies.user_functions import UserFunction
from coaxshell.studies.varied_fields import varied

ASKED = ["inner.peak_stress", "outer.rms_stress", "absorbers.peak_force"]


@pytest.fixture
def cases(hybrid):
    systems = [varied(hybrid, {"absorbers.count": n, "source.peak_pressure": p}) for n in (0, 3, 7) for p in (1e4, 2e4)]
    return [Case(i, system) for i, system in enumerate(systems)]


def outcomes(batch_list):
    return {case.number: outcome for batch in batch_list for case, outcome in zip(batch.cases, evaluate(batch), strict=True)}


def test_grouping_changes_nothing_and_prepares_each_structure_once(hybrid, cases, resolution, monkeypatch):
    metrics = metrics_of(ASKED, hybrid)
    prepared = []
    make = structures.Structures._made

    def counted(self, *arguments):
        prepared.append(arguments)
        return make(self, *arguments)

    monkeypatch.setattr(structures.Structures, "_made", counted)
    forget()
    together = outcomes(batches(cases, metrics, resolution, 1))
    assert len(prepared) == 2  # the two sources
    for case in reversed(cases):
        forget()
        alone = outcomes(batches([case], metrics, resolution, 1))
        assert alone[case.number].values == together[case.number].values
        response = cx.simulate(case.system, **resolution.arguments())
        np.testing.assert_allclose(together[case.number].values[0], response.summary().shells[0].stress.value, rtol=1e-9)


def test_a_batch_pickles(hybrid, cases, resolution):
    batch = batches(cases, metrics_of(ASKED, hybrid), resolution, 1)[0]
    copy = pickle.loads(pickle.dumps(batch))
    assert copy == batch
    assert [o.values for o in evaluate(copy)] == [o.values for o in evaluate(batch)]


def test_a_search_is_not_told_warnings_nor_estimates(hybrid, resolution, monkeypatch):
    import importlib

    solve = importlib.import_module("coaxshell.solver.solve")  # the package has a function of that name
    judged, original = [], solve.judgement
    monkeypatch.setattr(solve, "judgement", lambda *given, **named: judged.append(1) or original(*given, **named))
    metrics = metrics_of(ASKED, hybrid)
    (told,) = evaluate(batches([Case(0, hybrid)], metrics, resolution, 1)[0])
    assert (len(judged), bool(told.warnings)) == (1, True)
    (silent,) = evaluate(batches([Case(0, hybrid)], metrics, resolution, 1, judged=False)[0])
    assert (len(judged), silent.warnings, silent.values) == (1, (), told.values)


def test_a_refused_case_is_nan_with_its_reason(hybrid, resolution):
    unstable = varied(hybrid, {"control.proportional": 1e6, "control.derivative": 1e4})
    (batch,) = batches([Case(0, unstable)], metrics_of(ASKED, hybrid), resolution, 1)
    (outcome,) = evaluate(batch)
    assert outcome.failed
    assert outcome.expected
    assert "control" in outcome.reason
    assert np.isnan(outcome.values).all()


def test_a_store_keeps_outcomes_to_the_last_bit(hybrid, cases, resolution, tmp_path):
    metrics = metrics_of(ASKED, hybrid)
    store = StudyStore(tmp_path / "store", {"scenario": hybrid.canonical()}, metrics)
    for number, outcome in outcomes(batches(cases, metrics, resolution, 1)).items():
        key = store.key(cases[number].system, resolution)
        assert store.load(key) is None
        store.save(key, outcome)
        assert store.load(key).values == outcome.values
    with pytest.raises(cx.InputError, match="already holds 6 cases of this study; use resume"):
        StudyStore(tmp_path / "store", {"scenario": hybrid.canonical()}, metrics)
    with pytest.raises(cx.InputError, match="holds another study: its scenario differ"):
        StudyStore(tmp_path / "store", {"scenario": 1}, metrics, resume=True)
    (tmp_path / "store" / f"{key}.json").write_text("")  # as after a power cut
    assert StudyStore(tmp_path / "store", {"scenario": hybrid.canonical()}, metrics, resume=True).load(key) is None


def square(x):
    import os
    import signal

    if x == 5:
        os.kill(os.getpid(), signal.SIGKILL)
    if x == 6:
        raise ValueError("six")
    return x * x


@pytest.mark.slow
def test_a_pool_survives_the_death_of_its_workers():
    found = dict(completed(range(12), square, workers=2))
    assert isinstance(found.pop(5), WorkerDiedError)
    assert isinstance(found.pop(6), ValueError)
    assert found == {x: x * x for x in range(12) if x not in (5, 6)}


def test_pieces_with_and_without_arrays(tmp_path):
    store = Store(tmp_path / "kept")
    store.put("plain", {}, {"y": [1, None]})
    store.put("arrays", {"x": np.arange(3.0)}, {"y": 2.5})
    again = Store(tmp_path / "kept")
    assert again.get("plain") == ({}, {"y": [1, None]})
    arrays, values = again.get("arrays")
    assert (arrays["x"].tolist(), values) == ([0.0, 1.0, 2.0], {"y": 2.5})
    assert ("plain" in again, "arrays" in again, "none" in again) == (True, True, False)
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match=r"^output: .* cannot be used"):
        Store(tmp_path / "file" / "kept", where="output")


def test_the_numerics_version_is_one(tmp_path, quick):
    from coaxshell.apps.paper.known_runs import key_of
    from coaxshell.numerics.identity import NUMERICS_VERSION, numerics, origin
    from coaxshell.studies.store import digest

    assert numerics().endswith(f"numerics {NUMERICS_VERSION}")
    assert origin("apps/paper/slips") != origin()
    assert key_of("run") == digest([origin("apps/paper/observed.py", "apps/paper/fields.py", "apps/paper/slips"), "run"])
    swept = cx.sweep("bare", {"source.peak_pressure": [1e4]}, workers=1, **quick)
    assert swept.attrs["numerics"] == numerics()
    path = cx.simulate("bare", **quick).save(tmp_path / "run.nc")
    assert f"numerics {NUMERICS_VERSION}, " in info(path)


def test_what_no_process_could_be_sent_is_not_looked_for_in_a_main_program_without_a_file(monkeypatch):
    monkeypatch.setitem(sys.modules, "__main__", ModuleType("__main__"))  # as in a notebook
    assert not UserFunction("f", "", "", "", target=lambda response: 1.0).only_here
