"""Whatever is killed, a study ends with the numbers of an undisturbed one: workers, the study itself, two at once, a real cluster."""

from __future__ import annotations

import json
import os
import runpy
import signal
import subprocess
import sys
import threading
import time

import pytest
import xarray as xr

import coaxshell as cx
from coaxshell.studies import dask_executor

STUDY = """
import sys
import coaxshell as cx

def study(**options):
    system = cx.presets.load("hybrid")
    over = {"absorbers.count": range(1, 13), "source.peak_pressure": [1e4, 2e4]}
    metrics = ["inner.peak_stress", "outer.rms_stress"]
    return cx.sweep(system, over, metrics, duration=1.0, time_step=0.01, modes=10, **options)

if __name__ == "__main__":
    folder, output, workers = sys.argv[1:]
    study(store=folder, resume=True, workers=int(workers)).to_netcdf(output, engine="h5netcdf")
"""
CASES = 24


@pytest.fixture(scope="module")
def script(tmp_path_factory):
    path = tmp_path_factory.mktemp("study") / "study.py"
    path.write_text(STUDY)
    return path


@pytest.fixture(scope="module")
def study(script):
    return runpy.run_path(str(script))["study"]


@pytest.fixture(scope="module")
def undisturbed(study):
    return study(workers=1)


def begin(script, folder, output, workers=1):
    """Start the study as a process of its own group."""
    command = [sys.executable, str(script), str(folder), str(output), str(workers)]
    return subprocess.Popen(command, start_new_session=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)


def finished(folder):
    return [path for path in folder.glob("*.json") if path.name != "study.json"]


def until(condition, seconds=300):
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "nothing happened in time"
        time.sleep(0.005)


def nobody_left(group):
    """Return whether all processes of a group have ended."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return True
    return False


@pytest.mark.slow_for("1")
@pytest.mark.parametrize("workers", [1, 2])
def test_killed_and_resumed_equals_undisturbed(script, study, undisturbed, tmp_path, workers):
    folder = tmp_path / "store"
    process = begin(script, folder, tmp_path / "out.nc", workers)
    until(lambda: len(finished(folder)) >= 3)
    group = os.getpgid(process.pid)
    os.kill(process.pid, signal.SIGKILL)
    process.communicate()
    until(lambda: nobody_left(group), 30)  # workers end with a killed study
    kept = len(finished(folder))
    assert 3 <= kept < CASES
    assert not (tmp_path / "out.nc").exists()
    before = {path.name: path.stat().st_mtime_ns for path in finished(folder)}
    resumed = study(store=folder, resume=True, workers=1)
    xr.testing.assert_identical(resumed, undisturbed)
    assert len(finished(folder)) == CASES
    assert all((folder / name).stat().st_mtime_ns == stamp for name, stamp in before.items())


@pytest.mark.slow
def test_two_writers_on_one_store(script, undisturbed, tmp_path):
    outputs = [tmp_path / f"{name}.nc" for name in "ab"]
    processes = [begin(script, tmp_path / "store", output) for output in outputs]
    for process in processes:
        _, told = process.communicate()
        assert process.returncode == 0, told
    for output in outputs:
        xr.testing.assert_identical(xr.load_dataset(output, engine="h5netcdf"), undisturbed)
    assert len(finished(tmp_path / "store")) == CASES
    assert not list((tmp_path / "store").glob(".*"))


def test_every_state_that_a_kill_can_leave_is_resumed(study, undisturbed, tmp_path):
    folder = tmp_path / "store"
    study(store=folder, workers=1)
    first, second, third, *_ = sorted(finished(folder))
    (folder / f".{first.name}.tmp").write_bytes(first.read_bytes()[:20])  # killed while writing
    first.unlink()
    second.write_text("")  # the power went before the disk had it
    third.write_text(json.dumps({"values": {}, "seconds": 0.0}))
    xr.testing.assert_identical(study(store=folder, resume=True, workers=1), undisturbed)


def test_a_thread_pool_is_an_executor_too(study, undisturbed):
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(2) as pool:
        xr.testing.assert_identical(study(executor=pool), undisturbed)


@pytest.fixture
def cluster():
    """A local Dask cluster of two worker processes."""
    import dask
    import distributed

    dask.config.set({"distributed.worker.daemon": True, "distributed.comm.timeouts.connect": "20s"})
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, host="127.0.0.1", silence_logs=50
    ) as made:
        yield made


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_a_dask_cluster_one_of_whose_workers_is_killed(cluster, study, undisturbed, tmp_path):
    pids = [worker.pid for worker in cluster.workers.values()]
    assert len(set(pids)) == 2
    folder = tmp_path / "store"

    finished_when_killed = []

    def kill_one():
        until(lambda: len(finished(folder)) >= 2)
        os.kill(pids[0], signal.SIGKILL)
        finished_when_killed.append(len(finished(folder)))

    killer = threading.Thread(target=kill_one)
    killer.start()
    with dask_executor(cluster.scheduler_address) as executor:
        found = study(executor=executor, store=folder)
    killer.join()
    assert 2 <= finished_when_killed[0] < CASES
    xr.testing.assert_identical(found, undisturbed)


def test_no_scheduler(hybrid, quick):
    with pytest.raises(cx.InputError, match="no scheduler answers at"), dask_executor("tcp://127.0.0.1:9", timeout=0.5):
        pass
