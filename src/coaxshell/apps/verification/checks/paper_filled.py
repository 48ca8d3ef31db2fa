"""The paper's second limiting case (its Fig. 2c, after Iakovlev 2014): one steel shell with water inside and outside."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from coaxshell.apps.verification.bench import Bench
from coaxshell.apps.verification.checks.independent import compare
from coaxshell.apps.verification.paper_histories import SIDES, history
from coaxshell.apps.verification.registry import check
from coaxshell.apps.verification.rows import Curve, Finding, Panel, Sheet, distance, within
from coaxshell.apps.verification.systems import SMOOTH
from coaxshell.model import presets
from coaxshell.model.fluids import VACUUM
from coaxshell.model.sources import SphericalWave
from coaxshell.model.system import System

THICKNESSES = {5e-3: "sky", 1e-2: "blue", 2e-2: "green", 4e-2: "orange"}
"""In metres, with a colour each: the paper shows several and names none, these are ours."""


@check("paper-filled", "Paper's Fig. 2c: fluid-filled single shell")
def paper_filled(bench: Bench) -> Iterator[Finding]:
    """Compare several thicknesses with the independent method, and with the paper's way of making the case: a tiny inner shell.

    The paper names no thickness and its figure is not available as numbers; the thicknesses are ours and the histories are drawn.
    """
    chosen = bench.choose([1e-2], list(THICKNESSES))
    for thickness in chosen:
        smooth = _shell(thickness).replace(source=SphericalWave(distance=5.0, pulse=SMOOTH))
        yield within(
            f"thickness {1e3 * thickness:g} mm, smooth pulse, M = 8: worst history",
            "independent: spectral elements in r, Gauss in t",
            "the other method's",
            compare(bench, smooth, 1e-3, 2e-3),
            5e-7,
        )
    single = presets.load("iakovlev-filled")
    settings = {"duration": 4.0, "time_step": 4e-3, "modes": 40}
    exact = bench.simulate(single, **settings)
    for radius, limit in ((0.1, 2e-2), (0.01, 2e-4)):
        tiny = single.replace(
            shells=[single.shells[0].replace(radius=radius, layers=_layers(radius / 100)), single.shells[0]],
            fluids=[VACUUM, single.fluids[0], single.fluids[1]],
        )
        emulated = bench.simulate(tiny, **settings)
        error = max(distance(history(emulated, "displacement", "outer", s), history(exact, "displacement", "outer", s)) for s in SIDES)
        yield within(
            f"double shell with an inner radius of {radius:g} m: outer shell",
            "paper, Model verification",
            "the single shell's",
            error,
            limit,
        )
    yield _sheet(bench)


def _layers(thickness: float) -> list[object]:
    layer = presets.load("iakovlev-filled").shells[0].layers[0]  # type: ignore[union-attr]
    return [layer.replace(thickness=thickness)]


def _shell(thickness: float) -> System:
    return presets.load("iakovlev-filled").replace_path("shells[0].layers[0].thickness", thickness)


def _sheet(bench: Bench) -> Sheet:
    panels: dict[str, list[Curve]] = {side: [] for side in SIDES}
    for thickness, colour in THICKNESSES.items():
        response = bench.simulate(_shell(thickness), duration=8.0, time_step=4e-3, modes=bench.choose(40, 100))
        for side, curves in panels.items():
            w = history(response, "displacement", "outer", side) / thickness
            curves.append(Curve(f"h = {1e3 * thickness:g} mm", np.asarray(response.time), 1e3 * w, colour=colour))
    return Sheet(
        "Fig. 2c: fluid-filled single shell, spherical shock of 25 kPa, decay time 3.76 ms",
        "Displacement over thickness at head and tail; water of 1470 m/s inside and outside.",
        [Panel(side, "time (a/c)", "w / h (1e-3)", curves) for side, curves in panels.items()],
    )
