"""Fifty clients that move sliders for three minutes, against a real server: latency, and memory before, after, and after five idle minutes.

``python -m benchmarks.studio``
"""

from __future__ import annotations

import asyncio
import os
import re
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx2

from coaxshell.apps.studio.limits import settings_of
from coaxshell.apps.studio.worker import solve
from coaxshell.model import presets

CLIENTS, SECONDS, ROUNDS, IDLE = 50, 15.0, 12, 300.0
SYSTEMS = {name: presets.load(name).model_dump(mode="json") for name in ("absorbers", "hybrid")}
SLIDERS = (("absorbers", "absorbers.mass", 5.0), ("hybrid", "absorbers.mass", 5.0), ("hybrid", "control.derivative", -150.0))
PAUSE = 0.05
"""Seconds between two movements of a slider, whether or not the last one has been answered."""


def main() -> None:
    """Start a server and measure it."""
    with served() as (address, pid):
        asyncio.run(_measured(address, pid))


@contextmanager
def served() -> Iterator[tuple[str, int]]:
    """Give the address and the process of a server that ends with the ``with`` block."""
    command = [sys.executable, "-m", "coaxshell", "studio", "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            assert process.stdout is not None
            found = re.search(r"http://127\.0\.0\.1:\S+", process.stdout.readline())
            assert found is not None
            yield found.group(), process.pid
        finally:
            process.terminate()


async def _measured(address: str, pid: int) -> None:
    limits = httpx2.Limits(max_connections=400)
    base = re.match(r"http://127\.0\.0\.1:\d+", address)
    assert base is not None
    async with httpx2.AsyncClient(base_url=base.group(), timeout=120, limits=limits, follow_redirects=True) as http:
        (await http.get(address)).raise_for_status()  # the key in the address becomes a cookie
        for preset, path, low in (
            ("absorbers", "absorbers.mass", 5.0),
            ("hybrid", "absorbers.mass", 5.0),
            ("hybrid", "control.derivative", -150.0),
        ):
            alone = [await _solve(http, f"alone-{preset}-{path[:5]}", step, preset, path, low + step) for step in range(20)]
            assert {status for _, status in alone} == {200}
            told = f"median {_ms(statistics.median(x for x, _ in alone[4:]))}, first {_ms(alone[0][0])}"
            print(f"{preset}, {path}, one client at M = 60, dt = 4e-3: {told}; in this process {_plain(preset, path, low)}", flush=True)
        print(f"memory of all processes before the clients {_memory(pid):.0f} MB", flush=True)
        for half in range(1, ROUNDS + 1):
            answered: list[float] = []
            replaced: list[float] = []
            light: list[float] = []
            before = _processor(pid), time.process_time()
            await asyncio.gather(_watch(http, light), *(_hammer(http, half, number, answered, replaced) for number in range(CLIENTS)))
            server, own = _processor(pid) - before[0], time.process_time() - before[1]
            print(
                f"{CLIENTS} clients, {SECONDS:g} s, round {half}: {len(answered)} answered ({_spread(answered)}), {len(replaced)} replaced "
                f"by newer ones, a light route meanwhile {_spread(light)}; memory of all processes {_memory(pid):.0f} MB; "
                f"processor time of the server without its workers {server:.1f} s, of this client {own:.1f} s",
                flush=True,
            )
        await asyncio.sleep(IDLE)
        print(f"memory of all processes after {IDLE / 60:g} idle minutes {_memory(pid):.0f} MB", flush=True)


async def _hammer(http: Any, half: int, number: int, answered: list[float], replaced: list[float]) -> None:
    """Move a slider every so often, with at most four requests open, as a browser has."""
    end, step, waiting = time.perf_counter() + SECONDS, 0, set[asyncio.Task[None]]()

    async def one(revision: int, mass: float) -> None:
        seconds, status = await _solve(http, f"c{number}", revision, "absorbers", "absorbers.mass", mass)
        (answered if status == 200 else replaced).append(seconds)

    while time.perf_counter() < end:
        step += 1
        waiting.add(asyncio.create_task(one(half * 100_000 + step, 5 + number + 0.001 * step + 0.0001 * half)))
        await asyncio.sleep(PAUSE)
        while len(waiting) >= 4:
            done, waiting = await asyncio.wait(waiting, return_when=asyncio.FIRST_COMPLETED)
            for task in done:
                task.result()
    await asyncio.gather(*waiting)


async def _solve(http: Any, client: str, revision: int, preset: str, path: str, value: float) -> tuple[float, int]:
    system = dict(SYSTEMS[preset])
    part, entry = path.split(".")
    system[part] = {**system[part], entry: value}
    start = time.perf_counter()
    answer = await http.post("/api/solve", json={"client": client, "slot": "current", "revision": revision, "system": system})
    return time.perf_counter() - start, int(answer.status_code)


async def _watch(http: Any, light: list[float]) -> None:
    end = time.perf_counter() + SECONDS
    while time.perf_counter() < end:
        start = time.perf_counter()
        (await http.get("/api/jobs?client=light")).raise_for_status()
        light.append(time.perf_counter() - start)
        await asyncio.sleep(0.1)


def _plain(preset: str, path: str, low: float) -> str:
    """Return the time of the same in this process: with what a worker keeps between two of them."""
    system, settings, times = presets.load(preset), settings_of("preview", live=True), []
    for step in range(6):
        changed = system.with_overrides({path: low + step})
        start = time.perf_counter(), time.process_time()
        solve(changed, settings)
        times.append((time.perf_counter() - start[0], time.process_time() - start[1]))
    wall, processor = (statistics.median(column) for column in zip(*times[1:], strict=True))
    return f"{_ms(wall)}, {_ms(processor)} of processor time"


def _processor(pid: int) -> float:
    """Return the processor time of one process, s."""
    fields = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def _and_children(pid: int) -> list[int]:
    return [pid, *map(int, Path(f"/proc/{pid}/task/{pid}/children").read_text().split())]


def processor_of_all(pid: int) -> float:
    """Return the processor time of a process and its children, s."""
    return sum(map(_processor, _and_children(pid)))


def _memory(pid: int) -> float:
    """Return the resident memory of a process and its children, MB."""
    texts = [Path(f"/proc/{one}/status").read_text() for one in _and_children(pid)]
    found = [re.search(r"VmRSS:\s+(\d+)", text) for text in texts]
    return sum(int(match.group(1)) for match in found if match) / 1e3


def _spread(seconds: list[float]) -> str:
    if len(seconds) < 2:
        return "too few"
    return f"median {_ms(statistics.median(seconds))}, 99th percentile {_ms(statistics.quantiles(seconds, n=100)[-1])}"


def _ms(seconds: float) -> str:
    return f"{1e3 * seconds:.0f} ms"


if __name__ == "__main__":
    main()
