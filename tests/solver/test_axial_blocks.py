"""Blocks of a run in three dimensions tell how far they are while they are worked on, and end when nobody wants them."""

from __future__ import annotations

import pickle
import time
from functools import partial

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.numerics.progress import heard_by, tell_share
from coaxshell.response.spatial import SpatialResponse
from coaxshell.solver.axial import blocks
from coaxshell.solver.axial.blocks import Found, on_threads
from coaxshell.studies.blocks import BlocksSharedOut

PARTS = [slice(i, i + 1) for i in range(3)]
QUICK = {"duration": 1.0, "time_step": 2e-2, "modes": 8, "dimensions": 3}
ended: list[int] = []


def slowly(steps: int, seconds: float, block: slice) -> Found:
    for step in range(steps):
        time.sleep(seconds)
        tell_share((step + 1) / steps)
    ended.append(block.start)
    return {"at": np.array([block.start])}


@pytest.fixture(autouse=True)
def often(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blocks, "_LOOK_SECONDS", 0.002)
    ended.clear()


@pytest.mark.parametrize("mapping", [on_threads, BlocksSharedOut()], ids=["threads", "shared out"])
def test_shares_within_a_block_are_told(mapping) -> None:
    told: list[float] = []
    found = list(mapping(partial(slowly, 10, 0.004), PARTS, told.append))
    assert [int(each["at"][0]) for each in found] == [0, 1, 2]
    assert told == sorted(told)
    assert told[-1] == 1.0
    assert len(set(told)) > 2 * len(PARTS)


class StoppedError(BaseException):
    pass


def test_blocks_end_when_they_are_not_wanted() -> None:
    def stop(share: float) -> None:
        if share > 0.0:
            raise StoppedError

    with pytest.raises(StoppedError):
        list(on_threads(partial(slowly, 2000, 0.002), PARTS, stop))
    assert not ended


def test_a_block_that_fails_ends_the_others() -> None:
    def fails(block: slice) -> Found:
        if block.start == 0:
            raise MemoryError
        return slowly(2000, 0.002, block)

    with pytest.raises(MemoryError):
        list(on_threads(partial(fails), PARTS))
    assert not ended


def test_a_run_hears_of_every_wavenumber(monkeypatch: pytest.MonkeyPatch) -> None:
    shares: dict[str, list[float]] = {}

    def here(work: partial[Found], parts: list[slice], tell: object = None):
        for part in parts:
            with heard_by(shares.setdefault(f"{work.func.__name__} {part.start}", []).append):
                yield work(part)

    point = cx.PointAbsorber(mass=5.0, linear_stiffness=1e8, z=0.2)
    monkeypatch.setattr("coaxshell.solver.axial.solve.on_threads", here)
    response = cx.simulate(cx.presets.load("bare").replace(absorbers=[point]), **QUICK)
    assert isinstance(response, SpatialResponse)
    waves = response.spatial.sampling.wavenumbers.size
    assert {name.split()[0] for name in shares} == {"station_sums", "point_sums"}
    for told in shares.values():
        assert told == sorted(told)
        assert told[-1] == 1.0
        assert len(told) >= waves


def test_a_run_sent_to_another_process_leaves_its_transforms_behind() -> None:
    response = cx.simulate("bare", **QUICK, stations=[0.0, 0.5])
    assert isinstance(response, SpatialResponse)
    assert response.summary().largest[0]["shell_velocity"]["value"] > 0
    sent = pickle.dumps(response)
    assert len(sent) < len(pickle.dumps(response.spatial.fields)) + response.spatial.spectra.normal.nbytes
    copy = pickle.loads(sent)
    assert copy.spatial.spectra is None
    assert "shell_velocity" not in copy.summary().largest[0]
    np.testing.assert_array_equal(copy.stress("inner"), response.stress("inner"))
    np.testing.assert_array_equal(copy.shell_velocity("inner"), response.shell_velocity("inner"))
