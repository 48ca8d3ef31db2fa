"""Spectral against direct engine: the same problems in one run, at the same step, at equal accuracy, and cost curves.

``python -m benchmarks.engines`` prints all of it, ``... step``, ``... accuracy``, ``... memory`` or ``... curves`` one part.
"""

from __future__ import annotations

import sys
import time
import warnings

import numpy as np

import coaxshell as cx
from benchmarks.measure import exponent, medians, peak_memory

BARE = cx.presets.load("bare")


def ring(count: int) -> cx.System:
    """Return the paper's system with this many of its absorbers."""
    return BARE.replace(absorbers=cx.absorber_ring(count, mass=10, damping=1e6, linear_stiffness=1e9, cubic_stiffness=1e20))


CASES = {"bare": BARE, "N = 1": ring(1), "N = 25": ring(25), "N = 100": ring(100), "hybrid": cx.presets.load("hybrid")}
ENGINES = ("spectral", "direct")
EQUAL = {"duration": 2.0, "modes": 60}
SPECTRAL_STEPS = (2e-2, 1.6e-2, 1e-2, 8e-3, 5e-3, 4e-3, 2e-3, 1e-3, 5e-4)
DIRECT_STEPS = (1e-2, 8e-3, 5e-3, 4e-3, 2e-3, 1e-3, 5e-4)
FINE = 1.25e-4
TARGETS = (1e-2, 3e-3, 1e-3)


def same_step() -> None:
    """Print medians and errors at dt = 1e-3, M = 150, t = 0 to 5, and the spectral engine's time at the direct engine's accuracy."""
    print("same step: dt = 1e-3, M = 150, t = 0 to 5; medians of 3 warm calls; errors against spectral at dt = 2.5e-4")
    whole = {"duration": 5.0, "modes": 150}
    for name, system in CASES.items():
        fine = stresses(system, 2.5e-4, "spectral", **whole)
        errors = [error(stresses(system, 1e-3, engine, **whole), fine[:, ::4]) for engine in ENGINES]
        for step in (2e-2, 1e-2, 5e-3, 2.5e-3, 1e-3):
            equal = error(stresses(system, step, "spectral", **whole), fine[:, :: round(step / 2.5e-4)])
            if equal <= errors[1]:
                break
        calls = [
            lambda e=e, h=h, s=system: cx.simulate(s, engine=e, time_step=h, **whole).warnings
            for e, h in zip(ENGINES, (1e-3, 1e-3), strict=True)
        ]
        calls.append(lambda h=step, s=system: cx.simulate(s, time_step=h, **whole).warnings)
        spectral, direct, coarse = medians(calls, 3)
        print(f"  {name:8} spectral {spectral:.2f} s, error {errors[0]:.1e}; direct {direct:.2f} s, error {errors[1]:.1e}; ", end="")
        print(
            f"ratio {direct / spectral:.1f}; spectral as good at dt = {step:g} ({equal:.1e}): {coarse:.3f} s, ratio {direct / coarse:.0f}",
            flush=True,
        )


def stresses(system: cx.System, step: float, engine: str, **settings: float) -> np.ndarray:
    """Return the stress at head and tail of both shells, shape (4, T)."""
    response = cx.simulate(system, time_step=step, engine=engine, **settings)
    return np.concatenate([np.asarray(response.stress(shell)).T for shell in ("inner", "outer")])


def error(found: np.ndarray, exact: np.ndarray) -> float:
    """Return the relative L2 error of all four histories together."""
    return float(np.linalg.norm(found - exact) / np.linalg.norm(exact))


def accuracy() -> None:
    """Print, for each error aimed at, the coarsest step of each engine that reaches it, its time, and the ratio."""
    print("equal accuracy: stress at head and tail of both shells, M = 60, t = 0 to 2, against spectral at dt = 1.25e-4")
    for name, system in CASES.items():
        fine = stresses(system, FINE, "spectral", **EQUAL)
        found = {engine: _ladder(system, engine, fine) for engine in ENGINES}
        for target in TARGETS:
            least = {engine: next(((step, e) for step, e in ladder if e <= target), None) for engine, ladder in found.items()}
            print(f"  {name:8} error {target:g}: " + _compared(system, least), flush=True)


