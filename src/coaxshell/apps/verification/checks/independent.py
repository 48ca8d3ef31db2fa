"""Against an independent method: spectral elements in r, implicit Gauss integration in time, no Bessel function."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.independent import RadialElements
from coaxshell.apps.verification.independent.radial_elements import ELEMENT
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, at_least, distance, within
from coaxshell.apps.verification.systems import GAINS, SMOOTH, cubic_ring, smooth
from coaxshell.model import laws, presets
from coaxshell.model.absorbers import Absorber
from coaxshell.model.fluids import VACUUM, Fluid
from coaxshell.model.gains import saturates
from coaxshell.model.sources import PlaneWave
from coaxshell.model.system import System
from coaxshell.numerics.arrays import FloatArray

ANGLES = [0.0, 70.0, 180.0]
SOURCE = "independent: spectral elements in r, Gauss in t"
MODES, DURATION = 8, 2.0
POINTS = 90
"""Angles at which the other method holds a saturated voltage; the package takes 180. The distance falls with them: 18 leave 6e-3,
36 2e-3, 60 4e-4, 90 2e-4, 180 2e-5."""
QUICK = ("bare", "hybrid, 7 absorbers with strong cubic springs", "evacuated single shell")


def configurations() -> dict[str, tuple[System, float]]:
    """Return the systems and the tolerance of each; cubic springs and saturation are marched at second order."""
    bare = smooth("bare")
    strong = {"damping": 1e5, "linear_stiffness": 1e9, "cubic_stiffness": 1e22, "mass": 10}
    three = [Absorber(**{**strong, "angle": angle, "mass": mass}) for angle, mass in ((25, 5), (-80, 20), (160, 1))]
    wall, outer = bare.shells
    fluids = [VACUUM, Fluid(density=900, sound_speed=1200), Fluid(density=1200, sound_speed=1700), bare.exterior]
    layered = bare.replace(shells=[wall.replace(radius=0.4), wall.replace(radius=0.7), outer], fluids=fluids)
    return {
        "bare": (bare, 5e-7),
        "bare, fluids at the true faces": (bare.replace(shells=[shell.replace(wetted="faces") for shell in bare.shells]), 5e-7),
        "active control": (bare.replace(control=GAINS), 5e-7),
        "saturated control": (bare.replace(control=GAINS.replace(saturation=True)), 4e-4),
        "one absorber with a strong cubic spring": (bare.replace(absorbers=[Absorber(**strong, angle=0)]), 3e-5),
        "three unequal absorbers off the axis": (bare.replace(absorbers=three), 3e-5),
        "hybrid, 7 absorbers with strong cubic springs": (bare.replace(absorbers=cubic_ring(7), control=GAINS), 1e-5),
        "bistable and tabulated springs, smoothed friction, each side its own, an inerter": (bare.replace(absorbers=[of_laws()]), 3e-5),
        "a mass on the outer shell alone, by a hardening spring": (bare.replace(absorbers=[on_one_shell()]), 3e-5),
        "plane wave from 40°": (bare.replace(source=PlaneWave(angle=40.0, pulse=SMOOTH)), 5e-7),
        "three shells, four fluids, vacuum inside": (layered, 5e-7),
        "evacuated single shell": (smooth("iakovlev-evacuated"), 5e-7),
        "filled single shell": (smooth("iakovlev-filled"), 5e-7),
        "double shell, inner one evacuated": (smooth("iakovlev-double"), 5e-7),
    }


def of_laws() -> Absorber:
    """Return an absorber whose links have laws of many kinds."""
    table = laws.Table(stretch=(-2e-6, 0.0, 2e-6), force=(-6e2, 0.0, 2e3))
    outer = laws.Parallel(laws=(table, laws.Friction(force=5e2, speed=2e-2), laws.Linear(stiffness=2e8, damping=2e4)))
    return Absorber(angle=0, mass=8, damping=1e5, inertance=2, law=laws.Sides(inner=laws.Bistable(k1=-2e8, k3=1e20), outer=outer))


def on_one_shell() -> Absorber:
    """Return a mass that hangs on the outer shell by a spring of the fifth order."""
    return Absorber(angle=0, mass=20, damping=3e4, links="outer", law=laws.Polynomial(coefficients=(2e8, 0.0, 1e20, 0.0, 1e31)))


@check("independent", "An independent method")
def independent(bench: Bench) -> Iterator[Finding]:
    """Compare displacement and stress of all shells at 0, 70 and 180 degrees, M = 8, t = 0 to 2, under a smooth pulse.

    The other method is coaxshell.apps.verification.independent: no Laplace transform, no Bessel function, its own section integrals.
    """
    systems = {name: pair for name, pair in configurations().items() if not bench.quick or name in QUICK}
    for number, (name, (system, limit)) in enumerate(systems.items()):
        yield within(
            f"{name}: worst history",
            SOURCE,
            "the other method's",
            compare(bench, system, 1e-3, 4e-3 if _saturates(system) else 2e-3),
            limit,
        )
        bench.done((number + 1) / (len(systems) + 2))
    if not bench.quick:
        fronts = compare(bench, presets.load("bare"), 2.5e-4, 1e-3, element=0.03125)
        yield within("bare under the paper's own shock, a sharp front", SOURCE, "the other method's", fronts, 4e-5)
        errors = [compare(bench, smooth("bare"), 1e-3, step) for step in (1.6e-2, 8e-3)]
        yield at_least(
            "order in dt of the independent method itself", "Gauss's method of two stages: 4", 3.85, float(np.log2(errors[0] / errors[1]))
        )
    yield _sheet(bench, configurations()["hybrid, 7 absorbers with strong cubic springs"][0])


def compare(bench: Bench, system: System, time_step: float, other_step: float, **options: Any) -> float:
    """Return the largest relative L2 distance of any shell's displacement or stress, all angles of one shell together."""
    other = RadialElements(system, MODES, DURATION, POINTS if _saturates(system) else 0, options.get("element", ELEMENT))
    other.solve(other_step, round(DURATION / other_step))
    response = bench.simulate(system, duration=DURATION, time_step=time_step, modes=MODES)
    coarse = max(time_step, other_step)
    ours, theirs = round(coarse / time_step), round(coarse / other_step)
    found = []
    for shell in range(len(system.shells)):
        for quantity in ("displacement", "stress"):
            got = np.asarray(getattr(response, quantity)(shell, ANGLES))[::ours]
            wanted = np.stack([getattr(other, quantity)(shell, angle) for angle in ANGLES], axis=1)[::theirs]
            found.append(distance(got, wanted))
    return max(found)


def _saturates(system: System) -> bool:
    return saturates(system)


def _sheet(bench: Bench, system: System) -> Sheet:
    other = RadialElements(system, MODES, DURATION).solve(4e-3, 500)
    response = bench.simulate(system, duration=DURATION, time_step=1e-3, modes=MODES)
    panels = []
    for index, shell in enumerate(("inner", "outer")):
        curves = []
        for side, angle, colour in (("head", 0.0, "blue"), ("tail", 180.0, "orange")):
            ours: FloatArray = np.asarray(response.stress(shell, [angle]))[:, 0] / 1e3
            curves.append(Curve(f"{side}, coaxshell", response.time, ours, colour=colour))
            curves.append(Curve(f"{side}, other method", other.time[::10], other.stress(index, angle)[::10] / 1e3, "points", colour=colour))
        panels.append(Panel(f"{shell} shell", "time (a/c)", "hoop stress (kPa)", curves))
    return Sheet(
        "Hybrid system by two methods", "Orders 0 to 8 under a smooth pulse; 7 absorbers with strong cubic springs, feedback.", panels
    )
