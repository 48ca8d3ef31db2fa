"""One cost of a run over all that makes it large; what the server keeps is bounded, and what it has freed comes back."""

from __future__ import annotations

import asyncio
import time
from itertools import pairwise

import pytest
from asking import SMALL, carried_out, described, solve, solved, taking

from coaxshell.apps.studio import limits, worker
from coaxshell.apps.studio.state import Studio
from coaxshell.errors import InputError
from coaxshell.model import System, presets
from coaxshell.solver.settings import Settings
from coaxshell.solver.spatial_cost import sampling_of

MOST = Settings(10.0, 1e-3, 300)
"""As fine as is allowed."""


def many_shells(count, absorbers):
    shell = described("hybrid")["shells"][1]
    system = described("bare")
    system["shells"] = [{**shell, "radius": 0.5 + 0.1 * number} for number in range(count)]
    system["fluids"] = [system["fluids"][-1]] * (count + 1)
    system["source"] = {"type": "plane-wave", "pulse": {"type": "step", "pressure": 1e3}}
    system["absorbers"] = {"count": absorbers, "mass": 1.0, "cubic_stiffness": 1e12}
    return system


def test_a_run_is_refused_for_all_that_makes_it_large_together():
    limits.check_cost(presets.load("hybrid"), MOST, live=False)
    large = System.model_validate(many_shells(6, 200))
    with pytest.raises(InputError, match="GB") as refused:
        limits.check_cost(large, MOST, live=False)
    assert refused.value.where == "resolution"
    assert "at most 2.5 GB" in refused.value.remedy
    limits.check_cost(large, Settings(2.0, 2e-2, 12), live=True)


def test_a_run_in_three_dimensions_costs_as_many_as_it_has_wavenumbers():
    bare, fine = presets.load("bare"), {"time_step": 1e-3, "modes": 150, "dimensions": 3}
    with pytest.raises(InputError, match=r"^resolution: .* takes about .*fewer orders, stations or shells"):
        limits.check_cost(bare, Settings(**fine), live=True)
    limits.check_cost(bare, Settings(**fine), live=False)
    limits.check_cost(bare, Settings(**{**fine, "modes": 60, "time_step": 4e-3}), live=True)

    def wavenumbers(system, settings, order=150):
        return sampling_of(system, settings, order).wavenumbers.size

    plane = bare.with_overrides({"source": {"type": "plane-shock", "peak_pressure": 1e3, "decay_time": 1e-4}})
    assert wavenumbers(plane, Settings(dimensions=3)) == 1
    assert wavenumbers(bare, Settings(dimensions=3, axial_period=20.0)) == 1 + 477
    assert wavenumbers(bare, Settings(dimensions=3, axial_period=20.0, axial_modes=30)) == 1 + 95
    near, far = (wavenumbers(bare, Settings(dimensions=3, stations=(z,))) for z in (0.0, 20.0))
    assert far > near + 20.0 * 150 / (2 * 3.15)
    off = bare.with_overrides({"source.z": 20.0})
    assert wavenumbers(off, Settings(dimensions=3, stations=(20.0,))) == near
    with pytest.raises(InputError, match=r"^axial_period: 3 m is too short"):
        limits.check_cost(bare, Settings(dimensions=3, axial_period=3.0), live=False)


def test_a_page_is_told_so_before_anything_is_begun(client):
    answer = solve(client, many_shells(6, 200), resolution={"duration": 5.0, "time_step": 2e-3, "modes": 100}).json()
    assert answer["problem"]["where"] == "resolution"
    assert "takes about" in answer["problem"]["problem"]


@pytest.mark.slow
def test_runs_are_kept_by_their_size(client):
    """A record of 20,000 samples weighs a thousand times what a description without one does."""
    studio: Studio = client.app.app.state.studio
    time_, settings = [float(number) for number in range(20_000)], Settings(2.0, 0.02, 12)
    source = {"type": "plane-wave", "pulse": {"type": "sampled", "time": time_, "pressure": time_}}
    small, large = presets.load("bare"), System.model_validate({**described("bare"), "source": source})
    name = studio.run_of(small, settings).name
    assert studio.run(name).bytes * 50 < studio.run_of(large, settings).bytes
    for number in range(3 + limits.RUN_BYTES // studio.run_of(large, settings).bytes):
        studio.run_of(large.replace(name=str(number)), settings)
    assert studio._runs.bytes <= limits.RUN_BYTES
    assert client.get(f"/api/runs/{name}").status_code == 404, "the oldest has gone"
    assert solved(client, described("bare"))[0]["ok"]


STEPS = ((100_000_000, 3600.0, 1e9), (0, 0.0, 1e9), (0, 0.0, 1e9), (100_000_000, 3600.0, 1e8))
"""Bytes that a worker takes, seconds of rest after which it may be renewed, bytes above which it is at once."""


@pytest.mark.parametrize("steps", [2, pytest.param(4, marks=pytest.mark.slow)])
def test_a_worker_that_has_grown_is_renewed_once_it_rests_and_at_once_when_it_holds_too_much(monkeypatch, steps):
    async def story(crew):
        numbers, found = [await crew.submit(worker.ready).future], []
        for size, seconds, most in STEPS[:steps]:
            monkeypatch.setattr(limits, "WORKER_BYTES", most)
            await crew.submit(taking, size).future
            await asyncio.sleep(0.05)
            found.append(crew.rest(seconds))
            numbers.append(await crew.submit(worker.ready).future)
        return numbers, found

    numbers, found = carried_out(story)
    assert [number == before for before, number in pairwise(numbers)] == [True, False, True, False][:steps]
    assert found == [False, True, True, False][:steps], "whether all rested"


def test_a_server_that_rests_lets_go_of_what_it_keeps(client, monkeypatch):
    studio: Studio = client.app.app.state.studio
    monkeypatch.setattr(limits, "REST_SECONDS", 0.1)
    assert solved(client, described("bare"), resolution=SMALL)[0]["ok"]

    async def story():
        resting = asyncio.get_running_loop().create_task(studio.rest())
        end = time.monotonic() + 20
        while len(studio.curves) and time.monotonic() < end:
            await asyncio.sleep(0.05)
        resting.cancel()

    client.portal.call(story)
    assert len(studio.curves) == 0
    assert solved(client, described("bare"), resolution=SMALL)[0]["ok"]