def _ladder(system: cx.System, engine: str, fine: np.ndarray) -> list[tuple[float, float]]:
    """Return (step, error) from coarse to fine; steps that the engine refuses are left out."""
    found = []
    for step in SPECTRAL_STEPS if engine == "spectral" else DIRECT_STEPS:
        try:
            stress = stresses(system, step, engine, **EQUAL)
        except cx.InputError:
            continue
        found.append((step, error(stress, fine[:, :: round(step / FINE)][:, : stress.shape[1]])))
    return found


def _compared(system: cx.System, least: dict[str, tuple[float, float] | None]) -> str:
    texts, seconds = [], []
    for engine, pair in least.items():
        if pair is None:
            texts.append(f"{engine} not reached")
            continue
        step, reached = pair
        seconds += medians([lambda e=engine, s=step: cx.simulate(system, engine=e, time_step=s, **EQUAL).warnings], 3)
        texts.append(f"{engine} dt = {step:g} ({reached:.1e}) {seconds[-1]:.3f} s")
    return "; ".join(texts) + (f"; ratio {seconds[1] / seconds[0]:.1f}" if len(seconds) == 2 else "")


def memory() -> None:
    """Print the peak memory of a fresh process, above the imports, at the same step."""
    print("peak memory above the imports, dt = 1e-3, M = 150, t = 0 to 5")
    start = "import warnings; warnings.simplefilter('ignore'); import coaxshell as cx; from benchmarks.engines import CASES"
    idle = peak_memory(start + "; cx.simulate")
    for name in CASES:
        used = [peak_memory(f"{start}; cx.simulate(CASES[{name!r}], engine={engine!r})") - idle for engine in ENGINES]
        print(f"  {name:8} spectral {used[0]:.0f} MiB; direct {used[1]:.0f} MiB", flush=True)


def curves() -> None:
    """Print cost against M, T/dt and N for both engines, with fitted exponents (one warm call each beyond a second)."""
    for engine in ENGINES:
        _curve(engine, "orders M at 2000 steps, bare", (40, 80, 160), "modes")
        _curve(engine, "steps at M = 40, bare", (2000, 4000, 8000, 16000), "steps")
        _curve(engine, "absorbers N at M = 60, 2000 steps", (1, 10, 25, 50, 100, 200), "absorbers")


def _curve(engine: str, title: str, sizes: tuple[int, ...], kind: str) -> None:
    seconds = []
    for size in sizes:
        system = ring(size) if kind == "absorbers" else BARE
        modes = {"modes": size, "steps": 40, "absorbers": 60}[kind]
        steps = size if kind == "steps" else 2000
        seconds.append(_seconds(system, engine=engine, modes=modes, duration=2.0, time_step=2.0 / steps))
    listed = ", ".join(f"{size}: {s:.3f} s" for size, s in zip(sizes, seconds, strict=True))
    upper = slice(len(sizes) // 2 - 1, None)
    print(
        f"{engine}, {title}: {listed}; exponent {exponent(sizes, seconds):.2f}, upper half {exponent(sizes[upper], seconds[upper]):.2f}",
        flush=True,
    )


def _seconds(system: cx.System, **settings: object) -> float:
    def call() -> object:
        return cx.simulate(system, **settings)

    start = time.perf_counter()
    call()
    return medians([call], 1 if time.perf_counter() - start > 1 else 5)[0]


PARTS = {"step": same_step, "accuracy": accuracy, "memory": memory, "curves": curves}


def main(*parts: str) -> None:
    """Print the parts asked for, or all."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cx.PhysicsWarning)
        for name in parts or PARTS:
            PARTS[name]()


if __name__ == "__main__":
    main(*sys.argv[1:])
