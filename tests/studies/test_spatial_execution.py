"""A run in three dimensions is the same to the last bit wherever its blocks are worked on, whatever is killed, and goes on where it was."""

from __future__ import annotations

import os
import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial

import numpy as np
import pytest

import coaxshell as cx
from coaxshell.response.spatial import SpatialResponse
from coaxshell.solver.axial import blocks, solve
from coaxshell.solver.axial.blocks import Found
from coaxshell.studies.blocks import BlocksSharedOut

QUICK = {"duration": 2.0, "time_step": 2e-2, "modes": 10, "dimensions": 3, "stations": [0.0, 0.4]}


@pytest.fixture(autouse=True)
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(blocks, "BLOCK_NODES", 8)


def run(execution: cx.Execution | None = None, name: str = "bare") -> SpatialResponse:
    found = cx.simulate(name, execution=execution, **QUICK)
    assert isinstance(found, SpatialResponse)
    return found


def assert_same(one: SpatialResponse, other: SpatialResponse) -> None:
    for name, values in one.spatial.fields.items():
        np.testing.assert_array_equal(values, other.spatial.fields[name])
    assert one.summary().to_dict() == other.summary().to_dict()


@pytest.fixture(scope="module")
def threaded() -> SpatialResponse:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(blocks, "BLOCK_NODES", 8)
        return run()


@pytest.mark.slow_for("1")
@pytest.mark.parametrize("workers", [1, 2])
def test_processes_give_the_bits_of_threads(threaded: SpatialResponse, workers: int) -> None:
    told: list[float] = []
    execution = cx.Execution(workers=workers, progress=lambda fraction, stage: told.append(fraction))
    assert_same(run(execution), threaded)
    assert told[-1] == 1.0


def test_results_come_in_the_order_of_the_blocks() -> None:
    parts = [slice(i, i + 1) for i in range(6)]
    with ThreadPoolExecutor(2) as pool:
        found = list(BlocksSharedOut(pool)(partial(_late), parts))
    assert [int(each["at"][0]) for each in found] == list(range(6))


def _late(block: slice) -> Found:
    time.sleep(0.02 * (block.start % 2))
    return {"at": np.array([block.start])}


def test_an_interrupted_run_goes_on(threaded: SpatialResponse, tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "run.store"

    def cut(fraction: float, stage: str) -> None:
        if len(list(folder.glob("*.npz"))) >= 3:  # threads run ahead of what is kept, however little that is
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run(cx.Execution(store=folder, progress=cut))
    kept = sorted(folder.glob("*.npz"))
    assert len(kept) >= 3
    kept[0].write_bytes(kept[0].read_bytes()[:40])  # the power went before the disk had it
    with pytest.raises(cx.InputError, match=r"^store: .* already holds \d+ blocks of this run"):
        run(cx.Execution(store=folder))
    done: list[int] = []
    original = solve.station_sums

    def station_sums(*arguments) -> Found:
        done.append(arguments[-1].start)
        return original(*arguments)

    monkeypatch.setattr(solve, "station_sums", station_sums)
    assert_same(run(cx.Execution(store=folder, resume=True)), threaded)
    whole = len(sorted(folder.glob("*.npz")))
    assert len(done) == whole - len(kept) + 1
    with pytest.raises(cx.InputError, match=r"^store: .* holds another study: its scenario"):
        run(cx.Execution(store=folder, resume=True), "active")


def test_two_dimensions_have_no_blocks() -> None:
    with pytest.raises(cx.InputError, match=r"^execution: has no effect on a run in two dimensions"):
        cx.simulate("bare", execution=cx.Execution(workers=2))


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_a_dask_cluster_one_of_whose_workers_is_killed(threaded: SpatialResponse) -> None:
    assert_same(with_a_worker_killed("bare", **QUICK), threaded)


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_600_wavenumbers_on_a_dask_cluster_one_of_whose_workers_is_killed() -> None:
    many = {**QUICK, "modes": 20, "axial_period": 190.0}
    threaded = cx.simulate("bare", **many)
    assert isinstance(threaded, SpatialResponse)
    assert len(threaded.spatial.sampling.modes) >= 600
    assert_same(with_a_worker_killed("bare", **many), threaded)


def with_a_worker_killed(name: str, **settings) -> SpatialResponse:
    """Run on two workers of a local Dask cluster, one of which is killed on the way."""
    dask, distributed = pytest.importorskip("dask"), pytest.importorskip("distributed")
    dask.config.set({"distributed.worker.daemon": True, "distributed.comm.timeouts.connect": "20s"})
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1", silence_logs=50
    ) as cluster:
        victim = next(iter(cluster.workers.values())).process.pid
        killed = threading.Event()

        def kill_one(fraction: float, stage: str) -> None:
            if fraction > 0.2 and not killed.is_set():
                os.kill(victim, signal.SIGKILL)
                killed.set()

        found = cx.simulate(name, execution=cx.Execution(dask=cluster.scheduler_address, progress=kill_one), **settings)
        assert killed.is_set()
        assert isinstance(found, SpatialResponse)
        return found
