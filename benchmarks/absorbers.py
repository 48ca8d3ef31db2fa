"""Absorbers against the bare run, and what studies make of them: every aim for their speed in one table.

Cold runs at the paper's resolution (M = 150, dt = 1e-3, T = 5), errors and warnings read; sets on a prepared structure; Figure 9 of the
paper; evaluations of a study at M = 60, dt = 4e-3, timed by a few; and the direct engine's run of the hybrid. Processor seconds of the
whole process, medians of turns, where some aims are by the clock of two quiet cores. ``python -m benchmarks.absorbers 1`` takes one
turn, and leaves out Figure 9 and the direct engine.
"""

from __future__ import annotations

import statistics
import sys
import time
import warnings
from collections.abc import Callable, Mapping

import numpy as np

import coaxshell as cx
from benchmarks.gradient import layout
from coaxshell.apps.paper.cases import COARSE_COUNTS, COUNTS, count
from coaxshell.apps.paper.observed import observe
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.solver.settings import Settings
from coaxshell.studies.evaluation import Case, batches, evaluate
from coaxshell.studies.metrics import metrics_of

PAPERS = {"mass": 10, "damping": 1e6, "linear_stiffness": 1e9, "cubic_stiffness": 1e20}
EVALUATIONS, TIMED = 2000, 6
STUDY = Settings(duration=5.0, time_step=4e-3, modes=60)
AIMS = {"25 absorbers": "2.5", "hybrid": "3", "300 cubic": "4", "300 unequal linear": "3 s by the clock"}


def ring(number: int) -> cx.System:
    """Return the bare system with a ring of the paper's absorbers."""
    return cx.presets.load("bare").replace(absorbers=cx.absorber_ring(number, **PAPERS))


def unequal(number: int) -> cx.System:
    """Return the bare system with linear absorbers that all differ."""
    drawn = np.random.default_rng(1).uniform(0.5, 1.5, (number, 4)).tolist()
    absorbers = [
        cx.Absorber(angle=360.0 * (k + 0.3 * shift) / number, mass=10 * mass, damping=1e6 * damping, linear_stiffness=1e9 * stiffness)
        for k, (shift, mass, damping, stiffness) in enumerate(drawn)
    ]
    return cx.presets.load("bare").replace(absorbers=absorbers)


def seconds(call: Callable[[], object]) -> float:
    """Return the processor time of a call."""
    start = time.process_time()
    call()
    return time.process_time() - start


def medians(calls: Mapping[str, Callable[[], object]], turns: int) -> dict[str, float]:
    """Return the median processor time of each call; they take turns."""
    found = [{name: seconds(call) for name, call in calls.items()} for _ in range(turns)]
    return {name: statistics.median(turn[name] for turn in found) for name in calls}


def cold(turns: int) -> None:
    """Print the times of cold runs, over the bare run's."""
    systems = {"bare": cx.presets.load("bare"), "25 absorbers": ring(25), "hybrid": cx.presets.load("hybrid"), "300 cubic": ring(300)}
    systems["300 unequal linear"] = unequal(300)
    _ = cx.simulate(systems["bare"]).warnings
    found = medians({name: lambda system=system: cx.simulate(system).warnings for name, system in systems.items()}, turns)
    for name, taken in found.items():
        aim = f" (aim {AIMS[name]})" if name in AIMS else ""
        print(f"{name}: {taken:.2f} s, {taken / found['bare']:.2f} times the bare run{aim}", flush=True)


def prepared(turns: int) -> None:
    """Print the time of a set of 25 on the hybrid's structure, its curves at the heads read, and of evaluations of a study."""
    hybrid = cx.prepare(cx.presets.load("hybrid"))
    sets = [cx.absorber_ring(25, **(PAPERS | {"mass": 10 + 0.1 * k})) for k in range(turns + 2)]
    taken = [seconds(lambda one=one: hybrid.simulate(one).stress("inner")) for one in sets]
    print(f"a prepared set of 25: {statistics.median(taken[2:]):.3f} s (aim 0.15 s by the clock)", flush=True)
    bare = cx.presets.load("bare")
    shapes = {"rings": lambda k: cx.absorber_ring(25, **(PAPERS | {"mass": 10 + 0.1 * k})), "25 that all differ": layout}
    for name, made in shapes.items():
        cases = [Case(k, bare.replace(absorbers=made(k))) for k in range(TIMED)]
        planned = batches(cases, metrics_of(["inner.peak_stress"], cases[0].system), STUDY, 1, judged=False)  # as a search asks for them
        for batch in planned:
            evaluate(batch)
        each = sum(seconds(lambda batch=batch: evaluate(batch)) for batch in planned) / TIMED
        print(f"{EVALUATIONS} evaluations of {name}: {EVALUATIONS * each:.0f} s (aim 60 s by the clock)", flush=True)


def figure() -> None:
    """Print the time of all runs of Figure 9, one after another."""
    bare = cx.presets.load("bare")
    structure = cx.prepare(bare)
    runs = count(bare, tuple(sorted({*COUNTS, *COARSE_COUNTS})))
    taken = seconds(lambda: [observe(structure.simulate(system.absorbers), peaks_only=True) for system in runs.values()])
    print(f"Figure 9, {len(runs)} runs: {taken:.0f} s (aim 20 s by the clock)", flush=True)


def engines(turns: int) -> None:
    """Print the direct engine's time over the spectral one's, for the hybrid at the same step."""
    hybrid = cx.presets.load("hybrid")
    calls = {engine: lambda engine=engine: cx.simulate(hybrid, engine=engine).warnings for engine in ("spectral", "direct")}
    found = medians(calls, turns)
    print(f"hybrid, direct over spectral: {found['direct'] / found['spectral']:.1f} (aim 10)", flush=True)


def main(turns: int = 3) -> None:
    """Print all of them."""
    with warnings.catch_warnings(), one_blas_thread():
        warnings.simplefilter("ignore", cx.PhysicsWarning)
        cold(turns)
        prepared(turns)
        if turns > 1:
            engines(turns)
            figure()


if __name__ == "__main__":
    main(*(int(turns) for turns in sys.argv[1:]))
