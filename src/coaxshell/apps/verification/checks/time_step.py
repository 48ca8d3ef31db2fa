"""Halving the time step: observed orders of the spectral engine, and of its march with absorbers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, at_least, distance, orders, within
from coaxshell.model import presets
from coaxshell.model.pulses import Gaussian
from coaxshell.model.sources import LineShock, PlaneShock, PlaneWave, Source, SphericalShock
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray

STEPS = (1.6e-2, 8e-3, 4e-3)
FINE = 1e-3
ROUNDING = 3e-10
SOURCE = "theory 10; against dt = 1e-3"
PULSE = {"peak_pressure": 2.5e4, "decay_time": 1.314e-4}
SOURCES: dict[str, tuple[Source, str, float, float]] = {
    "spherical front": (SphericalShock(distance=5.0, **PULSE), "displacement", 2.0, 3e-6),
    "spherical front, stress": (SphericalShock(distance=5.0, **PULSE), "stress", 2.0, 1e-5),
    "plane front": (PlaneShock(**PULSE), "displacement", 2.0, 3e-6),
    "line source": (LineShock(distance=5.0, **PULSE), "displacement", 2.0, 3e-6),
    "smooth pulse, stress": (PlaneWave(pulse=Gaussian(peak_pressure=2.5e4, width=1.2e-5)), "stress", 15.0, 1e-9),
}
"""Source, quantity, least order, and the error left at dt = 4e-3."""


@check("time-step", "Convergence in the time step (spectral engine)")
def time_step(bench: Bench) -> Iterator[Finding]:
    """Halve dt: the outer head of the bare system under several sources, then systems whose absorbers are marched."""
    curves = []
    bare = presets.load("bare")
    for name, (source, quantity, least, left) in SOURCES.items():
        errors = _errors(bench, bare.replace(source=source), quantity, STEPS, FINE)
        observed = orders(errors)[errors[1:] > ROUNDING]
        yield at_least(f"{name}: least order in dt, {quantity} of the outer head", SOURCE, least, float(observed.min()))
        yield within(f"{name}: error left at dt = 4e-3", SOURCE, "0", float(errors[-1]), left)
        curves.append(Curve(name, np.array(STEPS), errors))
        bench.done(0.1 * len(curves))
    marched = []
    steps = bench.choose((4e-3, 2e-3), (4e-3, 2e-3, 1e-3))
    for name, limit in {"absorbers": 1e-5, "hybrid": 1e-5}.items():
        errors = _errors(bench, presets.load(name), "stress", steps, steps[-1] / 4)
        yield at_least(f"{name}: least order in dt of the march, stress of the outer head", "theory 7", 1.8, float(orders(errors).min()))
        yield within(
            f"{name}: error left at dt = {steps[-1]:g}",
            f"against dt = {steps[-1] / 4:g}",
            "0",
            float(errors[-1]),
            limit * (steps[-1] / 1e-3) ** 2,
        )
        marched.append(Curve(name, np.array(steps), errors))
    yield Sheet(
        "Convergence in the time step",
        "Relative L2 error of the outer head over t = 0 to 2; left without absorbers, M = 30, right with 25 of them, M = 24.",
        [
            Panel("linear: Laplace inversion", "time step", "relative error", curves, logarithmic=True),
            Panel("absorbers: interface march", "time step", "relative error", marched, logarithmic=True),
        ],
    )


def _errors(bench: Bench, system: System, quantity: str, steps: tuple[float, ...], fine: float) -> FloatArray:
    """Return the relative L2 error at the outer head for each step, at the instants of the coarsest one."""
    modes = 24 if system.absorbers else 30

    def history(step: float) -> FloatArray:
        response = bench.simulate(system, duration=2.0, time_step=step, modes=modes)
        values = np.asarray(getattr(response, quantity)("outer", [0.0]))[:, 0]
        return values[:: round(steps[0] / step)][: int(2.0 / steps[0])]

    exact = history(fine)
    return np.array([distance(history(step), exact) for step in steps])
