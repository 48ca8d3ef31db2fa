"""Medians of repeated calls, peak memory of a fresh process, exponents of cost curves."""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from collections.abc import Callable, Sequence

import numpy as np


def median_seconds(call: Callable[[], object], repeats: int = 9) -> float:
    """Return the median time of a call, warmed by one call that is not counted."""
    return medians([call], repeats)[0]


def medians(calls: Sequence[Callable[[], object]], repeats: int = 9) -> list[float]:
    """Return the median time of each call; they take turns, so that a change of the machine's speed meets all of them alike."""
    seconds: list[list[float]] = [[] for _ in calls]
    for turn in range(repeats + 1):
        for call, kept in zip(calls, seconds, strict=True):
            start = time.perf_counter()
            call()
            if turn:  # the first turn warms
                kept.append(time.perf_counter() - start)
    return [statistics.median(kept) for kept in seconds]


_REPORT = """
import pathlib, resource, sys
status = pathlib.Path("/proc/self/status")  # ru_maxrss would count what the parent held when it started this process
if status.exists():
    print(next(line for line in status.read_text().splitlines() if line.startswith("VmHWM")).split()[1])
else:
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / (1024 if sys.platform == "darwin" else 1))
"""


def peak_memory(code: str) -> float:
    """Return the peak resident memory, MiB, of a fresh interpreter that runs some code."""
    output = subprocess.run([sys.executable, "-c", code + "\n" + _REPORT], check=True, capture_output=True, text=True).stdout
    return float(output.split()[-1]) / 1024


def exponent(sizes: Sequence[float], seconds: Sequence[float]) -> float:
    """Return p of the fit seconds ~ sizes^p."""
    return float(np.polyfit(np.log(sizes), np.log(seconds), 1)[0])
