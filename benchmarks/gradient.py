"""Gradients: a run and its gradient by every property of 25 absorbers, and a descent of the design study's mirror pairs.

At M = 60, dt = 4e-3; unequal absorbers without symmetry on a prepared bare structure. Processor time, medians of turns side by side.
"""

from __future__ import annotations

import statistics
import time

import coaxshell as cx
from coaxshell.numerics.blas_threads import one_blas_thread
from coaxshell.studies.gradients.gradient import fields_of
from coaxshell.studies.gradients.sensitivity import MetricSensitivity
from coaxshell.studies.metrics import metrics_of

PROPERTIES = ("angle", "mass", "damping", "linear_stiffness", "cubic_stiffness")
COUNT, TURNS = 25, 5


def layout(turn: int) -> list[cx.Absorber]:
    """Return unequal absorbers without symmetry, others at every turn."""
    steps = [((7 * k + 3 * turn) % COUNT) / COUNT for k in range(COUNT)]
    return [
        cx.Absorber(
            angle=360.0 * k / COUNT + 4.0 * step,
            mass=5.0 + 10.0 * step,
            damping=(0.5 + step) * 1e6,
            linear_stiffness=(0.5 + step) * 1e9,
            cubic_stiffness=(0.5 + step) * 1e20,
        )
        for k, step in enumerate(steps)
    ]


def main() -> None:
    """Print the processor time of a run, and of a run with its gradient, over that."""
    bare = cx.presets.load("bare")
    prepared = cx.prepare(bare, duration=4.0, time_step=4e-3, modes=60)
    forwards, ratios = [], []
    with one_blas_thread():
        for turn in range(TURNS + 1):
            start = time.process_time()
            response = prepared.simulate(layout(turn))
            forward = time.process_time() - start
            metric = metrics_of(["inner.peak_stress"], response.system)[0]
            start = time.process_time()
            found = MetricSensitivity(response.system, metric, 32.0, response)
            slopes = [found.of(field.path) for field in fields_of(response.system, [f"absorbers[*].{name}" for name in PROPERTIES])]
            if turn:  # the first one makes what the others share
                forwards.append(forward)
                ratios.append((forward + time.process_time() - start) / forward)
    print(f"gradient by {len(slopes)} properties, M = 60, 1000 steps: run {statistics.median(forwards):.2f} s of a processor,")
    print(f"  value and gradient {statistics.median(ratios):.2f} times that ({', '.join(f'{ratio:.2f}' for ratio in sorted(ratios))})")


if __name__ == "__main__":
    main()
