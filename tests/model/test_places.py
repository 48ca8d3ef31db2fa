"""One set of names for shells and fluids, whatever asks for them."""

from __future__ import annotations

import pytest

import coaxshell as cx
from coaxshell.model.places import region_name, region_number, region_phrase, shell_name, shell_number, shell_phrase
from coaxshell.studies.metrics import metric_names, metrics_of

NAMES = {
    1: ["shell"],
    2: ["inner", "outer"],
    3: ["inner", "middle", "outer"],
    12: ["inner", *(f"shell {number} of 12" for number in range(2, 12)), "outer"],
}
REGIONS = {
    1: ["interior", "exterior"],
    2: ["interior", "gap", "exterior"],
    3: ["interior", "gap 1", "gap 2", "exterior"],
    12: ["interior", *(f"gap {number}" for number in range(1, 12)), "exterior"],
}
SENTENCES = {
    1: ["the fluid inside", "the fluid outside"],
    2: ["the fluid inside", "the fluid in the gap", "the fluid outside"],
    3: ["the fluid inside", "the fluid in gap 1", "the fluid in gap 2", "the fluid outside"],
    12: ["the fluid inside", *(f"the fluid in gap {number}" for number in range(1, 12)), "the fluid outside"],
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


@pytest.mark.parametrize("count", REGIONS)
def test_fluids_are_named_and_found_by_name(count):
    for index, name in enumerate(REGIONS[count]):
        assert region_name(index, count) == name
        assert region_number(name, count) == index
        assert region_phrase(index, count) == SENTENCES[count][index]
    assert region_number("gap" if count != 2 else "gap 1", count) is None
    assert region_number("nonsense", count) is None


@pytest.mark.slow_for("12")
@pytest.mark.parametrize("count", REGIONS)
def test_responses_metrics_and_energies_share_the_names_of_fluids(count):
    system = nested(count)
    names = REGIONS[count]
    response = cx.simulate(system, duration=0.2, time_step=0.02, modes=4)
    for index, name in enumerate(names[:-1]):
        assert response.pressure_rms(index).equals(response.pressure_rms(name))
        (metric,) = metrics_of([f"fluids[{index}].rms_pressure"], system)
        assert metric.long_name == f"RMS pressure over area and time, {name}"
        if " " not in name:
            assert metrics_of([f"{name}.rms_pressure"], system)[0].identity == metric.identity
    kinetic = {name.removesuffix("_kinetic") for name in response.energy(every=5).data_vars if name.endswith("_kinetic")}
    assert {name.replace(" ", "_") for name in names[:-1]} <= kinetic


@pytest.mark.parametrize("count", NAMES)
def test_responses_summaries_metrics_and_paths_share_the_names(count):
    system = nested(count)
    response = cx.simulate(system, duration=0.2, time_step=0.02, modes=4)
    assert [shell.name for shell in response.summary().shells] == NAMES[count]
    for index, name in enumerate(NAMES[count]):
        assert response.stress(name, angle=0).attrs["shell_name"] == name
        assert response.stress(name, angle=0).attrs["shell"] == index
        (metric,) = metrics_of([f"shells[{index}].peak_stress"], system)
        assert metric.long_name == f"largest stress anywhere, {shell_phrase(index, count)}"
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
