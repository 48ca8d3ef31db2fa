"""A rigid cylinder: the pressure doubles at the head, and a step is forgotten in the end."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.loads import surface_pressure
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, close, within
from coaxshell.apps.verification.systems import PLANE_STEP, STEP
from coaxshell.model.pulses import Step
from coaxshell.model.sources import LineWave, PlaneWave, Source, SphericalWave
from coaxshell.numerics.laplace_grid import LaplaceGrid

PULSE = Step(pressure=STEP)
SOURCES: dict[str, Source] = {
    "plane wave": PlaneWave(pulse=PULSE),
    "line source at 4 a": LineWave(distance=4.0, pulse=PULSE),
    "spherical source at 4 a": SphericalWave(distance=4.0, pulse=PULSE),
    "spherical source at 1.5 a": SphericalWave(distance=1.5, pulse=PULSE),
}


@check("rigid-cylinder", "Rigid cylinder under a step")
def rigid_cylinder(bench: Bench) -> Iterator[Finding]:
    """At the head the front's pressure doubles, whatever the source (initial value theorem); a step's late pressure is 1 everywhere.

    Behind a plane front no pressure reaches the tail before the creeping wave, at t = 1 + pi/2.
    """
    grid = LaplaceGrid(0.02, 200)
    for name, source in SOURCES.items():
        head = surface_pressure(source, grid, 260, STEP).sum(axis=0) * grid.nodes
        yield close(f"head, {name}: pressure at the front over that of the wave", "theory 4, 10", 2.0, float(abs(head[-1])), 5e-3)
    late = LaplaceGrid(0.05, 2000)
    history = late.invert(surface_pressure(PLANE_STEP, late, 3, STEP))
    for m in range(3):
        found = float(history[m, -1])
        yield close(f"plane step, order {m}: pressure at t = 100", "theory 10", float(m == 0), found, 1e-4, measure="absolute")
    fine = LaplaceGrid(2e-3, 3000)
    modes = 200
    modal = fine.invert(surface_pressure(PLANE_STEP, fine, modes, STEP), fine.lanczos())
    weights = np.sinc(np.arange(modes + 1) / (modes + 1.0))  # Lanczos: the series has fronts
    surface = {angle: (weights * np.cos(np.radians(angle) * np.arange(modes + 1))) @ modal for angle in (0.0, 90.0, 180.0)}
    quiet = fine.time < 1 + np.pi / 2 - 0.1
    early = float(np.abs(surface[180.0][quiet]).max())
    yield within("tail before t = 1 + pi/2 - 0.1", "causality: creeping wave", "0", early, 2e-3, found=f"{early:.2g}", measure="absolute")
    yield Sheet(
        "Pressure on a rigid cylinder under a plane step",
        "200 orders, Lanczos factors in order and frequency. The front passes the sides at t = 1; creeping waves fill the shadow.",
        [Panel("", "time (a/c)", "pressure / step", [Curve(f"{angle:g}°", fine.time, values) for angle, values in surface.items()])],
    )
