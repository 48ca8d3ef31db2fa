"""One change at a time at preview resolution (M = 60, dt = 4e-3, t = 0 to 5): a prepared structure retuned against a fresh preparation.

25 of the paper's absorbers throughout. Seconds of the processor, so that other work on the machine counts less.
"""

from __future__ import annotations

import itertools
import statistics
import time
import warnings
from collections.abc import Callable, Iterator

import coaxshell as cx

PREVIEW = {"duration": 5.0, "time_step": 4e-3, "modes": 60}


def absorbers() -> Iterator[cx.System]:
    """Yield systems with other absorbers."""
    for k in itertools.count():
        ring = cx.absorber_ring(25, mass=10, damping=1e6, linear_stiffness=1e9, cubic_stiffness=1e20 * (1 + 0.01 * k))
        yield cx.presets.load("active").replace(absorbers=ring)


def gains() -> Iterator[cx.System]:
    """Yield systems with other gains."""
    system = next(absorbers())
    for k in itertools.count():
        yield system.replace(control=cx.PDControl(proportional=-2e4 + 100 * k, derivative=-150 + k))


def layers() -> Iterator[cx.System]:
    """Yield systems with another thickness of the outer shell's core."""
    system = next(absorbers())
    inner, outer = system.shells
    for k in itertools.count():
        core = outer.layers[1].model_copy(update={"thickness": 6e-3 + 1e-5 * k})
        yield system.replace(shells=[inner, outer.model_copy(update={"layers": (outer.layers[0], core, outer.layers[2])})])


def seconds(call: Callable[[], object]) -> float:
    """Return the processor time of a call."""
    start = time.process_time()
    call()
    return time.process_time() - start


def main() -> None:
    """Print the medians of 5 changes, the two ways taking turns."""
    warnings.simplefilter("ignore", cx.PhysicsWarning)
    for changes in (absorbers, gains, layers):
        systems = changes()
        prepared = cx.prepare(next(systems), **PREVIEW).retuned(next(systems))
        prepared.simulate()
        found: list[tuple[float, float]] = []
        for system in itertools.islice(systems, 6):
            reused = seconds(lambda system=system, prepared=prepared: prepared.retuned(system).simulate())
            found.append((reused, seconds(lambda system=system: cx.simulate(system, **PREVIEW))))
        reused, fresh = (statistics.median(column) for column in zip(*found[1:], strict=True))  # the first one warms
        print(f"{changes.__name__}: retuned {reused:.3f} s, from the beginning {fresh:.3f} s, ratio {fresh / reused:.1f}", flush=True)


if __name__ == "__main__":
    main()
