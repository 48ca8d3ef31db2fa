"""Spectral against direct in every configuration: two solution paths that share the model and the fluids' operators only."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Row, Sheet, at_least, distance, within
from coaxshell.apps.verification.systems import GAINS, PLANE_STEP
from coaxshell.model import presets
from coaxshell.model.absorbers import Absorber, absorber_ring
from coaxshell.model.pulses import Gaussian
from coaxshell.model.sources import LineShock, SphericalWave
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray
from coaxshell.response.response import Response

STEPS = (8e-3, 4e-3, 2e-3)
SETTINGS: dict[str, Any] = {"duration": 2.0, "modes": 24}
QUICK = ("bare", "hybrid", "filled single shell")
LEAST = 1.4
"""Between order 1.5 and 2: modal loads start like the square root of time, which central differences see at order 1.5."""


def configurations() -> dict[str, System]:
    """Return the systems on which the engines are compared."""
    bare = presets.load("bare")
    unequal = [
        Absorber(angle=20.0, mass=10, damping=1e6, linear_stiffness=1e9, cubic_stiffness=1e21),
        Absorber(angle=-70.0, mass=30, damping=1e5, linear_stiffness=3e9, cubic_stiffness=0.0),
    ]
    massless = absorber_ring(3, mass=0, damping=1e6, linear_stiffness=1e9, cubic_stiffness=1e20)
    pulse = Gaussian(peak_pressure=1e4, width=1e-4)
    return {
        "bare": bare,
        "bare, plane step": bare.replace(source=PLANE_STEP),
        "bare, line source": bare.replace(source=LineShock(distance=5.0, peak_pressure=2.5e4, decay_time=1.314e-4)),
        "bare, smooth pulse at 40°": bare.replace(source=SphericalWave(distance=3.0, angle=40.0, pulse=pulse)),
        "25 absorbers": presets.load("absorbers"),
        "unequal absorbers off the axis": bare.replace(absorbers=unequal),
        "massless absorbers": bare.replace(absorbers=massless),
        "active control": presets.load("active"),
        "saturated control": bare.replace(control=GAINS.replace(saturation=True)),
        "hybrid": presets.load("hybrid"),
        "evacuated single shell": presets.load("iakovlev-evacuated"),
        "filled single shell": presets.load("iakovlev-filled"),
        "double shell, inner one evacuated": presets.load("iakovlev-double"),
    }


@check("engines", "Spectral engine against direct engine")
def engines(bench: Bench) -> Iterator[Finding]:
    """Compare all displacements and strains, M = 24, t = 0 to 2, at three steps of the direct engine, with its observed order."""
    panels: tuple[list[Curve], list[Curve]] = ([], [])
    systems = {name: system for name, system in configurations().items() if not bench.quick or name in QUICK}
    for number, (name, system) in enumerate(systems.items()):
        found = errors(bench, system)
        yield from judged(name, found)
        for column, curves in zip(found.T, panels, strict=True):
            curves.append(Curve(name, np.array(STEPS), column))
        bench.done((number + 1) / len(systems))
    yield Sheet(
        "Direct engine against spectral engine",
        "Relative L2 distance of all orders and both shells over t = 0 to 2, M = 24.",
        [
            Panel(name, "time step of the direct engine", "relative distance", curves, logarithmic=True)
            for name, curves in zip(("displacement", "strain"), panels, strict=True)
        ],
    )


def judged(name: str, found: FloatArray) -> Iterator[Row]:
    """Yield what is asked of the errors of one configuration: small at the finest step, and of their order in the step."""
    for what, column, limit in zip(("displacement", "strain"), found.T, (3e-3, 5e-3), strict=True):
        source = "theory 10; the other engine at a quarter of the step"
        yield within(f"{name}: {what}, dt = {STEPS[-1]:g}", source, "the spectral engine's", float(column[-1]), limit)
        yield at_least(f"{name}: order in dt, {what}", source, LEAST, float(np.log2(column[0] / column[-1]) / 2))


def errors(bench: Bench, system: System) -> FloatArray:
    """Return the distance of displacement and strain between the engines for each step, relative L2, shape (steps, 2)."""
    fine = bench.simulate(system, time_step=STEPS[-1] / 4, **SETTINGS)
    rows = []
    for step in STEPS:
        response = bench.simulate(system, time_step=step, engine="direct", **SETTINGS)
        stride = round(step / fine.settings.time_step)
        w = distance(response.solution.normal, fine.solution.normal[..., ::stride])
        rows.append((w, distance(_strains(response), _strains(fine)[..., ::stride])))
    return np.array(rows)


def _strains(response: Response) -> FloatArray:
    m = np.arange(response.modes + 1)[:, None]
    result: FloatArray = m * response.solution.tangential - response.solution.normal
    return result
