"""Six hundred axial wavenumbers on a local Dask cluster, one of whose workers is killed on the way: time, memory, and the bits.

Scheduler and workers are processes of their own, so that the memory of each is its own too. Blocks are of 64 Laplace nodes instead of 600,
so that there are as many of them as in a run of 5000 steps.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

import coaxshell as cx
from coaxshell.solver.axial import blocks

SETTINGS = {"modes": 20, "time_step": 8e-3, "duration": 5.0, "dimensions": 3, "stations": (0.0, 1.0), "axial_period": 190.0}
_WORKERS, _NODES = 3, 64


def peak_of(process: subprocess.Popen[bytes]) -> float:
    """Return the peak resident memory of a running process, MB."""
    status = Path(f"/proc/{process.pid}/status").read_text(encoding="utf-8")
    return float(next(line for line in status.splitlines() if line.startswith("VmHWM")).split()[1]) / 1024


@contextmanager
def cluster(folder: Path) -> Iterator[tuple[str, list[subprocess.Popen[bytes]]]]:
    """Start a scheduler and workers on this machine: yield the address, and the processes, the scheduler first."""
    from distributed import Client

    known = folder / "scheduler.json"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    command = [sys.executable, "-m"]
    shared = ["--scheduler-file", str(known), "--no-dashboard"]
    found = [subprocess.Popen([*command, "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", *shared], **quiet)]
    try:
        while not known.exists():
            time.sleep(0.1)
        worker = [*command, "distributed.cli.dask_worker", "--nthreads", "1", "--no-nanny", *shared]
        found += [subprocess.Popen([*worker, "--local-directory", str(folder)], **quiet) for _ in range(_WORKERS)]
        with Client(scheduler_file=str(known)) as client:
            client.wait_for_workers(_WORKERS)
            yield client.scheduler.address, found
    finally:
        for process in found:
            process.kill()
            process.wait()


def main() -> None:
    """Print what the run took, with a worker killed at a third of it, and whether its bits are those of threads."""
    warnings.simplefilter("ignore", cx.PhysicsWarning)
    blocks.BLOCK_NODES = _NODES
    start, used = time.perf_counter(), time.process_time()
    threads = cx.simulate("bare", **SETTINGS)
    print(f"bare, {len(threads.spatial.sampling.modes)} axial wavenumbers, M = k_max = {SETTINGS['modes']}, 625 steps")
    print(f"  threads of one process: {time.perf_counter() - start:.0f} s, {time.process_time() - used:.0f} s of processor time")
    with tempfile.TemporaryDirectory() as folder, cluster(Path(folder)) as (address, processes):
        peaks: dict[str, float] = {}

        def kill_one(fraction: float, stage: str) -> None:
            if fraction > 1 / 3 and "killed" not in peaks:
                peaks["killed"] = peak_of(processes[1])
                processes[1].kill()

        start = time.perf_counter()
        found = cx.simulate("bare", execution=cx.Execution(dask=address, progress=kill_one), **SETTINGS)
        print(f"  {_WORKERS} workers, one of them killed at a third: {time.perf_counter() - start:.0f} s")
        workers = ", ".join(f"{peak_of(one):.0f}" for one in processes[2:])
        print(f"  peak memory, MB: scheduler {peak_of(processes[0]):.0f}; workers {workers}; the one killed {peaks['killed']:.0f}")
    same = all(np.array_equal(values, found.spatial.fields[name]) for name, values in threads.spatial.fields.items())
    print(f"  bits: {'the same' if same else 'DIFFERENT'}")


if __name__ == "__main__":
    main()
