"""One set of names for shells, whatever asks for them."""

from __future__ import annotations

import pytest

import coaxshell as cx
from coaxshell.model.naming import shell_name, shell_number, shell_phrase
from coaxshell.studies.metrics import metric_names, metrics_of

NAMES = {
    1: ["shell"],
    2: ["inner", "outer"],
    3: ["inner", "middle", "outer"],
    4: ["inner", "shell 2 of 4", "shell 3 of 4", "outer"],
}


def nested(count):
    """Return a system of so many shells of the double-shell preset's inner wall."""
    bare = cx.presets.load("bare")
    shells = [bare.shells[0].replace(radius=0.4 + 0.2 * number) for number in range(count)]
    fluids = [bare.fluids[0]] * count + [bare.fluids[-1]]
    return bare.replace(shells=shells, fluids=fluids, absorbers=(), control=None)


@pytest.mark.parametrize("count", NAMES)
def test_every_name_is_read_back(count):
    for index, name in enumerate(NAMES[count]):
        assert shell_name(index, count) == name
        for known in (name, name.upper(), shell_phrase(index, count), f"shell {index}", str(index)):
            assert shell_number(known, count) == index, known
    assert shell_number("nonsense", count) is None
    assert shell_number("middle", 2) is None


@pytest.mark.parametrize("count", NAMES)
def test_responses_summaries_metrics_and_paths_share_the_names(count):
    system = nested(count)
    response = cx.simulate(system, duration=0.2, time_step=0.02, modes=4)
    assert [shell.name for shell in response.summary().shells] == NAMES[count]
    for index, name in enumerate(NAMES[count]):
        assert response.stress(name, angle=0).attrs["shell_name"] == name
        assert response.stress(name, angle=0).attrs["shell"] == index
        (metric,) = metrics_of([f"shells[{index}].peak_stress"], system)
        assert metric.long_name == f"largest hoop stress anywhere, {shell_phrase(index, count)}"
        if name in ("inner", "middle", "outer", "shell"):
            assert f"{name}.peak_stress" in metric_names(system)
            assert metrics_of([f"{name}.peak_stress"], system)[0].identity == metric.identity
        if name in ("inner", "middle", "outer"):
            radius = system.with_overrides({f"shells.{name}.radius": system.shells[index].radius * 1.001}).shells[index].radius
            assert radius == pytest.approx(1.001 * system.shells[index].radius)
    assert "th shell" not in " ".join(metric.long_name for metric in metrics_of(metric_names(system), system))


def test_a_name_that_is_none_is_told_with_those_that_are():
    with pytest.raises(cx.InputError, match=r"0 to 2 .*'inner' or 'outer' or 'middle'"):
        nested(3).shell_index("centre")
    assert nested(3).replace(control=cx.PDControl(proportional=-1.0, derivative=0.0, shells="middle")).control.shells == ("middle",)
