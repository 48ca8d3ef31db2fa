"""Settings and execution as objects: the same as their keywords, which change them; declared once, shown and checked everywhere."""

from __future__ import annotations

import inspect
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields

import pytest

import coaxshell as cx
from coaxshell.solver.settings import SettingsKeywords
from coaxshell.studies import execution
from coaxshell.studies.execution import StudyKeywords

OVER = {"source.peak_pressure": [1e4, 2e4]}
RUNS, STUDIES = (cx.simulate, cx.prepare), (cx.sweep, cx.sensitivity, cx.robustness, cx.optimise)


def test_keywords_are_those_of_the_objects():
    assert [field.name for field in fields(cx.Settings)] == [name for name in SettingsKeywords.__annotations__ if name != "settings"]
    names = [field.name for field in fields(cx.Execution)] + ["execution"]
    assert list(StudyKeywords.__annotations__) == [*SettingsKeywords.__annotations__, *names]


@pytest.mark.parametrize("function", [*RUNS, *STUDIES], ids=lambda one: one.__name__)
def test_help_shows_the_keywords_with_their_defaults(function):
    shown = inspect.signature(function).parameters
    assert not any(one.kind is one.VAR_KEYWORD for one in shown.values())
    for holder in (cx.Settings,) if function in RUNS else (cx.Settings, cx.Execution):
        assert {field.name: shown[field.name].default for field in fields(holder)} == {
            field.name: field.default for field in fields(holder)
        }


def test_an_object_says_what_its_keywords_say(quick):
    settings, work = cx.Settings(**quick), cx.Execution(workers=1)
    found = cx.sweep("bare", OVER, settings=settings, execution=work)
    assert found.identical(cx.sweep("bare", OVER, workers=1, **quick))
    assert found.identical(cx.sweep("bare", OVER, settings=quick, execution=cx.Execution(workers=2), workers=1))
    assert found.attrs["settings"] != cx.sweep("bare", OVER, settings=settings, modes=4, execution=work).attrs["settings"]
    assert cx.simulate("bare", settings=settings, modes=4).settings == cx.Settings(**quick | {"modes": 4})
    assert cx.prepare("bare", settings=settings).settings == settings


@pytest.mark.parametrize("function", [*RUNS, cx.sweep])
def test_what_is_wrong_is_told(function):
    over = (OVER,) if function is cx.sweep else ()
    with pytest.raises(TypeError, match="unexpected keyword argument 'mods'; did you mean 'modes'"):
        function("bare", *over, mods=3)
    with pytest.raises(cx.InputError, match=r"^settings\.modes: 0 is not allowed"):
        function("bare", *over, settings={"modes": 0})
    with pytest.raises(cx.InputError, match=r"^settings\.mods: is not an entry of a resolution; did you mean"):
        function("bare", *over, settings={"mods": 6})
    with pytest.raises(cx.InputError, match=r"^settings: 5 is not a resolution"):
        function("bare", *over, settings=5)


def test_only_the_spectral_engine_can_be_prepared():
    with pytest.raises(cx.InputError, match=r"^engine: 'direct' cannot be prepared"):
        cx.prepare("bare", settings=cx.Settings(engine="direct"))


@pytest.mark.parametrize(
    ("keywords", "where"),
    [
        ({"workers": 0}, "workers"),
        ({"workers": "two"}, "workers"),
        ({"dask": "x", "workers": 2}, "workers"),
        ({"execution": 3}, "execution"),
    ],
)
def test_an_execution_that_cannot_be_is_refused(keywords, where):
    with pytest.raises(cx.InputError) as refused:
        cx.sweep("bare", OVER, **keywords)
    assert refused.value.where == where


def test_a_cluster_is_reached_once_and_left(quick, monkeypatch):
    told = []

    class Cluster(ThreadPoolExecutor):
        def __init__(self, address):
            super().__init__(1)
            told.append(address)

        def __exit__(self, *unused):
            told.append("left")
            return super().__exit__(*unused)

    monkeypatch.setattr(execution, "dask_executor", Cluster)
    found = cx.sweep("bare", OVER, dask="tcp://somewhere", **quick)
    assert found.identical(cx.sweep("bare", OVER, workers=1, **quick))
    assert told == ["tcp://somewhere", "left"]


def test_the_journal_is_the_store_of_an_optimisation(tmp_path, quick):
    variables = {"absorbers.mass": [5.0, 20.0]}
    asked = {"variables": variables, "objectives": "inner.peak_stress", "evaluations": 2, "workers": 1, **quick}
    first = cx.optimise("absorbers", journal=tmp_path / "kept", **asked)
    again = cx.optimise("absorbers", execution=cx.Execution(workers=1, store=tmp_path / "kept", resume=True), **asked)
    assert [one.objectives for one in again.history] == [one.objectives for one in first.history]
    with pytest.raises(cx.InputError, match=r"^journal: .* already holds"):
        cx.optimise("absorbers", store=tmp_path / "kept", **asked)


def test_the_old_name_still_works_and_says_what_it_is_now():
    from coaxshell import studies

    with pytest.warns(DeprecationWarning, match=r"How is now coaxshell\.studies\.execution\.Execution"):
        assert studies.How(workers=1) == cx.Execution(workers=1)
